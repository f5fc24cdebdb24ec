"""When tasks are done: waiting, late robots, deadlocks."""

import pytest

from muster.mission.model import Mission, Robot, Task
from muster.mission.plan import Plan, Route
from muster.verification import Verdict, verify


def judge(mission: Mission, ignored: tuple[str, ...] = (), **routes: list[str]) -> Verdict:
    stated = tuple(Route(robot, tuple(tasks)) for robot, tasks in routes.items())
    return verify(mission, Plan(routes=stated), ignored)


def line(tasks: dict[str, tuple[float, float, list[str]]], **robots: dict) -> Mission:
    """Robots at 0 and tasks at x on a line, with a duration and prerequisites."""
    return Mission(
        robots=tuple(Robot(id=name, position=(0, 0), **keys) for name, keys in robots.items()),
        tasks=tuple(
            Task(id=name, position=(x, 0), duration_s=duration, prerequisites=tuple(prerequisites))
            for name, (x, duration, prerequisites) in tasks.items()
        ),
    )


def times(verdict: Verdict) -> dict[str, tuple[float, float, float]]:
    return {v.task: (v.arrives_s, v.starts_s, v.ends_s) for route in verdict.routes for v in route.visits}


def test_a_robot_waits_at_the_task_for_the_last_of_its_prerequisites():
    mission = line({"a": (1, 2, ["b", "c"]), "b": (5, 5, []), "c": (3, 1, []), "d": (2, 1, [])}, r={}, s={}, t={})
    verdict = judge(mission, r=["a", "d"], s=["b"], t=["c"])
    assert verdict.valid
    assert times(verdict) == {"a": (1, 10, 12), "d": (13, 13, 14), "b": (5, 5, 10), "c": (3, 3, 4)}
    assert verdict.makespan_s == 14


def test_no_waiting_where_prerequisites_are_ignored():
    mission = line({"a": (1, 2, ["b"]), "b": (5, 5, [])}, r={}, s={})
    verdict = judge(mission, ignored=("prerequisites",), r=["a"], s=["b"])
    assert times(verdict)["a"] == (1, 1, 3)


def test_a_chain_of_waits_across_three_robots():
    mission = line({"a": (1, 1, []), "b": (1, 1, ["a"]), "c": (1, 1, ["b"])}, r={}, s={}, t={})
    verdict = judge(mission, r=["c"], s=["b"], t=["a"])
    assert times(verdict) == {"a": (1, 1, 2), "b": (1, 2, 3), "c": (1, 3, 4)}


def test_a_robot_leaves_when_it_is_available():
    mission = line({"a": (2, 1, []), "b": (4, 1, ["a"])}, r={"available_from_s": 100, "speed_mps": 2}, s={})
    verdict = judge(mission, r=["a"], s=["b"])
    assert [route.leaves_s for route in verdict.routes] == [100, 0]
    assert times(verdict) == {"a": (101, 101, 102), "b": (4, 102, 103)}
    assert verdict.makespan_s == 103
    assert verdict.total_cost == 6


def test_robots_that_wait_for_nobody_have_the_times_that_they_have_beside_one_that_waits():
    windows = {"a": (7, ((5, 6), (20, 30))), "b": (9, ((0, 1),)), "c": (4, ())}
    own = [Task(id=k, position=(x, 0), duration_s=3, window_s=window) for k, (x, window) in windows.items()]
    waiting = [Task(id="first", position=(2, 0)), Task(id="second", position=(3, 0), prerequisites=("first",))]
    robots = (Robot(id="r", position=(0, 0), available_from_s=2, available_until_s=30), Robot(id="s", position=(0, 0)))
    alone = judge(Mission(robots=robots, tasks=tuple(own)), r=["a", "b"], s=["c"])
    beside = judge(Mission(robots=robots, tasks=(*own, *waiting)), r=["a", "b"], s=["c", "first", "second"])
    assert times(alone) == {"a": (9, 20, 23), "b": (25, 25, 28), "c": (4, 4, 7)}
    assert times(beside).items() >= times(alone).items()
    assert [v.kind for v in alone.violations] == [v.kind for v in beside.violations] == ["window"]


def test_back_after_waiting():
    mission = line({"a": (2, 1, ["b"]), "b": (4, 1, [])}, r={"return_to_start": True, "speed_mps": 0.5}, s={})
    verdict = judge(mission, r=["a"], s=["b"])
    assert [route.back_s for route in verdict.routes] == [6 + 4, None]


def test_a_prerequisite_that_is_not_in_the_plan_is_not_waited_for():
    mission = line({"a": (1, 1, ["b"]), "b": (5, 5, [])}, r={})
    verdict = judge(mission, r=["a"])
    assert [violation.kind for violation in verdict.violations] == ["prerequisite"]
    assert verdict.makespan_s == 2


def deadlock_of(verdict: Verdict) -> str:
    (violation,) = verdict.violations
    assert (violation.kind, violation.robot, violation.task) == ("deadlock", None, None)
    assert verdict.makespan_s is None
    assert verdict.value("makespan") is None
    assert all(route.visits == () and route.back_s is None for route in verdict.routes)
    return violation.detail


def test_deadlock_within_one_route():
    mission = line({"a": (1, 1, ["c"]), "b": (2, 1, []), "c": (3, 1, [])}, r={"return_to_start": True})
    assert deadlock_of(judge(mission, r=["a", "b", "c"])) == "r: a -> b -> c; prerequisite: c -> a"


def test_deadlock_across_two_robots_through_a_chain_of_prerequisites():
    tasks = {"1": (1, 1, ["4"]), "2": (2, 1, []), "3": (3, 1, ["5"]), "4": (4, 1, []), "5": (5, 1, ["2"])}
    mission = line(tasks, r={}, s={}, t={})
    verdict = judge(mission, r=["1", "2"], s=["3", "4"], t=["5"])
    assert deadlock_of(verdict) == "r: 1 -> 2; prerequisite: 2 -> 5 -> 3; s: 3 -> 4; prerequisite: 4 -> 1"
    assert verdict.total_cost == 2 + 4 + 5
    assert verdict.average == pytest.approx((1 + 2 + 3 + 4 + 5) / 5)


def test_a_deadlock_is_told_from_the_first_task_of_a_route():
    """Not from the middle of a route or of a chain of prerequisites, though their ids come first."""
    tasks = {"8": (1, 1, ["2"]), "1": (2, 1, []), "9": (3, 1, []), "2": (4, 1, ["9"])}
    verdict = judge(line(tasks, r={}, s={}), r=["8", "1", "9"], s=["2"])
    assert deadlock_of(verdict) == "r: 8 -> 1 -> 9; prerequisite: 9 -> 2 -> 8"


def test_ignored_prerequisites_do_not_deadlock():
    mission = line({"a": (1, 1, ["b"]), "b": (2, 1, [])}, r={})
    assert judge(mission, r=["a", "b"], ignored=("prerequisites",)).valid
    assert not judge(mission, r=["a", "b"]).valid


def test_a_task_that_follows_its_own_prerequisite_is_fine():
    mission = line({"a": (1, 1, []), "b": (2, 1, ["a"])}, r={})
    assert times(judge(mission, r=["a", "b"])) == {"a": (1, 1, 2), "b": (3, 3, 4)}


@pytest.mark.long
def test_a_long_chain():
    """Deeper than Python recurses: 5,000 tasks, each waiting for the one before, on the other robot."""
    tasks = {str(k): (0.0, 1.0, [str(k - 1)] if k else []) for k in range(5000)}
    mission = line(tasks, r={}, s={})
    verdict = judge(mission, r=[str(k) for k in range(0, 5000, 2)], s=[str(k) for k in range(1, 5000, 2)])
    assert verdict.makespan_s == 5000
    late = judge(mission, r=[str(k) for k in range(4999, -1, -1)])
    assert late.makespan_s is None
