"""Limits of times, teams and relations: one small plan a rule, by hand."""

import pytest

from muster.mission.model import Lag, Mission, Robot, Rules, Task
from muster.mission.plan import Plan, Route
from muster.verification import verify

R, S = Robot(id="r", position=(0, 0)), Robot(id="s", position=(0, 0))


def judged(tasks, *routes, robots=(R, S), ignore=()):
    names = [robot.id for robot in robots]
    plan = Plan(routes=tuple(Route(name, tuple(route)) for name, route in zip(names, routes, strict=True)))
    return verify(Mission(name="m", robots=robots, tasks=tasks), plan, ignore)


def begins(verdict):
    return {(route.robot, visit.task): visit.starts_s for route in verdict.routes for visit in route.visits}


def test_a_robot_waits_for_the_next_window():
    verdict = judged([Task(id="a", position=(5, 0), window_s=((0, 4), (9, 12)))], "a", "")
    assert verdict.valid
    assert begins(verdict) == {("r", "a"): 9}


@pytest.mark.parametrize(
    ("kind", "keys", "detail"),
    [
        ("window", {"window_s": ((0, 4),)}, "begins at 5 s at the earliest, its window closes at 4 s"),
        ("deadline", {"deadline_s": 6}, "ends at 7 s at the earliest, its deadline is 6 s"),
        ("team", {"robots_needed": 2}, "needs 2 robots, done by 1: r"),
        ("team", {"needs": {"lift_kg": 3}}, "needs lift_kg 3, r give 0"),
        ("relation", {"starts_with": ("b",)}, "begins together with b, which is not in the plan"),
    ],
)
def test_a_broken_rule_is_named_and_can_be_ignored(kind, keys, detail):
    tasks = [Task(id="a", position=(5, 0), duration_s=2, **keys), Task(id="b", position=(0, 0))]
    assert [(v.kind, v.task, v.detail) for v in judged(tasks, "a", "").violations] == [(kind, "a", detail)]
    assert judged(tasks, "a", "", ignore=kind).valid


def test_the_way_back_counts_for_a_shift():
    robot = Robot(id="r", position=(0, 0), available_until_s=9, return_to_start=True)
    (violation,) = judged([Task(id="a", position=(5, 0))], "a", robots=(robot,)).violations
    assert (violation.kind, violation.robot) == ("shift", "r")
    assert violation.detail == "its route ends at 10 s at the earliest, it is available until 9 s"


def test_a_greatest_lag_delays_the_prerequisite():
    tasks = [
        Task(id="a", position=(1, 0)),
        Task(id="b", position=(9, 0), prerequisites=("a",), lags={"a": Lag(within_s=2)}),
    ]
    verdict = judged(tasks, "a", "b")
    assert verdict.valid
    assert begins(verdict) == {("r", "a"): 7, ("s", "b"): 9}


def test_a_greatest_lag_that_the_way_alone_exceeds_has_no_schedule():
    tasks = [
        Task(id="a", position=(1, 0)),
        Task(id="b", position=(9, 0), prerequisites=("a",), lags={"a": Lag(within_s=2)}),
    ]
    verdict = judged(tasks, "ab", "")
    assert [(v.kind, v.task) for v in verdict.violations] == [("prerequisite", "b")]
    assert verdict.makespan_s is None


def test_a_team_begins_when_all_are_there_and_takes_as_long_as_the_slowest():
    slow = Robot(id="s", position=(9, 0), efficiency=0.5)
    verdict = judged([Task(id="a", position=(5, 0), duration_s=2, robots_needed=2)], "a", "a", robots=(R, slow))
    assert verdict.valid
    assert begins(verdict) == {("r", "a"): 5, ("s", "a"): 5}
    assert (verdict.makespan_s, verdict.tasks_completed) == (9, 1)


def test_lags_that_exclude_each_other_are_named_with_their_numbers():
    lags = {"b": {"a": Lag(after_s=100)}, "c": {"a": Lag(within_s=60), "b": Lag(after_s=5)}, "a": {}}
    tasks = tuple(
        Task(id=name, position=(k, 0), duration_s=10, prerequisites=tuple(lags[name]), lags=lags[name])
        for k, name in enumerate("abc")
    )
    robots = tuple(Robot(id=name, position=(0, 0)) for name in ("r", "s", "t"))
    mission = Mission(rules=Rules(timing="constant"), robots=robots, tasks=tasks)
    (said,) = verify(mission, Plan(routes=tuple(map(Route, "rst", (("a",), ("b",), ("c",)))))).violations
    first, _, others = said.detail.partition(": ")
    assert (said.kind, said.task, first) == ("prerequisite", "c", "no times keep all of these")
    assert set(others.split("; ")) == {
        "b begins at least 100 s after a ends",
        "c begins at least 5 s after b ends",
        "c begins at most 60 s after a ends",
        "a takes 10 s, b takes 10 s",
    }


def test_a_way_that_is_longer_than_a_lag_is_named():
    """One robot does all three: it comes to c, 60 m away, in 60 s and not in 30 s."""
    tasks = (
        Task(id="a", position=(0, 0)),
        Task(id="b", position=(0, 0), duration_s=7),
        Task(id="c", position=(60, 0), prerequisites=("a",), lags={"a": Lag(within_s=30)}),
    )
    mission = Mission(rules=Rules(timing="constant"), robots=(Robot(id="r", position=(0, 0)),), tasks=tasks)
    (said,) = verify(mission, Plan(routes=(Route("r", ("a", "b", "c")),))).violations
    assert "r comes to c 60 s after b ends" in said.detail
    assert "c begins at most 30 s after a ends" in said.detail
    assert said.detail.endswith("takes 7 s") or "b takes 7 s" in said.detail
