"""Children of two plans: admissible, complete, and with routes of both."""

from random import Random

import pytest

import muster
from muster import core
from muster.allocation.algorithms import greedy
from muster.allocation.algorithms.route_exchange import crossed
from muster.model.problem import Problem


def problem_of(name: str) -> Problem:
    return Problem.compile(muster.load(name)).ready()


def plans_of(problem: Problem, count: int) -> list[list[list[int]]]:
    return [
        [[problem.task_index[j] for j in route.tasks] for route in plan.routes]
        for plan in (muster.solve(problem.mission, "search", iterations=200, seed=seed) for seed in range(count))
    ]


@pytest.mark.parametrize("name", ["eil51-5", "berlin52-5", "31T-6R", "flood"])
def test_children_are_admissible_and_do_no_task_twice(name):
    problem = problem_of(name)
    first, other = plans_of(problem, 2)
    random = Random(1)
    for _ in range(20):
        child = crossed(problem, first, other, random)
        assert core.Inspection(problem.core, child).admissible
        done = [j for route in child for j in route]
        assert len(done) == len(set(done))
        assert greedy.completed(problem, child) == child


def test_children_have_routes_of_both_parents():
    problem = problem_of("eil51-5")
    first, other = plans_of(problem, 2)
    children = [crossed(problem, first, other, Random(seed)) for seed in range(10)]
    assert sum(child not in (first, other) for child in children) > 2
    assert all(set(map(tuple, child)) & {*map(tuple, first), *map(tuple, other)} for child in children)
    assert len({tuple(map(tuple, child)) for child in children}) > 2


def test_a_plan_crossed_with_itself_is_that_plan():
    problem = problem_of("eil51-5")
    (plan,) = plans_of(problem, 1)
    assert crossed(problem, plan, plan, Random(0)) == plan
