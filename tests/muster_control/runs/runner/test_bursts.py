"""Many orders at once to a run: the rest is planned again once for all of them, and the mission's clock goes on."""

from contextlib import closing
from itertools import pairwise

import pytest
from tests.muster_control.runs.stage import Kept, performed, performed_with_crashes, require_whole

import muster
from muster.mission.model import Mission, Robot, Task
from muster.mission.system.clock import VirtualClock
from muster.state import MissionState
from muster_control.runs.run_settings import request_of
from muster_control.runs.runner.log_recorder import LogRecorder
from muster_control.runs.runner.run_loop import STEPS_FIRST_S, RunLoop
from muster_control.runs.runner.simulated_run import QUANTUM_S, SimulatedRun

ROBOTS = tuple(Robot(id=f"r_{k}", position=(k % 5, k // 5), speed_mps=2.0) for k in range(20))
MISSION = Mission(robots=ROBOTS, tasks=tuple(Task(id=f"t_{k}", position=(3 * k, 40)) for k in range(20)))
PLAN = muster.solve(MISSION, iterations=20)


def new_task(k):
    return {"new_task": {"id": f"n_{k}", "position": [k % 40, 20 + k % 7]}}


def kinds(log, kind):
    return [entry for entry in log if entry["kind"] == kind]


def test_150_orders_that_wait_are_all_applied_by_one_new_plan():
    kept = performed(MISSION, PLAN, [(5.0, "event", new_task(k)) for k in range(150)])
    commands = kinds(kept.log, "command")
    assert [entry["data"]["outcome"] for entry in commands] == ["done"] * 150
    assert len({entry["time_s"] for entry in commands}) == 1
    assert [entry["data"]["task"]["id"] for entry in kinds(kept.log, "new_task")] == [f"n_{k}" for k in range(150)]
    for command in commands:  # what follows from it comes next
        assert kept.log[command["seq"]]["kind"] == "new_task"
    (again,) = kinds(kept.log, "replanned")
    assert [cause["task"]["id"] for cause in again["data"]["causes"]] == [f"n_{k}" for k in range(150)]
    assert again["time_s"] == commands[0]["time_s"]
    report = kept.log[-1]["data"]
    assert set(report["tasks_done"]) == {task.id for task in MISSION.tasks} | {f"n_{k}" for k in range(150)}


@pytest.mark.long
@pytest.mark.parametrize("crash", [5, pytest.param(15, marks=pytest.mark.long)])
def test_a_run_that_is_killed_within_a_burst_loses_no_order(crash):
    burst = [(5.0, "event", new_task(k)) for k in range(6)]
    asked = [*burst[:4], (5.0, "event", {"nonsense": 1}), (5.0, "pause", {}), *burst[4:]]
    asked += [(6.0, "event", new_task(6)), (9.0, "resume", {})]
    whole = performed(MISSION, PLAN, asked)
    assert len(kinds(whole.log, "replanned")) == 2  # with the pause and in it
    first = kinds(whole.log, "command")[0]["seq"]
    kept = performed_with_crashes(MISSION, PLAN, asked, [first + crash])
    require_whole(kept, MISSION)
    assert {f"n_{k}" for k in range(7)} <= set(kept.log[-1]["data"]["tasks_done"])


class Stream:
    """An inbox in which there is always an order, one a time."""

    def __init__(self, count):
        self._left, self._empty = list(range(count)), True

    def take(self, wait_s=0.0):
        self._empty = not self._empty
        if self._empty or not self._left:
            return None
        k = self._left.pop(0)
        return {"id": k + 1, "verb": "event", "data": new_task(k), "who": "ada"}


@pytest.mark.long
def test_while_orders_come_without_end_the_clock_goes_on():
    kept, clock = Kept(), VirtualClock(step_s=STEPS_FIRST_S / 10)
    recorder = LogRecorder(MISSION, kept, MissionState(MISSION))
    with closing(SimulatedRun(MISSION, PLAN, request_of("kinematic", {}, PLAN), recorder=recorder)) as world_run:
        how = {"speed": None, "starts_at": None, "ended": lambda: world_run.time_s > 20, "clock": clock}
        RunLoop(world_run, recorder, Stream(30), kept, **how).run()
    times = [entry["time_s"] for entry in kinds(kept.log, "command")]
    assert len(times) == 30
    assert all(later - earlier >= QUANTUM_S for earlier, later in pairwise(times))
