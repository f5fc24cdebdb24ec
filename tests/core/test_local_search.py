"""Local search alone: what it makes of routes is admissible, does no less, and costs no more."""

from dataclasses import replace
from itertools import pairwise, permutations
from math import dist
from random import Random

import pytest
from hypothesis import given
from hypothesis import strategies as st
from tests.random_missions import random_mission

import muster
from muster import core
from muster.allocation.algorithms import greedy
from muster.model.problem import Problem


def tour(seed, tasks, robots=1, objective="total", **robot):
    random = Random(seed)
    points = [(random.uniform(0, 100), random.uniform(0, 100)) for _ in range(tasks)]
    return muster.Mission(
        name="tour",
        rules=muster.Rules(objective=objective, return_to_start=True),
        robots=tuple(muster.Robot(id=f"r{k}", position=(50, 50), **robot) for k in range(robots)),
        tasks=tuple(muster.Task(id=f"t{k}", position=point) for k, point in enumerate(points)),
    )


def compiled(mission):
    return Problem.compile(mission).ready()


@given(seed=st.integers(0, 10**6), objective=st.sampled_from(("total", "max", "total+max")))
def test_routes_stay_admissible_and_cost_no_more(seed, objective):
    mission = random_mission(seed, tasks=12, objective=objective)
    problem = compiled(replace(mission, tasks=tuple(replace(task, prerequisites=()) for task in mission.tasks)))
    routes = greedy.completed(problem, [[] for _ in problem.robots])
    better = core.improved(problem.core, routes)
    assert core.Inspection(problem.core, better).admissible
    (weight, cost), (weight_before, cost_before) = problem.value(better), problem.value(routes)
    assert weight >= weight_before
    assert weight > weight_before or cost <= cost_before + 1e-9


@pytest.mark.parametrize("objective", ["average", "makespan"])
def test_rules_that_no_move_is_for_leave_routes_as_they_are(objective):
    problem = compiled(tour(0, 12, 2, objective))
    routes = [list(range(6)), list(range(6, 12))]
    assert core.improved(problem.core, routes) == routes


def test_one_tour_has_no_crossing_and_is_seldom_longer_than_the_shortest():
    shortest_found = 0
    for seed in range(40):
        mission = tour(seed, 7)
        problem = compiled(mission)
        (route,) = core.improved(problem.core, [list(range(7))])
        points = [(50, 50), *(task.position[:2] for task in mission.tasks)]

        def length(order, points=points):
            return sum(dist(points[a], points[b]) for a, b in pairwise([0, *(j + 1 for j in order), 0]))

        least = min(map(length, permutations(range(7))))
        assert length(route) <= 1.05 * least
        shortest_found += length(route) <= least + 1e-9
    assert shortest_found >= 36


def test_tasks_that_stay_do():
    order = list(range(40))
    problem = replace(compiled(tour(1, 40)), fixed=(tuple(order[:15]),))
    (route,) = core.improved(problem.core, [order])
    assert route[:15] == order[:15]
    assert problem.value([route])[1] < problem.value([order])[1]
