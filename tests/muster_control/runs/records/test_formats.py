"""Logs and records of format 1, whose plans were whole, are read as those of format 2, whose plans are differences."""

import base64
import json
import tracemalloc
from pathlib import Path

import numpy as np
import pytest
from tests.muster_control.runs.stage import performed
from tests.state.played import site

import muster
from muster.mission.model import Mission, Robot, Station, Task
from muster.report.record import read_record
from muster.state.recovery import recovered_from
from muster.state.words import line_of
from muster_control.runs.log.tracks import VALUES, Steps, unpacked
from muster_control.runs.records.recording import flown, write_record

FILES = Path(__file__).parents[3] / "data" / "format_1"


def told(name):
    return json.loads((FILES / name).read_text())


def test_a_log_of_format_1_makes_the_record_that_it_made(tmp_path):
    kept = told("log.json")
    (tmp_path / "mission.yaml").write_text(kept["mission"])
    stretches = [unpacked(base64.b64decode(data)) for data in kept["stretches"]]
    write_record(tmp_path / "again.mcap", muster.load(tmp_path / "mission.yaml"), kept["log"], stretches)
    again, before = read_record(tmp_path / "again.mcap"), read_record(FILES / "record.mcap")
    assert [event.data for event in again.events] == [event.data for event in before.events]
    assert again.report == before.report
    np.testing.assert_array_equal(again.tracks.positions, before.tracks.positions)
    assert len(again.plans) == len(before.plans) == 3
    for one, other in zip(again.plans, before.plans, strict=True):
        assert ahead(before, one) == ahead(before, other)
    assert flown(again)["tasks"] == flown(before)["tasks"]


def ahead(recording, version):
    """By robot the tasks of a plan that were not done by then, and its way to them."""
    done = {event.data["task"] for event in recording.events if event.kind == "ends" and event.time_s <= version.time_s}
    routes = {route.robot: [name for name in route.tasks if name not in done] for route in version.plan.routes}
    return {robot: (names, version.lines[robot][1:]) for robot, names in routes.items() if names}


def test_a_run_whose_log_is_of_format_1_is_recovered():
    kept, mission = told("real_log.json"), site()
    state = recovered_from(mission, muster.solve(mission, "greedy"), kept["log"])
    assert sorted(state.ledger.ends_s) == kept["done"]
    assert sorted(state.ledger.cancelled) == kept["cancelled"]
    assert state.failed_stations == {"dock"}
    assert state.robots["r_2"].out == "robot_fails"
    assert not {name for route in state.routes.values() for name in route} & {*kept["done"], *kept["cancelled"]}


def test_the_first_plan_of_a_log_is_whole_and_others_say_what_changes():
    robots = tuple(Robot(id=f"r_{k}", position=(0.0, 9.0 * k)) for k in range(3))
    tasks = tuple(Task(id=f"t_{k}", position=(4.0 + 4 * (k // 3), 9.0 * (k % 3))) for k in range(9))
    mission = Mission(robots=robots, tasks=tasks)
    plan = muster.solve(mission, "greedy")
    new = {"new_task": {"id": "new", "position": [14.0, 0.0]}}
    log = performed(mission, plan, [(5.0, "event", new), (6.0, "event", {"robot_fails": "r_1"})]).log
    first, *others = (entry["data"] for entry in log if entry["kind"] == "plan")
    assert first["plan"]["routes"] == json.loads(json.dumps(plan.as_dict()))["routes"]
    assert set(first["lines"]) == {"r_0", "r_1", "r_2"}
    assert len(others) == 2
    assert others[0]["routes"] == {"r_0": ["t_3", "t_6", "new"]}
    assert others[0]["lines"]["r_0"][1:] == [[8.0, 0.0], [12.0, 0.0], [14.0, 0.0]]
    assert others[1]["routes"]["r_1"] == []
    assert others[1]["lines"]["r_1"] == []
    done = {"t_0", "t_1", "t_2"}
    assert all(not done & set(tasks) for data in others for tasks in data["routes"].values())
    lines = [line_of("plan", data) for data in (first, others[0])]
    assert lines == ["plan: 9 tasks, 3 robots", "plan: other ways for 1 robot"]


def test_stations_on_the_way_are_in_a_plan_and_no_tasks():
    robot = Robot(id="r", position=(0.0, 0.0), load_capacity=1.0, load_at_start=0.0)
    stations = (Station(id="dock", position=(0.0, 4.0), services=("unload",)),)
    tasks = tuple(Task(id=f"t_{k}", position=(3.0 * k, 0.0), load=1.0) for k in range(1, 4))
    mission = Mission(robots=(robot,), tasks=tasks, stations=stations)
    plan = muster.solve(mission, "greedy")
    log = performed(mission, plan, [(1.0, "event", {"cancel_task": "t_3"})]).log
    *_, last = (entry["data"] for entry in log if entry["kind"] == "plan")
    assert last["routes"] == {"r": ["t_1", "t_2"]}
    assert last["stops"]["r"].count("dock") == 1
    assert [0.0, 4.0] in last["lines"]["r"]
    state = recovered_from(mission, plan, log)
    assert state.stages == {"t_1": "done", "t_2": "done", "t_3": "cancelled"}


@pytest.mark.parametrize("most", [None, 60, 10_000])
def test_of_long_tracks_moments_are_left_out_evenly_as_they_are_read(most):
    every = read_record(FILES / "record.mcap").tracks
    tracks = read_record(FILES / "record.mcap", most).tracks
    count = len(tracks.times_s)
    assert tracks.times_s[0] == every.times_s[0]
    assert tracks.times_s[-1] == every.times_s[-1]
    if most == 60:
        assert 15 <= count <= 31  # of two robots
        apart = np.diff(tracks.times_s)[:-1]
        assert apart.max() == pytest.approx(apart.min())
    else:
        assert count == len(every.times_s)


@pytest.mark.long
def test_tracks_of_a_long_run_are_written_by_parts(tmp_path):
    """The memory that it takes does not grow with them."""
    mission = Mission(robots=tuple(Robot(id=f"r_{k}", position=(0.0, k)) for k in range(5)), tasks=())

    def stretches(count):
        for k in range(count):
            times = 5.0 * k + np.linspace(0.1, 5.0, 50)
            yield Steps(tuple(one.id for one in mission.robots), times, np.zeros((50, 5, VALUES)))

    def most_bytes(count):
        tracemalloc.start()
        write_record(tmp_path / f"{count}.mcap", mission, iter(()), stretches(count))
        _, most = tracemalloc.get_traced_memory()
        tracemalloc.stop()
        return most

    most_bytes(1)  # what is imported
    assert most_bytes(60) < 1.5 * most_bytes(12)
    assert len(read_record(tmp_path / "60.mcap").tracks.times_s) == 3000
