"""Reasons and remedies where times, teams and relations matter; tests/timed_missions tries random missions."""

import math

import pytest

import muster
from muster import Mission, Robot, Rules, Task, verify
from muster.allocation.bounds.feasibility import impossible
from muster.allocation.reasons.explanations import unassigned
from muster.allocation.remedies.remedies import remedies, smallest_as_is
from muster.mission.model import Lag, TravelTable
from muster.mission.plan import Plan, Route
from muster.model.problem import Problem
from muster.planning.explaining.explanations import admits


def task(name, x, **more):
    return Task(id=name, position=(x, 0), duration_s=5, **more)


def compiled(*tasks, robots=2, objective=None, **rules):
    made = tuple(Robot(id=f"r_{k}", position=(10 * k, 0)) for k in range(robots))
    return Problem.compile(Mission(rules=Rules(timing="constant", **rules), robots=made, tasks=tasks), objective)


def reasons(problem, *routes):
    return [(r.reason, r.detail) for item in unassigned(problem, routes) for r in item.reasons]


def test_remedies_where_a_task_is_tied_to_another_that_the_plan_leaves_out():
    problem = compiled(task("a", 1, window_s=((0, 2),)), task("b", 2, other_robot_than=("a",)), task("c", 3))
    found = smallest_as_is(problem, [[], []], 1, admits)
    assert (found.robot, found.kinds, found.enough) == ("r_0", (), True)
    assert [remedy.enough for remedy in remedies(problem, [[2], []], 0, admits)] == [True, True]


def test_a_task_fits_where_the_way_back_is_part_of_the_makespan():
    problem = compiled(task("a", 1), task("b", 12), objective="makespan", makespan_includes_return=True)
    assert reasons(problem, [0], []) == [
        ("not-chosen", "fits as number 2, for 12.00 m in all"),
        ("not-chosen", "fits as number 1, for 2.00 m in all"),
    ]


def test_no_way_for_another_robot_of_the_team():
    inf = math.inf
    places = ("r_0", "r_1", "a")
    tables = {"x": TravelTable(places, ((0, 1, 1), (1, 0, 1), (1, 1, 0)))}
    tables["y"] = TravelTable(places, ((0, 1, inf), (1, 0, inf), (inf, inf, 0)))
    robots = (Robot(id="r_0", type="x", position=(0, 0)), Robot(id="r_1", type="y", position=(0, 0)))
    mission = Mission(
        rules=Rules(travel="matrix", timing="constant"),
        robots=robots,
        tasks=(task("a", 1, robots_needed=2),),
        travel={"x": "x.csv", "y": "y.csv"},
        travel_tables=tables,
    )
    assert reasons(Problem.compile(mission), [], []) == [
        ("unreachable", "there is no way for another robot of its team"),
        ("unreachable", "there is no way to it"),
    ]
    assert verify(mission, muster.solve(mission, "greedy")).valid


@pytest.mark.parametrize("allocator", ["greedy", "search"])
def test_tasks_with_the_same_robots_as_one_that_is_inserted_last(allocator):
    """No team for it is that of both others."""
    robots = tuple(Robot(id=f"r_{k}", position=(k, 0)) for k in range(2))
    tied = {"same_robot_as": ("last",)}
    tasks = (task("last", 50), task("one", 2, **tied), task("two", 3, robots_needed=2, **tied))
    mission = Mission(robots=robots, tasks=tasks)
    plan = (
        muster.solve(mission, allocator, iterations=200) if allocator == "search" else muster.solve(mission, allocator)
    )
    verdict = verify(mission, plan)
    assert verdict.valid
    assert verdict.tasks_completed == 2


def test_a_bound_that_held_only_until_the_task_before_was_lost():
    first, second = task("a", 100), task("b", 1, prerequisites=("a",), other_robot_than=("a",))
    mission = Mission(robots=(Robot(id="r", position=(0, 0), work_capacity=10),), tasks=(first, second))
    found = {item.task: [(r.reason, r.detail) for r in item.reasons] for item in impossible(Problem.compile(mission))}
    assert found["b"] == [("prerequisite", "a comes before it and can never be done")]


def test_no_way_at_the_only_place_that_keeps_a_lag():
    """b has no way on to c; behind c it is too long after a. The judge knows that lags may leave such places alone."""
    inf = math.inf
    table = TravelTable(("r", "a", "b", "c"), ((0, 1, 1, 1), (1, 0, 1, 1), (1, 1, 0, inf), (1, 1, 1, 0)))
    after_a = task("b", 2, prerequisites=("a",), lags={"a": Lag(within_s=2.0)})
    mission = Mission(
        rules=Rules(travel="matrix", timing="constant"),
        robots=(Robot(id="r", type="x", position=(0, 0)),),
        tasks=(task("a", 1), after_a, task("c", 3)),
        travel={"x": "x.csv"},
        travel_tables={"x": table},
    )
    problem = Problem.compile(mission)
    (left_out,) = unassigned(problem, [[problem.task_index["a"], problem.task_index["c"]]])
    assert [reason.reason for reason in left_out.reasons] == ["unreachable"]
    plan = Plan(routes=(Route("r", ("a", "c")),), unassigned=(left_out,))
    assert verify(mission, plan).valid


def test_the_end_of_a_route_is_that_of_all_plans_not_of_those_of_the_robots_left():
    """r_1 is slow from a to b; r_0, which is too late at b for its shift, has no such way."""
    robots = (
        Robot(id="r_0", position=(0, 0), available_until_s=24.0),
        Robot(id="r_1", position=(10, 0), speed_mps=0.5, available_until_s=28.0),
    )
    first, second = task("a", 10, only_robots=("r_1",)), task("b", 20, prerequisites=("a",))
    mission = Mission(rules=Rules(timing="constant"), robots=robots, tasks=(first, second))
    said = [reason.detail for item in impossible(Problem.compile(mission)) for reason in item.reasons]
    assert said == [
        "its route would end at 25 s at the earliest, its shift ends at 24 s",
        "its route would end at 30 s at the earliest, its shift ends at 28 s",
    ]


@pytest.mark.parametrize("allocator", ["greedy", "auction"])
def test_a_team_is_of_robots_that_have_the_time_to_wait_for_each_other(allocator):
    """The cheapest of two like robots would be late for the end of its shift when the third comes."""
    places = {"near": 1.0, "off": 20.0, "far": -30.0}
    robots = tuple(
        Robot(
            id=name,
            position=(x, 0.0),
            abilities={"lift_kg": 10.0 if name == "far" else 20.0},
            available_until_s=12.0 if name == "near" else None,
        )
        for name, x in places.items()
    )
    task = Task(id="lift", position=(0.0, 0.0), duration_s=5.0, needs={"lift_kg": 30.0})
    plan = muster.solve(Mission(name="lift", robots=robots, tasks=(task,)), allocator)
    assert {route.robot for route in plan.routes if route.tasks} == {"off", "far"}
