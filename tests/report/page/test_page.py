"""What the page of a record is told."""

import json
import math
import re
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from tests.report.page.conftest import MORE

from muster.mission.errors import InputError
from muster.mission.model import Action, Mission, Robot, Task
from muster.motion.grid import Grid
from muster.report.page import data as data_of_page
from muster.report.page import page_text, write_page
from muster.report.page.data import page_data
from muster.report.page.distances import nearest
from muster.report.record import Recording, Tracks
from muster.report.time_charts.activity_spans import Span, spans
from muster.state import event_of

pytest.importorskip("mcap")


def recording(mission, positions, times=None, **more):
    """A recording of robots at places (m, n, 3)."""
    positions = np.asarray(positions, dtype=float)
    times = np.arange(len(positions)) * 0.1 if times is None else times
    tracks = Tracks(
        tuple(robot.id for robot in mission.robots), times, positions, positions[:, :, 0], np.zeros_like(positions)
    )
    parts = {"image": None, "plans": (), "events": (), "bids": (), "report": None, "complete": True}
    return Recording(file="r.mcap", mission=mission, mission_text="", tracks=tracks, **{**parts, **more})


@pytest.fixture
def pair():
    return Mission(
        robots=[Robot(id="a", position=(0, 0), radius_m=0.2), Robot(id="b", position=(1, 0), radius_m=0.3)],
        tasks=[Task(id="t", position=(1, 1))],
    )


def summed(differences):
    found, last = [], 0
    for step in differences:
        last += step or 0
        found.append(math.nan if step is None else last / 1000)
    return found


PLACE = st.one_of(st.floats(-1e4, 1e4), st.just(math.nan))


@given(st.lists(st.tuples(PLACE, PLACE), min_size=1, max_size=30))
def test_series_come_back_to_half_a_millimetre(xs):
    mission = Mission(robots=[Robot(id=i, position=(0, 0)) for i in "ab"], tasks=[Task(id="t", position=(0, 0))])
    positions = np.array([[[x, x, x] for x in row] for row in xs])
    data = page_data(recording(mission, positions))
    for k, robot in enumerate(data["robots"]):
        np.testing.assert_allclose(summed(robot["x"]), positions[:, k, 0], atol=5.01e-4)


def test_headings_do_not_jump(pair):
    positions = np.zeros((5, 2, 3))
    positions[:, 0, 0] = [3.0, math.nan, 3.1, -3.1, -3.0]  # its headings too
    (first, _) = page_data(recording(pair, positions))["robots"]
    found = summed(first["heading"])
    assert math.isnan(found[1])
    assert [found[0], *found[2:]] == pytest.approx([3.0, 3.1, 2 * math.pi - 3.1, 2 * math.pi - 3.0], abs=1e-3)


def test_long_records_are_thinned(pair, monkeypatch):
    monkeypatch.setattr(data_of_page, "MOST_SAMPLES", 1000)
    moments = 1234
    positions = np.zeros((moments, 2, 3))
    positions[:, 0, 0] = np.arange(moments)
    data = page_data(recording(pair, positions))
    assert len(data["times"]) == len(data["robots"][0]["x"]) <= 501
    assert summed(data["robots"][0]["x"])[-1] == moments - 1


def test_ten_minutes_of_six_robots_are_less_than_two_megabytes():
    """Robots that never stand still, at the rate at which records are written."""
    mission = Mission(
        robots=[Robot(id=f"r_{k}", position=(0, 0)) for k in range(6)], tasks=[Task(id="t", position=(0, 0))]
    )
    steps = np.random.default_rng(1).normal(0, 0.1, (6001, 6, 3))
    events = tuple(event_of(k * 0.5, "starts", {"robot": "r_0", "task": "t"}) for k in range(1200))
    assert len(page_text(recording(mission, steps.cumsum(axis=0), events=events)).encode()) < 2e6


def test_no_id_ends_the_data(pair):
    events = (event_of(0.0, "lost", {"task": "</script><script>alert(1)//", "reason": "@@STYLE@@"}),)
    text = page_text(recording(pair, np.zeros((1, 2, 3)), events=events))
    assert text.count("</script>") == 2
    (data,) = re.findall(r'<script type="application/json" id="data">(.*?)</script>', text, flags=re.DOTALL)
    assert json.loads(data)["events"][0][1] == "task </script><script>alert(1)// is lost: @@STYLE@@"


def test_a_record_without_steps(pair):
    data = page_data(recording(pair, np.zeros((0, 2, 3))))
    assert data["times"] == []
    assert data["nearest"] is None


def test_the_page_names_nothing_outside(recorded):
    text = page_text(recorded("31T-6R", more=MORE))
    assert re.findall(r"(?:https?:)?//[a-z]", text.replace("http://www.w3.org/2000/svg", "")) == []


def test_an_area_is_there_once_however_many_tasks_cover_it(pair):
    corners = ((0.0, 0.0), (9.0, 0.0), (9.0, 9.0))
    hole = ((6.0, 2.0), (8.0, 2.0), (8.0, 4.0))
    parts = [Action(name="coverage", area=corners, holes=(hole,), width_m=1.0, split=2, part=k) for k in (1, 2)]
    tasks = [Task(id=str(action.part), position=(1, 1), action=action) for action in parts]
    data = page_data(recording(replace(pair, tasks=tasks), np.zeros((1, 2, 3))))
    assert data["areas"] == [[[[0, 0], [9000, 0], [9000, 9000]], [[6000, 2000], [8000, 2000], [8000, 4000]]]]


def test_tasks_that_come_move_and_are_lost(recorded):
    data = page_data(recorded("31T-6R", more=MORE))
    late = data["tasks"][-1]
    assert (late["id"], late["type"]) == ("late <b>", "D")
    assert late["places"][:2] == [[20000, -9000, -9000], [25000, -8000, -9000]]
    assert [state for _, state, _ in late["states"]] == ["open", "open", "lost"]
    assert [robot["gone"] for robot in data["robots"]][4:] == [[], [[20000, "failed"]]]


def test_what_was_cancelled_is_not_lost(pair):
    events = (event_of(9.0, "lost", {"task": "t", "reason": "cancelled at 4 s"}),)
    data = page_data(recording(pair, np.zeros((1, 2, 3)), events=events))
    assert data["events"] == [[9000, "task t is not done: cancelled at 4 s", False]]
    assert data["figures"][1:] == [["tasks done", "0"], ["tasks lost", "0"], ["tasks cancelled", "1"]]


def test_figures_are_those_of_the_report(recorded):
    data = page_data(recorded("31T-6R"))
    assert data["figures"][:3] == [["mission time", "61.3 s"], ["tasks done", "31"], ["tasks lost", "0"]]
    assert ["least distance", "0.50 m"] in data["figures"]


@given(st.lists(st.booleans(), min_size=1, max_size=40), st.integers(1, 8))
def test_the_runs_of_an_image_are_its_cells(cells, columns):
    rows = -(-len(cells) // columns)
    blocked = np.resize(cells, (rows, columns))
    mission = Mission(
        robots=[Robot(id="a", position=(0, 0))],
        tasks=[Task(id="t", position=(0, 0))],
        map={"image": "x.png", "resolution_m": 1.0},
    )
    image = page_data(recording(mission, np.zeros((1, 1, 3)), image=Grid(blocked, 1.0)))["map"]["image"]
    back = np.repeat(np.arange(len(image["runs"])) % 2, image["runs"]).astype(bool)
    np.testing.assert_array_equal(back.reshape(image["rows"], image["columns"]), blocked)


def test_spans():
    def event(time, kind, **data):
        return event_of(time, kind, data)

    a, b = {"robot": "a", "task": "t"}, {"robot": "b", "task": "u"}
    events = [
        event(0, "sets_out", **a),
        event(1, "sets_out", **b),
        event(2, "arrives", **a),
        event(2, "starts", **a),
        event(3, "tick"),
        event(4, "arrives", **b),
        event(5, "ends", **a),
        event(6, "cancel_task", task="u"),
        event(7, "sets_out", robot="a", task="v"),
        event(8, "starts", robot="b", task="w"),
        event(9, "robot_fails", robot="a"),
    ]
    assert spans(events, 10) == [
        Span("a", "t", "travel", 0, 2),
        Span("b", "u", "travel", 1, 4),
        Span("a", "t", "work", 2, 5),
        Span("b", "u", "waiting", 4, 6),
        Span("a", "v", "travel", 7, 9),
        Span("b", "w", "work", 8, 10),
    ]


def test_a_way_to_a_task_that_another_has_now_ends_there_but_work_goes_on():
    events = [
        event_of(0, "sets_out", {"robot": "a", "task": "t"}),
        event_of(0, "sets_out", {"robot": "b", "task": "u"}),
        event_of(0, "starts", {"robot": "c", "task": "v"}),
        event_of(1, "sets_out", {"robot": "d", "task": "x"}),
        event_of(3, "replanned", {"moved": {"t": ["a", "b"], "v": ["c", "b"]}, "dropped": {"x": "no robot"}}),
    ]
    assert spans(events, 10) == [
        Span("a", "t", "travel", 0, 3),
        Span("d", "x", "travel", 1, 3),
        Span("b", "u", "travel", 0, 10),
        Span("c", "v", "work", 0, 10),
    ]


def test_nearest_is_the_pair_nearest_to_contact():
    radii = np.array([0.1, 0.1, 1.0])
    places = np.array([[[0, 0, 0], [1, 0, 0], [0, 2, 0]], [[0, 0, 0], [0.5, 0, 0], [9, 9, 9]], [[np.nan] * 3] * 3])
    places[2, 0] = 0
    found = nearest(places.astype(float), radii)
    assert found.pairs[:2].tolist() == [[0, 1], [0, 1]]
    assert found.metres[:2].tolist() == [1.0, 0.5]
    assert np.isnan(found.metres[2])
    radii[2] = 1.5
    found = nearest(places.astype(float), radii)
    assert (found.pairs[0].tolist(), found.metres[0], found.touch_m[0]) == ([0, 2], 2.0, 1.6)


def test_a_page_that_cannot_be_written(pair, tmp_path):
    with pytest.raises(InputError, match="expected a path that can be written"):
        write_page(tmp_path / "no" / "page.html", recording(pair, np.zeros((1, 2, 3))))
