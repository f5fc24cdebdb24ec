"""What a team did is put together from what its robots tell, also where they work on one task without knowing it."""

import pytest

from muster import Event, Mission, Robot, Task
from muster.execution import report_of
from muster.execution.record import NoObserver
from muster.mission.events import DelayedTask, MovedRobot, MovedTask
from muster.mission.plan import Plan, Reason, Route, Unassigned
from muster.mission.records import specified
from muster.model.problem import Problem
from muster_team.runs.team_log import TeamLog

MISSION = Mission(
    robots=(Robot(id="a", position=(0, 0)), Robot(id="b", position=(9, 0))), tasks=(Task(id="t", position=(0, 0)),)
)


@pytest.fixture
def log():
    return TeamLog(Problem.compile(MISSION), NoObserver(), lambda event: None)


def take(log, robot, came=None, began=None, ended=None):
    for kind, at_s in (("arrives", came), ("starts", began), ("ends", ended)):
        if at_s is not None:
            usage = {"usage": [1.0, 1.0]} if kind == "ends" else {}
            log.take(robot, at_s, kind, {"task": "t", "robot": robot, **usage}, used=at_s)


def report(log):
    return report_of(log.account, contacts=0, min_distance_m=None)


def test_a_task_counts_for_the_robot_that_has_ended_it_first(log):
    take(log, "a", came=1.0, began=2.0)
    take(log, "b", came=5.0, began=5.0)
    take(log, "a", ended=8.0)
    take(log, "b", ended=9.0)
    (task,) = report(log).tasks
    assert (task.robot, task.waiting_s) == ("a", 1.0)
    assert [h.data["robots"] for h in log.events if h.kind == "twice"] == [["a", "b"]]


def test_work_of_two_ends_though_the_one_that_began_first_has_failed(log):
    take(log, "a", came=1.0, began=2.0)
    take(log, "b", came=4.0, began=5.0)
    log.take_event(Event(at_s=6, robot_fails="a"), 6.0)
    take(log, "b", ended=9.0)
    assert report(log).starts_s == {"t": 5.0}
    assert report(log).waiting_s == 1.0


def test_a_task_that_ends_before_its_robot_hears_that_it_is_cancelled_is_done(log):
    take(log, "a", came=1.0, began=2.0)
    log.take_event(Event(at_s=3, cancel_task="t"), 3.0)
    take(log, "a", ended=3.1)
    assert (report(log).tasks_done, report(log).tasks_lost) == (("t",), ())
    assert report(log).starts_s == {"t": 2.0}


def test_who_has_forgotten_that_it_has_done_a_task_does_not_change_when_it_was_done(log):
    take(log, "a", came=1.0, began=2.0, ended=3.0)
    take(log, "a", came=5.0, began=6.0, ended=7.0)
    assert (report(log).starts_s, report(log).ends_s) == ({"t": 2.0}, {"t": 3.0})


def test_what_all_of_a_team_tell_is_told_once_and_work_that_is_broken_off_is_open_again(log):
    both = {"task": "t", "robot": "a", "team": ["a", "b"]}

    def told(kind, at_s, **data):
        for robot in ("a", "b"):
            log.take(robot, at_s, kind, {**both, **data}, used=at_s)

    for robot, at_s in (("a", 1.0), ("b", 3.0)):
        log.take(robot, at_s, "arrives", {"task": "t", "robot": robot}, used=at_s)
    told("starts", 4.0)
    told("work_broken_off", 5.0)
    assert report(log).starts_s == {}
    told("starts", 6.0)
    told("ends", 8.0, usage=[1.0, 2.0])
    assert [event.kind for event in log.events if event.kind != "arrives"] == [
        "starts",
        "work_broken_off",
        "starts",
        "ends",
        "part_ends",
    ]
    (task,) = report(log).tasks
    assert (task.robot, report(log).starts_s, report(log).ends_s) == ("a", {"t": 6.0}, {"t": 8.0})
    assert log.state.ledger.usage["t"] == (2.0, 4.0)
    assert log.state.ledger.team_waits_s["t"] == 8.0


def agree(log, now_s):
    """Robots agree on a plan that leaves out the task, which fits by all that the plan knows."""
    fits = tuple(Reason(robot.id, "not-chosen", "fits as number 1") for robot in MISSION.robots)
    routes = tuple(Route(robot.id, ()) for robot in MISSION.robots)
    log.agreed(Plan(routes=routes, unassigned=(Unassigned("t", fits),)), now_s)


def test_a_lost_task_has_the_reasons_of_the_robots_that_refused_it_and_none_of_those_that_failed(log):
    agree(log, 0.0)
    log.take_event(Event(at_s=3, robot_fails="b"), 3.0)
    assert log.lost()["t"] == "not-chosen: fits as number 1 (a); no longer taking part: b (failed at 3 s)"
    log.take("a", 4.0, "task_refused", {"task": "t", "robot": "a", "reason": "window: has closed"}, used=1.0)
    assert log.lost()["t"] == "window: has closed (a); no longer taking part: b (failed at 3 s)"
    agree(log, 5.0)
    (again,) = [event for event in log.events if event.kind == "replanned"]
    assert [cause["kind"] for cause in again.data["causes"]] == ["robot_fails", "task_refused"]
    log.take_event(Event(at_s=6, robot_fails="a"), 6.0)
    assert log.lost()["t"].startswith("no robot takes part any more")


def test_a_task_that_robots_refuse_after_the_last_plan_has_their_reasons(log):
    log.take("a", 4.0, "task_refused", {"task": "t", "robot": "a", "reason": "unreachable: there is no way"}, used=1.0)
    log.take("b", 4.0, "task_refused", {"task": "t", "robot": "b", "reason": "unreachable: there is no way"}, used=1.0)
    assert log.lost()["t"] == "unreachable: there is no way (a, b)"


def test_robots_that_agree_anew_without_a_word_have_a_cause_for_it(log):
    agree(log, 0.0)
    agree(log, 5.0)
    (again,) = [event for event in log.events if event.kind == "replanned"]
    assert again.line.startswith("replanned, as robots have agreed anew: ")


def test_a_task_that_is_ordered_after_another_was_missed_has_a_reason_of_its_own(log):
    agree(log, 0.0)
    missed = {"task": "t", "reason": "window: closed at 3 s", "next_s": None}
    log.take("a", 3.0, "window_missed", missed, used=1.0)
    log.take_event(Event(at_s=4, new_task=Task(id="new", position=(1, 1), starts_with=("t",))), 4.0)
    assert log.lost() == {"t": "window: closed at 3 s", "new": "not done"}


EVENTS = {
    "robot_fails": "a",
    "robot_silent": "a",
    "robot_returns": "a",
    "robot_joins": Robot(id="c", position=(5, 5)),
    "robot_removed": "a",
    "robot_moved": MovedRobot(robot="a", position=(3, 3)),
    "new_task": Task(id="new", position=(1, 1)),
    "cancel_task": "t",
    "move_task": MovedTask(task="t", position=(3, 3)),
    "delay_task": DelayedTask(task="t", by_s=2.0),
    "station_fails": "dock",
    "station_returns": "dock",
}


@pytest.mark.parametrize("kind", EVENTS)
def test_each_event_of_a_mission_becomes_one_of_its_kind(log, kind):
    """But for doors, which a team without a centre does not have."""
    assert EVENTS.keys() == {field.name for field in specified(Event)} - {"at_s", "door_closes", "door_opens"}
    log.take_event(Event(at_s=3, **{kind: EVENTS[kind]}), 3.0)
    (event,) = log.events
    assert (event.kind, event.time_s) == (kind, 3.0)
    assert "?" not in event.line
