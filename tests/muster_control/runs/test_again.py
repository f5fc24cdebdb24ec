"""A run that is killed anywhere goes on with the rest: from its last checkpoint, and from where bodies stood."""

from dataclasses import replace
from itertools import pairwise

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from tests.disturbances.missions import disturbed_mission
from tests.muster_control.runs.stage import Kept, performed, performed_with_crashes, require_whole

import muster
from muster.execution import Status
from muster.mission.errors import ParameterError
from muster.mission.model import Mission, Robot, Task
from muster.simulation.world_base import WorldBase
from muster.state import MissionState
from muster_control.runs.log import checkpoints
from muster_control.runs.runner.log_recorder import LogRecorder
from muster_control.runs.runner.run_loop import RunLoop

MOMENTS = st.floats(0, 60).map(lambda value: round(value, 2))


def requests(mission):
    robots, tasks = st.sampled_from([r.id for r in mission.robots]), st.sampled_from([t.id for t in mission.tasks])
    place = st.lists(st.integers(-9, 9), min_size=mission.dimensions, max_size=mission.dimensions)
    events = st.one_of(
        robots.map(lambda robot: {"robot_fails": robot}),
        robots.map(lambda robot: {"robot_returns": robot}),
        tasks.map(lambda task: {"cancel_task": task}),
        st.tuples(tasks, place).map(lambda pair: {"move_task": {"task": pair[0], "position": pair[1]}}),
        st.tuples(st.sampled_from(["new", "other"]), place).map(
            lambda pair: {"new_task": {"id": pair[0], "position": pair[1], "type": "D"}}
        ),
        st.just({"robot_joins": {"id": "none", "position": [1.0]}}),
        st.just({"nonsense": "x"}),
    )
    verbs = st.one_of(
        events.map(lambda event: ("event", event)),
        st.just(("speed", {"speed": 1e6})),
        st.just(("pause", {})),
        st.just(("resume", {})),
    )
    asked = st.lists(st.tuples(MOMENTS, verbs).map(lambda pair: (pair[0], *pair[1])), max_size=6)
    return asked.map(lambda asked: [*sorted(asked, key=lambda one: one[0]), (1e9, "resume", {})])


@pytest.mark.long
def test_what_comes_may_wait_for_what_came_before_the_crash(monkeypatch):
    monkeypatch.setattr(checkpoints, "MOST_ENTRIES", 5)
    mission = disturbed_mission(360)
    plan = muster.solve(mission, iterations=20)
    require_whole(performed_with_crashes(mission, plan, [(1e9, "resume", {})], [22]), mission)


@pytest.mark.long
@settings(max_examples=4)
@given(st.data())
def test_killed_anywhere_and_resumed_each_task_is_accounted_for_once(data):
    mission = disturbed_mission(data.draw(st.integers(0, 400), label="mission"))
    plan = muster.solve(mission, iterations=20)
    asked = data.draw(requests(mission), label="asked")
    crashes = data.draw(st.lists(st.integers(0, 40), max_size=3), label="crashes")
    most = data.draw(st.sampled_from([5, 17, 2_000]), label="entries between checkpoints")
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(checkpoints, "MOST_ENTRIES", most)
        kept = performed_with_crashes(mission, plan, asked, crashes)
    require_whole(kept, mission)
    assert kept.checkpoint is None or len(kept.log) - kept.checkpoint["seq"] <= 2 * most + 100


def test_robots_stand_where_they_stood_when_the_process_ended():
    whole = muster.load("6T-2R")
    mission = replace(whole, tasks=tuple(replace(task, actuation_cost=0.0) for task in whole.tasks))
    whole = performed_with_crashes(mission, muster.solve(mission, iterations=20), [], [6])
    (resumed,) = (entry for entry in whole.log if entry["kind"] == "resumed")
    steps = [(t, row) for _, _, one in whole.tracks for t, row in zip(one.times_s, one.states, strict=True)]
    moved = [
        (abs(after[1][:, :3] - before[1][:, :3]).max(), after[0] - before[0])
        for before, after in pairwise(steps)
        if after[0] >= resumed["time_s"] - 5.0
    ]
    assert len(moved) > 20
    assert all(metres <= 1.1 * seconds + 1e-3 for metres, seconds in moved)
    used = {row["robot"]: row["usage_flown"] for row in whole.log[-1]["data"]["robots"]}
    assert used == pytest.approx({name: _travelled(steps, k) for k, name in enumerate(used)}, abs=0.2)


def _travelled(steps, robot):
    return sum(float(np.linalg.norm(b[robot, :3] - a[robot, :3])) for (_, a), (_, b) in pairwise(steps))


def test_work_under_way_is_begun_again_and_named():
    robots = (Robot(id="r", position=(0.0, 0.0)),)
    once = {"across_partition": "at-most-once"}
    for more, done in (({}, ["t"]), (once, [])):
        mission = Mission(robots=robots, tasks=(Task(id="t", position=(3.0, 0.0), duration_s=20.0, **more),))
        kept = performed_with_crashes(mission, muster.solve(mission, "greedy"), [], [4])
        (resumed,) = (entry for entry in kept.log if entry["kind"] == "resumed")
        assert resumed["data"]["again"] == done
        assert kept.log[-1]["data"]["tasks_done"] == done


@pytest.mark.long
def test_tasks_are_accounted_for_once_whatever_happens():
    for seed in range(3):
        mission = disturbed_mission(seed)
        plan = muster.solve(mission, iterations=20)
        kept = performed(mission, plan, [(seed / 2, "event", {"robot_fails": mission.robots[0].id})])
        report = kept.log[-1]["data"]
        new = [e["data"]["task"]["id"] for e in kept.log if e["kind"] == "new_task"]
        told = [*report["tasks_done"], *(lost["task"] for lost in report["tasks_lost"])]
        assert sorted(told) == sorted([*(task.id for task in mission.tasks), *new])


def test_who_cancels_gets_a_report_of_all_tasks():
    mission = muster.load("31T-6R50")
    plan = muster.solve(mission, iterations=20)
    kept = performed(mission, plan, [(60.0, "cancel", {})])
    assert [entry["kind"] for entry in kept.log[-2:]] == ["command", "report"]
    report = kept.log[-1]["data"]
    told = [*report["tasks_done"], *(lost["task"] for lost in report["tasks_lost"])]
    assert sorted(told) == sorted(task.id for task in mission.tasks)
    assert report["tasks_done"]
    assert "not done when the run was cancelled" in {lost["reason"] for lost in report["tasks_lost"]}
    before = replace(kept, log=kept.log[:-1], most=None)
    again = performed(mission, plan, before=before, cancelled=True).log
    assert again[-1]["kind"] == "report"
    assert again[-1]["data"]["tasks_done"] == report["tasks_done"]


@pytest.mark.long
def test_what_a_pause_holds_up_takes_effect_where_it_stands():
    mission = muster.load("31T-6R50")
    plan = muster.solve(mission, iterations=20)
    asked = [(10.0, "pause", {}), (99.0, "event", {"robot_fails": "r_0"}), (99.0, "pause", {}), (99.0, "resume", {})]
    kept = performed(mission, plan, asked)
    commands = [entry for entry in kept.log if entry["kind"] == "command"]
    assert {entry["time_s"] for entry in commands} == {10.0}
    assert [entry["data"]["outcome"] for entry in commands] == ["done", "done", "the run is paused already", "done"]
    after = kept.log[commands[1]["seq"]]
    assert (after["kind"], after["data"]["robot"], after["time_s"]) == ("robot_fails", "r_0", 10.0)


class Drives:
    """A run of real robots that never come to an end by themselves."""

    real, done, time_s, next_s = True, False, 5.0, 5.0
    status = Status(robots={}, tasks={})
    state = None

    def __init__(self):
        self.told = []

    def pause(self):
        self.told.append("pause")

    def break_off(self, reason):
        self.told.append(reason)

    def snapshot(self):
        return None

    def go_on(self):
        raise AssertionError("robots go on")


def test_a_cancel_before_a_crash_holds_for_real_robots_also_where_the_log_has_no_report():
    mission = muster.load("6T-2R")
    kept, world_run = Kept(), Drives()
    recorder = LogRecorder(mission, kept, MissionState(mission), seq=2)
    how = {"speed": 1.0, "starts_at": None, "ended": lambda: False, "paused": True, "cancelled": True}
    RunLoop(world_run, recorder, None, kept, **how).run()
    assert world_run.told == ["not done when the run was cancelled"]


def test_a_pause_before_a_crash_holds_after_it():
    mission = muster.load("6T-2R")
    plan = muster.solve(mission, iterations=20)
    before = performed(mission, plan, killed_after=6)
    log = performed(mission, plan, [(1e9, "resume", {})], before=before, paused=True).log
    (command,) = (entry for entry in log if entry["kind"] == "command")
    assert command["data"]["outcome"] == "done"
    assert command["time_s"] == pytest.approx(max(one["time_s"] for one in (*before.others, before.bodies)), abs=0.11)
    assert log[-1]["kind"] == "report"


def test_a_world_that_gives_no_snapshot_is_carried_out_and_not_resumed(monkeypatch):
    monkeypatch.delattr(WorldBase, "snapshot")
    mission = muster.load("6T-2R")
    plan = muster.solve(mission, iterations=20)
    before = performed(mission, plan, killed_after=6)
    assert before.bodies is None
    with pytest.raises(
        ParameterError, match="world kinematic: it is not known where bodies were; expected a world with"
    ):
        performed(mission, plan, before=before)
    assert performed(mission, plan).log[-1]["kind"] == "report"


def test_who_is_out_or_silent_is_so_after_a_crash():
    mission = muster.load("6T-2R")
    plan = muster.solve(mission, iterations=20)
    asked = [(1.0, "event", {"robot_fails": "r_0"}), (2.0, "event", {"robot_silent": "r_1"})]
    before = performed(mission, plan, asked, killed_after=8)
    assert (before.bodies["failed"], before.bodies["muted"]) == (["r_0"], ["r_0", "r_1"])
    whole = performed_with_crashes(mission, plan, [*asked, (6.0, "event", {"robot_returns": "r_0"})], [8])
    require_whole(whole, mission)
    assert "robot_silent" in {entry["kind"] for entry in whole.log}
    assert whole.log[-1]["data"]["tasks_done"]
