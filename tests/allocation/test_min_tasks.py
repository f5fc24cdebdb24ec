"""A robot does at least `min_tasks` tasks, or none at all: plans, reasons, what can never be done, and proofs."""

import itertools
from dataclasses import replace

import pytest

import muster
from muster import Mission, Robot, Rules, Task
from muster.allocation.bounds.feasibility import impossible
from muster.allocation.reasons.explanations import unassigned
from muster.allocation.remedies.remedies import remedies
from muster.mission.events import Event
from muster.mission.model import Lag
from muster.mission.plan import Reason, Unassigned
from muster.model.problem import Problem
from muster.planning.judging import admits
from muster.verification import verify

ABLE = ("greedy", "hill-climbing", "genetic", "greedy+genetic", "search")


def line(*robots, tasks=6, **rules):
    """Tasks at 1, 2, 3, ... on a line, and robots on it."""
    made = (Task(id=str(k), position=(float(k), 0.0)) for k in range(1, tasks + 1))
    return Mission(name="line", rules=Rules(timing="constant", **rules), robots=robots, tasks=tuple(made))


def van(name, x, least, **more):
    return Robot(id=name, position=(float(x), 0.0), min_tasks=least, **more)


def done(plan):
    return {route.robot: len(route.tasks) for route in plan.routes}


@pytest.mark.parametrize("allocator", ABLE)
def test_a_robot_does_enough_tasks_or_none(allocator):
    mission = line(van("a", 0, 3), van("b", 7, 4), van("c", 3.4, 2))
    plan = muster.solve(mission, allocator, iterations=200, seed=1)
    assert plan.tasks_completed == 6
    assert all(
        count == 0 or count >= robot.min_tasks for robot, count in zip(mission.robots, done(plan).values(), strict=True)
    )


def test_tasks_are_given_up_rather_than_the_rule():
    """One robot has room for two tasks and would have to do three."""
    mission = line(van("a", 0, 3, work_capacity=2), tasks=4)
    for allocator in ABLE:
        plan = muster.solve(mission, allocator, iterations=50)
        assert (plan.tasks_completed, done(plan)) == (0, {"a": 0})
    assert done(muster.solve(mission, "search", iterations=50, ignore="min-tasks")) == {"a": 2}


def test_search_fills_a_route_to_complete_more():
    """Six tasks fit only if b does three of them; by cost it would do none or one."""
    mission = line(van("a", 0, 1, work_capacity=3), van("b", 0, 3, work_capacity=20), objective="total")
    plan = muster.solve(mission, "search", iterations=300)
    assert plan.tasks_completed == 6
    assert done(plan)["b"] >= 3


def every_admissible(mission):
    """The best weight and total cost by trying all routes."""
    n, best = len(mission.tasks), (0, 0.0)
    for owners in itertools.product(range(len(mission.robots) + 1), repeat=n):
        cost, count = 0.0, 0
        for i, robot in enumerate(mission.robots):
            mine = [k + 1 for k in range(n) if owners[k] == i]
            if not mine:
                continue
            there = min(
                sum(abs(b - a) for a, b in itertools.pairwise((robot.position[0], *order)))
                for order in itertools.permutations(mine)
            )
            cost += there if len(mine) >= robot.min_tasks else float("inf")
            count += len(mine)
        if cost < float("inf"):
            best = min(best, (-count, cost))
    return -best[0], best[1]


@pytest.mark.parametrize("least", [(0, 0), (2, 2), (3, 2), (4, 5), (6, 6)])
def test_search_and_proof_find_the_best_of_all_plans(least):
    mission = line(van("a", 0.4, least[0]), van("b", 4.7, least[1]), tasks=5, objective="total")
    expected = every_admissible(mission)
    plan = muster.solve(mission, "search", iterations=500, seed=2)
    assert (plan.tasks_completed, plan.total_cost) == pytest.approx(expected)
    pytest.importorskip("ortools", reason="needs the extra exact")
    from muster.allocation.exact import solve_exactly

    problem = Problem.compile(mission)
    exact = solve_exactly(problem, 20.0, judge=admits)
    assert exact.optimal
    assert problem.value(exact.routes) == pytest.approx(expected)


def test_the_reason_names_the_robot_that_would_do_too_few():
    mission = line(van("a", 0, 2), van("b", 9, 3), tasks=3)
    problem = Problem.compile(mission)
    (left,) = unassigned(problem, [[0, 1], []])
    assert [(reason.robot, reason.reason) for reason in left.reasons] == [("a", "not-chosen"), ("b", "min-tasks")]
    assert left.reasons[1].detail == "with it b would do 1 task, and does at least 3 or none"


def test_a_robot_that_can_never_do_enough_does_nothing():
    locked = line(van("a", 0, 3), van("b", 1, 1), tasks=3)
    tasks = (
        replace(locked.tasks[0], only_robots=("a",)),
        *(replace(t, only_robots=("a", "b")) for t in locked.tasks[1:]),
    )
    tasks = (*tasks[:2], replace(tasks[2], only_robots=("b",)))
    (lost,) = impossible(Problem.compile(replace(locked, tasks=tasks)))
    assert lost.task == "1"
    said = {reason.robot: (reason.reason, reason.detail) for reason in lost.reasons}
    assert said["a"] == ("min-tasks", "does at least 3 tasks or none, and may do only 2 tasks")
    assert not impossible(Problem.compile(replace(locked, tasks=tasks), ignored=("min-tasks",)))


def test_a_least_number_of_one_binds_nothing():
    assert not Problem.compile(line(van("a", 0, 1))).asked
    assert not Problem.compile(line(van("a", 0, 1))).core.is_timed
    assert Problem.compile(line(van("a", 0, 2))).asked == {"min-tasks": "robot a: min_tasks"}


def test_an_auction_refuses_it_by_name():
    with pytest.raises(
        muster.ParameterError, match=r"auction cannot do robot a: min_tasks \(min-tasks\); expected greedy"
    ):
        muster.solve(line(van("a", 0, 2)), "auction")


def test_a_task_of_a_team_counts_for_each_member():
    heavy = Task(id="heavy", position=(3.0, 0.0), robots_needed=2)
    mission = line(van("a", 0, 2), van("b", 1, 2), tasks=2)
    mission = replace(mission, tasks=(*mission.tasks, heavy))
    plan = muster.solve(mission, "search", iterations=200)
    assert (plan.tasks_completed, done(plan)) == (3, {"a": 2, "b": 2})


def test_the_judge_finds_a_route_that_is_too_short():
    mission = line(van("a", 0, 2), van("b", 0, 2), tasks=3)
    verdict = verify(mission, muster.Plan(routes=(muster.Route("a", ("1", "2")), muster.Route("b", ("3",)))))
    assert [(v.kind, v.robot, v.detail) for v in verdict.violations] == [
        ("min-tasks", "b", "1 in its route, at least 2 or none")
    ]
    assert verify(mission, muster.Plan(routes=(muster.Route("a", ("1", "2", "3")),))).valid


def test_reasons_of_the_rule_are_checked():
    def judged(reason, routes):
        left = Unassigned("3", (Reason("b", reason, ""),))
        plan = muster.Plan(routes=tuple(muster.Route(*route) for route in routes), unassigned=(left,))
        kinds = [violation.kind for violation in verify(mission, plan).violations]
        return "reason" not in kinds

    mission = line(van("a", 0, 2), van("b", 0, 2), tasks=3)
    assert judged("min-tasks", [("a", ("1", "2")), ("b", ())])
    assert not judged("not-chosen", [("a", ("1", "2")), ("b", ())])
    assert not judged("min-tasks", [("a", ()), ("b", ("1", "2"))])


def test_what_robots_under_way_still_do_need_not_be_so_many():
    mission = line(van("a", 0, 3), van("b", 6, 3), tasks=6)
    plan = muster.solve(mission, "search", iterations=200)
    cancelled = tuple(Event(at_s=0.5, cancel_task=name) for name in ("2", "3", "5"))
    report = muster.simulate(replace(mission, events=cancelled), plan)
    assert sorted(task.task for task in report.tasks) == ["1", "4", "6"]


def test_greedy_leaves_tasks_that_one_robot_is_too_few_for_to_others():
    """The robot beside the task would have too little to do; the other may have one task."""
    mission = line(van("near", 1.0, 2), van("far", 9.0, 0), tasks=1)
    assert done(muster.solve(mission, "greedy")) == {"near": 0, "far": 1}


def test_search_puts_a_short_route_elsewhere_though_a_lag_forbids_the_nearest_place():
    tasks = tuple(
        Task(id=name, position=(x, 0.0), duration_s=20.0, prerequisites=before, lags=lags)
        for name, x, before, lags in (("0", 0.0, (), {}), ("1", 15.0, ("0",), {"0": Lag(within_s=10.0)}))
    )
    robots = van("a", 2.0, 0), van("b", -1.0, 2), van("c", 14.0, 0)
    mission = Mission(name="lag", rules=Rules(timing="constant", objective="lateness"), robots=robots, tasks=tasks)
    assert done(muster.solve(mission, "search", iterations=200)) == {"a": 1, "b": 0, "c": 1}


def test_the_remedy_is_the_number_of_tasks_that_the_robot_would_do():
    """One task is left for a robot that does at least three."""
    mission = line(van("a", 0, 3), tasks=1)
    problem = Problem.compile(mission)
    (remedy,) = remedies(problem, [[]], 0, admits)
    assert remedy.as_dict()["min_tasks"] == {"now": 3, "enough": 1}
    assert (remedy.enough, remedy.kinds, remedy.routes[0].tasks) == (True, ("min-tasks",), ("1",))
