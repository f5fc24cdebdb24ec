"""What rules ask of tasks of a mission under way, and the earliest schedule of routes, beside that of plans."""

import math

import pytest
from tests.timed_missions.missions import timed_mission

from muster import Mission, Robot, Task, solve
from muster.mission.model import Lag, TeamPart
from muster.model.problem import Problem
from muster.model.schedule import Course, Schedule
from muster.model.under_way import Missed, UnderWay, Wait

MISSION = Mission(
    robots=(
        Robot(id="r", position=(0, 0), available_until_s=90, abilities={"lift": 3}),
        Robot(id="s", position=(0, 0), skills=("camera",), abilities={"lift": 2}),
    ),
    tasks=(
        Task(id="a", position=(0, 0), window_s=((10, 20), (50, None)), deadline_s=70),
        Task(id="b", position=(0, 0), prerequisites=("a",), lags={"a": Lag(after_s=2, within_s=8)}),
        Task(id="c", position=(0, 0), starts_with=("d",), prerequisites=("b", "a"), robots_needed=3),
        Task(id="d", position=(0, 0), window_s=((15, 60),), team=(TeamPart(), TeamPart(requires=("camera",)))),
        Task(id="e", position=(0, 0), same_robot_as=("a",), needs={"lift": 4}),
        Task(id="f", position=(0, 0), other_robot_than=("a",)),
        Task(id="g", position=(0, 0), load=1.0),
        Task(id="h", position=(0, 0), load=-1.0, delivers="g"),
    ),
)
TASKS = {task.id: task for task in MISSION.tasks}
R, S = MISSION.robots
LIMITS = {name: UnderWay(MISSION, ()).limits(robot) for name, robot in (("R", R), ("S", S))}


def model(*ignored, without=()):
    return UnderWay(MISSION, [task for task in MISSION.tasks if task.id not in without], ignored)


def test_what_a_task_waits_for():
    some = model()
    assert list(some.waits(("a",), 5, {})) == [Wait("window", "waits for window: opens at 10 s", 10)]
    assert list(some.waits(("b",), 5, {})) == [Wait("prerequisite", "waits for a")]
    assert list(some.waits(("b",), 5, {"a": 4})) == [Wait("lag", "waits for lag: 6 s, after a", 6)]
    assert next(some.waits(("c", "d"), 5, {"a": 4})) == Wait("prerequisite", "waits for b")
    assert list(some.waits(("c", "d"), 15, {"a": 4, "b": 9})) == []
    assert list(some.waits(("h",), 5, {})) == [Wait("prerequisite", "waits for g")]
    assert list(some.waits(("c",), 5, {})) == [Wait("prerequisite", "waits for b, a")]


def test_tasks_that_are_gone_have_ended():
    assert list(model(without="a").waits(("b",), 5, {})) == []
    assert (model().unit("c"), model(without="d").unit("c")) == (("c", "d"), ("c",))


def test_why_a_task_can_never_begin():
    some = model()
    assert list(some.missed("d", 60, {})) == []
    assert list(some.missed("d", 61, {})) == [Missed("openings", "window: closed at 60 s")]
    assert list(some.missed("a", 71, {})) == [Missed("ends_by", "deadline: 70 s is over")]
    words = "prerequisite: not begun within 8 s after a, ended at 4 s"
    assert list(some.missed("b", 12, {"a": 4})) == []
    assert list(some.missed("b", 13, {"a": 4})) == [Missed("gaps", words)]
    next_one = Missed("openings", "window: closed at 20 s; the next is open from 50 s on", 50)
    assert [some.missed_opening("a", meant, now) for meant, now in ((15, 19), (15, 21), (55, 60))] == [
        None,
        next_one,
        None,
    ]


def test_why_a_robot_comes_too_late():
    some = model()
    assert some.too_late("d", LIMITS["S"], 61, 1, 0) == "window: would arrive at 61.0 s, after it has closed"
    assert some.too_late("a", LIMITS["S"], 69, 2, 0) == "deadline: would end at 71.0 s, after 70 s"
    assert some.too_late("b", LIMITS["R"], 80, 2, 9) == "shift: would be back at 91.0 s, after 90 s"
    assert some.too_late("b", LIMITS["S"], 80, 2, 9) == some.too_late("b", LIMITS["R"], 80, 2, 8) == ""
    assert model("shift").too_late("b", model("shift").limits(R), 80, 2, 9) == ""


def test_times_at_which_all_of_a_unit_may_begin():
    some = model()
    assert [some.next_begin_s(("a", "d"), now) for now in (0, 16, 21, 61)] == [15, 16, 50, math.inf]
    assert (some.last_begin_s("a"), some.last_begin_s("d"), some.last_begin_s("b")) == (70, 60, math.inf)
    assert some.begins_by_s("a", 12, 5, {}) == 20
    assert some.begins_by_s("a", 55, 5, {}) == 65
    assert some.begins_by_s("b", 12, 5, {"a": 4}) == 12


def test_what_a_team_lacks():
    some = model()
    assert [some.lacking(TASKS["c"], crew) for crew in ([], [R], [R, S])] == [
        *("3 more robots", "2 more robots", "1 more robot")
    ]
    assert some.lacking(TASKS["d"], [R]) == "one more robot with camera"
    assert model("skill").lacking(TASKS["d"], [R, R]) == some.lacking(TASKS["d"], [R, S]) == ""
    assert [some.lacking(TASKS["e"], crew) for crew in ([], [R], [R, S])] == ["0 of 4 lift, a robot", "3 of 4 lift", ""]
    assert [some.crew_size(name) for name in "acde"] == [1, 3, 2, None]


def test_who_does_which():
    some = model()
    assert (some.by_the_same("a"), some.by_the_same("e"), some.by_others("a")) == (["e"], ["a"], ["f"])
    assert model("relation").by_the_same("a") == []


def test_which_tasks_are_bound_by_more_than_their_order():
    assert [name for name in TASKS if model().is_bound(name)] == ["a", "b", "c", "d", "e"]
    assert model().is_timed
    assert not model("window", "deadline", "prerequisite", "team", "relation").is_timed
    assert model().soon_after(["a"]) == ["b"]


def earliest(problem, plan):
    """When tasks of a plan begin by the schedule of a mission under way that has just begun."""
    courses, lasts_s = [], {}
    for route in plan.routes:
        i = problem.robot_index[route.robot]
        tasks = [problem.task_index[name] for name in route.tasks]
        places = [problem.start(i), *tasks]
        legs_s = [float(problem.travel_seconds(i, [a], [b])[0, 0]) for a, b in zip(places, tasks, strict=False)]
        robot, home_s = problem.robots[i], 0.0
        if tasks and robot.place_at_end(problem.mission.rules) is not None:
            home_s = float(problem.travel_seconds(i, [tasks[-1]], [problem.end(i)])[0, 0])
        limits = UnderWay(problem.mission, ()).limits(robot)
        more = {"robot": robot.id, "limits": limits, "home_s": home_s}
        courses.append(Course(robot.available_from_s, route.tasks, legs_s, **more))
        for j, name in zip(tasks, route.tasks, strict=True):
            lasts_s[name] = max(lasts_s.get(name, 0.0), float(problem.work_seconds(i)[j]))
    schedule = Schedule(UnderWay(problem.mission, problem.tasks), courses, lasts_s, {}, 0.0)
    assert schedule.settle()
    return schedule.begins_s


def test_the_schedule_is_that_of_plans():
    """The core's earliest times, which plans state, and those of a run at its beginning are the same."""
    compared = 0
    for seed in range(60):
        mission = timed_mission(seed)
        plan = solve(mission, allocator="greedy")
        begins_s = earliest(Problem.compile(mission), plan)
        stated = {stop.name: stop.begin_s for route in plan.routes for stop in route.stops}
        assert begins_s == pytest.approx(stated, abs=1e-5), seed
        compared += len(stated)
    assert compared > 50


def test_from_when_on_a_robot_works_so_long():
    limits = UnderWay(MISSION, ()).limits(Robot(id="t", position=(0, 0), shifts_s=((0, 10), (20, 30), (40, None))))
    for now, seconds, begins in ((0, 10, 0), (1, 10, 20), (1, 11, 40), (1, 9, 1), (12, 5, 20), (29, 2, 40)):
        assert limits.set_out(now, seconds) == begins
        assert LIMITS["S"].set_out(now, seconds) == now
    assert limits.back_s(12, 5) == 25
    assert limits.back_s(12, 0) == 12


def test_a_duty_counts_from_when_the_robot_left():
    limits = UnderWay(MISSION, ()).limits(Robot(id="t", position=(0, 0), longest_duty_s=50, available_until_s=90))
    assert limits.too_late(60, 5, 20) == limits.too_late(60, 30, math.inf) == ""
    assert limits.too_late(60, 11, 20) == "duty: would be back at 71.0 s, after 70 s"
    assert limits.too_late(60, 31, None) == "shift: would be back at 91.0 s, after 90 s"
