"""Robots as real processes, over the real transport, in a simulated world that goes on at the pace of real time."""

import os
import signal
import threading
import time

import pytest

import muster
from muster import Event, Mission, Negotiation, Robot, Task
from muster.mission.errors import MusterError, ParameterError
from muster.mission.events import MovedRobot
from muster.mission.model import DelayedTask, MovedTask
from muster.simulation import KinematicWorld
from muster_team.processes.team import Team

pytest.importorskip("cryptography", reason="the extra `net` is not installed")


def line(events=(), **of_tasks):
    return Mission(
        robots=tuple(Robot(id=f"r_{k}", position=(20.0 * k, 0.0), speed_mps=2.0, radius_m=0.3) for k in range(3)),
        tasks=tuple(
            Task(id=str(k), position=(7.0 * k, 10.0 + 3 * (k % 3)), duration_s=2.0, **of_tasks) for k in range(9)
        ),
        events=tuple(events),
    )


def carried_out(mission, **how):
    """The report, and what happened by kind."""
    told = {}
    negotiation = how.pop("negotiation", Negotiation())
    report = muster.simulate(
        mission, negotiation, on_event=lambda h: told.setdefault(h.kind, []).append(h), **{"speed": 10.0} | how
    )
    return report, told


@pytest.mark.long
@pytest.mark.parametrize("transport", ["udp", pytest.param("zenoh", marks=pytest.mark.long)])
def test_without_faults_they_do_what_the_auction_in_one_process_says(transport):
    mission = line()
    report, told = carried_out(mission, negotiation=Negotiation(transport=transport))
    plan = muster.solve(mission, allocator="auction")
    assert not report.tasks_lost
    assert {task.task: task.robot for task in report.tasks} == {t: r.robot for r in plan.routes for t in r.tasks}
    assert report.objective.flown == pytest.approx(plan.objective_value, rel=1e-3)
    assert report.objective.planned == pytest.approx(plan.objective_value)
    assert report.reallocations == 0
    assert [h.data for h in told["mission_ended"]] == [{}]


@pytest.mark.long
def test_they_agree_anew_when_robots_fail_return_or_join_and_tasks_come_move_and_go(tmp_path):
    new, joining = Task(id="new", position=(5.0, 30.0)), Robot(id="j", position=(10.0, 30.0), radius_m=0.3)
    mission = line(
        [
            Event(at_s=3, move_task=MovedTask(task="8", position=(10.0, 40.0))),
            Event(at_s=3, delay_task=DelayedTask(task="0", by_s=5.0)),
            Event(at_s=4, cancel_task="7"),
            Event(at_s=6, robot_joins=joining),
            Event(at_s=8, robot_fails="r_1"),
            Event(at_s=8.5, robot_fails="r_1"),
            Event(at_s=20, new_task=new),
            Event(at_s=50, robot_returns="r_1"),
            Event(at_s=58, new_task=Task(id="last", position=(20.0, 5.0))),
        ]
    )
    file = tmp_path / "record.mcap"
    report, told = carried_out(mission, record=file)
    assert dict(report.tasks_lost) == {"7": "cancelled at 4 s"}
    assert set(report.tasks_done) == {task.id for task in mission.tasks} - {"7"} | {"new", "last"}
    assert {h.data["task"]: h.data["robot"] for h in told["ends"]}["last"] == "r_1"
    assert "twice" not in told
    assert [h.data["robot_fails"] for h in told["without_effect"]] == ["r_1"]
    assert report.reallocations >= 1
    assert report.ends_s["0"] - report.starts_s["0"] == pytest.approx(7.0, abs=1.1)

    from muster.report.record import read_record

    recording = read_record(file)
    assert recording.complete
    assert {task: recording.outcome.stage(task) for task in ("8", "new", "last")} == dict.fromkeys(
        ("8", "new", "last"), "done"
    )
    assert {robot.id for robot in recording.robots} == {"r_0", "r_1", "r_2", "j"}


@pytest.mark.long
def test_a_robot_that_is_moved_goes_on_from_there_and_one_that_is_taken_away_returns():
    mission = line(
        [
            Event(at_s=2, robot_moved=MovedRobot(robot="r_0", position=(-12.0, 5.0))),
            Event(at_s=2, robot_removed="r_2"),
            Event(at_s=6, robot_returns="r_2"),
        ]
    )
    report, told = carried_out(mission)
    assert set(report.tasks_done) == {task.id for task in mission.tasks}
    assert [h.data["robot"] for h in told["robot_moved"]] == ["r_0"]
    assert [h.data["robot"] for h in told["robot_removed"]] == ["r_2"]
    assert [h.data["robot"] for h in told["robot_returns"]] == ["r_2"]
    assert report.contacts == 0


@pytest.mark.long
def test_when_all_robots_fail_the_mission_ends_with_what_was_done():
    report, told = carried_out(line([Event(at_s=8 + k, robot_fails=f"r_{k}") for k in range(3)]))
    assert set(report.tasks_done) < {task.id for task in line().tasks}
    assert {h.data["robot"] for h in told["robot_fails"]} == {"r_0", "r_1", "r_2"}
    assert all("failed at" in reason for _, reason in report.tasks_lost)
    assert sum(robot.usage_flown for robot in report.robots) > 10  # that of the dead, too
    assert [(end.robot, end.why) for end in report.team.ended] == [(f"r_{k}", "killed by SIGKILL") for k in range(3)]


@pytest.mark.long
def test_a_robot_that_nobody_hears_goes_on_and_what_is_done_twice_is_told():
    mission = Mission(
        robots=tuple(Robot(id=f"r_{k}", position=(12.0 * k, 0.0), radius_m=0.3) for k in range(2)),
        tasks=tuple(Task(id=str(k), position=(12.0 * k, 8.0), duration_s=10.0) for k in range(2)),
        events=(
            Event(at_s=1, robot_silent="r_0"),
            Event(at_s=60, robot_returns="r_0"),
        ),
    )
    report, told = carried_out(mission)
    assert set(report.tasks_done) == {"0", "1"}
    assert {h.data["task"] for h in told["twice"]} <= {"0", "1"}
    assert "twice" in told
    assert report.as_dict()["done_twice"].keys() == {h.data["task"] for h in told["twice"]}
    assert all(sorted(robots) == ["r_0", "r_1"] for robots in report.done_twice.values())
    (silence,), (split,) = report.team.silent, report.team.splits
    assert (silence.robot, silence.from_s, silence.until_s) == (
        "r_0",
        pytest.approx(1, abs=1),
        pytest.approx(60, abs=1),
    )
    assert split.groups == (("r_0",), ("r_1",))
    assert split.until_s > silence.until_s


@pytest.mark.long
def test_tasks_that_must_not_be_done_twice_wait_for_who_is_cut_off():
    mission = line(
        [Event(at_s=1, robot_silent="r_0"), Event(at_s=45, robot_returns="r_0")], across_partition="at-most-once"
    )
    report, told = carried_out(mission)
    assert not report.tasks_lost
    assert "twice" not in told


@pytest.mark.long
def test_robots_are_heard_though_the_world_is_slower_than_real_time(monkeypatch):
    advance = KinematicWorld.advance

    def slowly(world, until_s):
        time.sleep(0.06)
        return advance(world, until_s)

    monkeypatch.setattr(KinematicWorld, "advance", slowly)
    mission = Mission(robots=(Robot(id="a", position=(0, 0)),), tasks=(Task(id="t", position=(4, 0)),))
    halt = threading.Event()
    guard = threading.Timer(30.0, halt.set)
    guard.start()
    report, _ = carried_out(mission, halt=halt)
    guard.cancel()
    assert report.tasks_done == ("t",)


def test_what_is_neither_a_plan_nor_a_negotiation_is_refused():
    with pytest.raises(ParameterError, match="expected a Plan or a Negotiation"):
        muster.simulate(line(), "auction")
    with pytest.raises(ParameterError, match="expected auction"):
        muster.simulate(line(), Negotiation(method="dance"))
    with pytest.raises(ParameterError, match="speed: 11; expected at most 10"):
        muster.simulate(line(), Negotiation(), speed=11.0)


@pytest.mark.long
def test_who_does_not_agree_in_time_does_not_begin():
    with pytest.raises(MusterError, match="no agreement within 0 s"):
        muster.simulate(line(), Negotiation(limit_s=0.0))


@pytest.mark.long
def test_a_robot_that_is_stopped_holds_up_nobody_and_the_report_says_so(monkeypatch):
    """It stands still until the others have done all that is left; what they began anew is theirs."""
    teams = []
    enter = Team.__enter__
    monkeypatch.setattr(Team, "__enter__", lambda team: teams.append(team) or enter(team))
    stopped, seen = [], []

    def listen(event):
        seen.append(event)
        if event.kind == "starts" and not stopped:
            stopped.append(event.data["robot"])
            os.kill(teams[0].pids[stopped[0]], signal.SIGSTOP)
        others = {e.data["task"] for e in seen if e.kind == "ends" and e.data["robot"] not in stopped}
        if len(others) == len(line().tasks) and stopped:
            os.kill(teams[0].pids[stopped[0]], signal.SIGCONT)

    report = muster.simulate(line(), Negotiation(), on_event=listen, speed=10.0)
    assert not report.tasks_lost
    (robot,) = stopped
    (silence,) = (s for s in report.team.silent if s.why == "its process did not answer")
    assert silence.robot == robot
    assert silence.until_s - silence.from_s > 40.0
    others = tuple(f"r_{k}" for k in range(3) if f"r_{k}" != robot)
    assert {others, (robot,)} in [set(split.groups) for split in report.team.splits]
    assert report.team.ended == ()
