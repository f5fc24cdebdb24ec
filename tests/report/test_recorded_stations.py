"""What a record tells of stations and batteries: in the time chart, on the page, and in the lines of plans."""

import numpy as np
import pytest
from tests import carry_charge
from tests.report.page.test_page import recording
from tests.report.test_gantt import bars

from muster.mission.model import Action, Task
from muster.report.maps.recorded_tracks import plot_flown
from muster.report.page.data import page_data
from muster.report.record.routes import RouteLines
from muster.report.record.scene import station_entity
from muster.report.time_charts.activity_spans import spans
from muster.report.time_charts.level_lines import recorded_level
from muster.report.time_charts.recorded_gantt import plot_flown_gantt
from muster.state import MissionState, event_of

AT_DOCK = {"robot": "r", "station": "dock"}
EVENTS = tuple(
    event_of(*event)
    for event in [
        (0.0, "goes_to_station", {**AT_DOCK, "charge": 1.0}),
        (6.0, "arrives_at_station", {**AT_DOCK, "charge": 0.4}),
        (8.0, "service_begins", {**AT_DOCK, "services": ["charge"], "takes_s": 6.0, "charge": 0.4}),
        (14.0, "service_ends", {**AT_DOCK, "unloaded": {}, "charge": 1.0}),
        (14.0, "sets_out", {"robot": "r", "task": "a"}),
        (16.0, "ends", {"robot": "r", "task": "a"}),
    ]
)


@pytest.fixture
def charged():
    """A record of one robot that charged before its task."""
    robots = [carry_charge.robot(battery=carry_charge.battery(10, reserve=0.1))]
    mission = carry_charge.mission(robots, [carry_charge.task("a", 8)], [carry_charge.charger(x=6, slots=2)])
    report = {"robots": [{"robot": "r", "charge": 0.8}], "mission_time_s": 16.0}
    return recording(mission, np.zeros((2, 1, 3)), np.array([0.0, 16.0]), events=EVENTS, report=report)


def test_going_to_a_station_waiting_and_service_are_spans_of_their_own():
    found = [(span.kind, span.goal, span.from_s, span.until_s) for span in spans(EVENTS, 20.0)]
    assert found == [
        ("travel", "[dock]", 0, 6),
        ("waiting", "[dock]", 6, 8),
        ("service", "[dock]", 8, 14),
        ("travel", "a", 14, 16),
    ]


def test_the_level_is_what_events_and_the_report_tell(charged):
    level = recorded_level(charged, charged.robots[0], spans(charged.events, charged.duration_s))
    assert level.points == ((0, 1), (0, 1), (6, 0.4), (8, 0.4), (14, 1), (16, 0.8))
    assert level.reserve == 0.1


def waited(usage, **keys):
    """A record of one robot that stands, drives 10 m, works for 10 s and stands; its battery is told first and last."""
    mission = carry_charge.mission(
        [carry_charge.robot(battery=carry_charge.battery(20), speed_mps=1)],
        [carry_charge.task("a", 10, **keys)],
        usage=usage,
    )
    events = [(20, "sets_out", {}), (30, "arrives", {}), (30, "starts", {}), (40, "ends", {})]
    told = tuple(event_of(at_s, kind, {"robot": "r", "task": "a", **more}) for at_s, kind, more in events)
    report = {"robots": [{"robot": "r", "charge": 0.2}], "mission_time_s": 60.0}
    return recording(mission, np.zeros((2, 1, 3)), np.array([0.0, 60.0]), events=told, report=report)


@pytest.mark.parametrize(
    ("usage", "keys", "worked"),
    [
        ("distance", {"duration_s": 10}, 0.2),
        ("distance", {"duration_s": 10, "actuation_cost": 10}, 0.6),
        ("time", {"duration_s": 10}, 0.6),
    ],
)
def test_the_level_falls_only_while_energy_is_used(usage, keys, worked):
    record = waited(usage, **keys)
    points = recorded_level(record, record.robots[0], spans(record.events, record.duration_s)).points
    times_s, shares = zip(*points, strict=True)
    assert np.interp([0, 20, 25, 30, 40, 60], times_s, shares) == pytest.approx(
        [1, 1, (1 + worked) / 2, worked, 0.2, 0.2]
    )
    assert page_data(record)["robots"][0]["level"] == [[1000 * t, round(100_000 * share)] for t, share in points]


def test_the_time_chart_has_service_and_level(charged, drawn):
    pytest.importorskip("matplotlib")
    ax = plot_flown_gantt(charged)
    assert [bar[:2] for bar in bars(drawn(ax, "service-r"))] == [(8, 6)]
    assert [bar[:2] for bar in bars(drawn(ax, "waiting-r"))] == [(6, 2)]
    assert drawn(ax, "level-0")
    assert drawn(plot_flown(charged), "stations")


def test_the_page_has_stations_services_and_levels(charged):
    data = page_data(charged)
    label = "station dock: charge, 2 slots"
    assert data["stations"] == [{"sign": "[dock]", "place": [6000, 0], "label": label, "away": []}]
    assert [0, "[dock]", "service", 8000, 14000] in data["spans"]
    assert data["robots"][0]["level"][2] == [6000, 40_000]
    assert data["robots"][0]["reserve"] == 0.1


def test_the_line_of_a_plan_passes_the_stations_that_are_ahead(charged):
    mission, plan = charged.mission, carry_charge.plan(r="dock a dock")
    places = {"r": (1.0, 0.0)}
    state = MissionState(mission)
    assert RouteLines(mission).of(plan, state, places)["r"] == [(1, 0), (6, 0), (8, 0), (6, 0)]
    state.apply(event_of(1.0, "ends", {"robot": "r", "task": "a"}))
    assert RouteLines(mission).of(plan, state, places)["r"] == [(1, 0), (6, 0)]


def test_the_line_of_a_plan_follows_the_lanes_of_an_area_from_where_the_robot_is():
    area = Action(name="coverage", area=((0.0, 0.0), (20.0, 0.0), (20.0, 8.0), (0.0, 8.0)), width_m=2.0)
    mission = carry_charge.mission([carry_charge.robot(x=-5.0)], [Task(id="lawn", position=(10, 4), action=area)])
    plan, state = carry_charge.plan(r="lawn"), MissionState(mission)
    start, *lanes = RouteLines(mission).of(plan, state, {})["r"]
    assert (start, len(lanes)) == ((-5, 0), 8)
    assert {y for _, y in lanes} == {1, 3, 5, 7}
    state.apply(event_of(1.0, "starts", {"robot": "r", "task": "lawn"}))
    y = lanes[3][1]
    assert RouteLines(mission).of(plan, state, {"r": (10.0, y)})["r"] == [(10, y), *lanes[3:]]


def test_viewers_are_told_of_stations(charged):
    entity = station_entity(charged.mission.stations[0])
    assert (entity["id"], entity["texts"][0]["text"]) == ("station/dock", "[dock]")
    assert len(entity["cylinders"]) == 1
