"""What stands on sheets: stops with their times, what is done, why robots wait, why tasks are left out."""

from dataclasses import replace

import pytest
from tests.muster_files.sheets.crew import CREW, crew

from muster import load, verify
from muster.mission.model import Action, Task
from muster.mission.reading.plan_reader import plan_of
from muster.motion.actions import plan as motion_of
from muster.planning.export_formats import ExportOptions
from muster.verification import Stop
from muster_files.sheets.content import Times, sheets_of
from muster_files.sheets.instructions import at_task, plain

FIELD = ((0.0, 0.0), (9.0, 0.0), (9.0, 9.0), (0.0, 9.0))
STOP = Stop("a", False, 0.0, 1.0, 3.0)


@pytest.fixture
def sheets(tmp_path):
    mission, verdict, plan = crew(tmp_path)
    return sheets_of(mission, verdict, ExportOptions(), plan)


def lines_of(sheets, robot):
    (found,) = [sheet.lines for sheet in sheets.robots if sheet.robot.id == robot]
    return found


def test_every_robot_has_a_sheet_with_its_stops_in_order(sheets):
    told = {
        s.robot.id: [(line.order, line.visit.shown, line.visit.starts_s) for line in s.lines] for s in sheets.robots
    }
    assert told == {
        "r": [(1, "pier", 40), (2, "[pad]", 75), (3, "buoy", 135)],
        "s": [(1, "[pad]", 50)],
        "t": [(1, "beam", 20), (2, "scan", 60)],
        "u": [(1, "beam", 20), (2, "check", 75)],
        "idle": [],
    }
    assert [sheet.robot.id for sheet in sheets.busy] == ["r", "s", "t", "u"]


def test_what_is_done_is_said_in_words(sheets):
    assert [line.doing for line in lines_of(sheets, "r")] == [
        *("take on board 2", "charge 60 m", "put down what pier took on board")
    ]


def test_who_waits_is_told_for_what(sheets):
    reasons = {(s.robot.id, line.visit.name): line.waits_for for s in sheets.robots for line in s.lines}
    assert reasons == {
        ("r", "pier"): (),
        ("r", "pad"): ("a free slot",),
        ("r", "buoy"): (),
        ("s", "pad"): (),
        ("t", "beam"): ("u",),
        ("t", "scan"): ("its time window",),
        ("u", "beam"): (),
        ("u", "check"): ("the end of scan and 10 s more",),
    }


def test_robots_wait_for_what_begins_with_their_task_and_for_what_must_follow_it_soon(tmp_path):
    (tmp_path / "m.yaml").write_text(
        """\
schema: muster/1
rules: {timing: constant}
robots: [{id: a, position: [0, 0]}, {id: b, position: [0, 5]}, {id: c, position: [0, 90]}]
tasks:
  - {id: lit, position: [10, 0], starts_with: lift, window_s: [50, null]}
  - {id: lift, position: [10, 5]}
  - {id: dig, position: [20, 5], duration_s: 5}
  - {id: fill, position: [0, 95], prerequisites: [{task: dig, within_s: 7}], window_s: [100, null]}
""",
        encoding="utf-8",
    )
    from muster import load

    mission = load(tmp_path / "m.yaml")
    verdict = verify(mission, plan_of({"a": ["lit"], "b": ["lift", "dig"], "c": ["fill"]}))
    assert verdict.valid
    sheets = sheets_of(mission, verdict, ExportOptions(), None)
    assert [line.waits_for for line in lines_of(sheets, "a")] == [("its time window",)]
    assert [line.waits_for for line in lines_of(sheets, "b")] == [
        ("its time window of lit",),
        ("fill, which must begin within 7 s",),
    ]


def test_limits_of_time_are_told_by_the_clock_with_lateness(sheets):
    assert lines_of(sheets, "t")[1].limits == (
        *("window +1 00:00:00 - +1 00:00:30", "deadline +1 00:14:00", "due +1 00:00:02, 3 s late"),
    )


def test_a_task_left_out_has_the_plans_reasons(tmp_path, sheets):
    assert [(item.task.id, item.why) for item in sheets.left_out] == [("left", "skill, for every robot")]
    mission, verdict, plan = crew(tmp_path)
    some = replace(plan.unassigned[0], reasons=plan.unassigned[0].reasons[:1])
    other = replace(some, reasons=(*some.reasons, replace(some.reasons[0], robot="s", reason="lock")))
    for item, why in ((some, "skill (r)"), (other, "skill (r); lock (s)")):
        assert sheets_of(mission, verdict, ExportOptions(), replace(plan, unassigned=(item,))).left_out[0].why == why
    assert sheets_of(mission, verdict, ExportOptions(), None).left_out[0].why == ""


def test_places_are_on_earth_where_the_mission_is(tmp_path, sheets):
    spot = lines_of(sheets, "r")[0].spot
    assert (spot.lat, spot.lon) == pytest.approx((35.53, 24.06 + 40 / 90_570), abs=1e-5)
    mission, verdict, plan = crew(tmp_path, CREW.replace("origin_wgs84: {lat_deg: 35.53, lon_deg: 24.06}\n", ""))
    assert {line.spot for line in lines_of(sheets_of(mission, verdict, ExportOptions(), plan), "r")} == {None}


def test_a_drone_with_a_height_is_no_lower_at_its_stops(tmp_path):
    mission, verdict, plan = crew(tmp_path)
    sheets = sheets_of(mission, verdict, ExportOptions(altitude=30.0), plan)
    assert {line.place for line in lines_of(sheets, "u")} == {(10.0, 100.0, 30.0), (10.0, 120.0, 30.0)}
    assert {len(line.place) for line in lines_of(sheets, "t")} == {2}


@pytest.mark.parametrize(
    ("keys", "words"),
    [
        ({}, "work"),
        ({"type": "D", "requires": ("grip",)}, "type D; with grip"),
        (
            {"action": Action(name="raster-search", side_m=6.0, height_m=3.0, spacing_m=1.5)},
            "raster search, side 6 m, height 3 m, spacing 1.5 m",
        ),
        ({"action": Action(name="delivery", pickup=(1.0, 2.5))}, "delivery, pickup (1, 2.5)"),
        (
            {"action": Action(name="coverage", area=FIELD, holes=(FIELD[:3],), height_m=30.0, split=2, part=1)},
            "coverage, part 1 of 2, area with 4 corners, 1 hole, height 30 m",
        ),
        (
            {"action": Action(name="coverage", area=FIELD, cross_holes=True, width_m=2.5)},
            "coverage, area with 4 corners, cross holes, width 2.5 m",
        ),
        (
            {"action": Action(name="stationary-observation", width_m=4.0, heading_deg=30.0)},
            "stationary observation, width 4 m, heading 30°",
        ),
        (
            {"action": Action(name="go-to-goal"), "load": {"water": -2.0, "food": 1.0}},
            "take on board 1 food; put down 2 water",
        ),
        ({"entry": (1.0, 1.0)}, "work from (1, 1) to (0, 0)"),
    ],
)
def test_a_task_in_words(keys, words):
    assert at_task(Task(id="a", position=(0.0, 0.0), **keys), STOP) == words


def test_a_task_that_takes_no_time_is_a_visit():
    assert at_task(Task(id="a", position=(0.0, 0.0)), replace(STOP, ends_s=1.0)) == "visit"


def test_times_without_a_start_are_those_since_then():
    assert [Times(None).text(s) for s in (0, 59.6, 3723, 360_000)] == ["0:00:00", "0:01:00", "1:02:03", "100:00:00"]
    assert Times("2027-03-01T08:00:00+05:30").words == (
        "Times: of the clock; the mission starts 2027-03-01 08:00:00 (UTC+05:30)."
    )


@pytest.mark.parametrize(
    ("value", "text"), [(1.0, "1"), (-0.001, "0"), (1.005e6, "1005000"), (2.349, "2.35"), (100, "100")]
)
def test_plain_numbers(value, text):
    assert plain(value) == text


def test_the_place_of_an_area_is_where_its_lanes_begin(tmp_path):
    (tmp_path / "field.yaml").write_text(
        """\
schema: muster/1
robots: [{id: r, position: [-5, 0]}]
tasks: [{id: lawn, action: {name: coverage, width_m: 3, area: [[0, 0], [30, 0], [30, 9], [0, 9]]}}]
""",
        encoding="utf-8",
    )
    mission = load(tmp_path / "field.yaml")
    plan = plan_of({"r": ["lawn"]})
    (line,) = lines_of(sheets_of(mission, verify(mission, plan), ExportOptions(), plan), "r")
    (lawn,) = mission.tasks
    assert line.place == motion_of(lawn, mission.robots[0]).entry
    assert line.place != lawn.position
