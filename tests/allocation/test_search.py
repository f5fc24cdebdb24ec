"""The search: admissible, as good as an exhaustive search on small missions, the same whatever threads work on it."""

import itertools
import math
from dataclasses import replace

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from tests.random_missions import random_mission

import muster
from muster import core
from muster.allocation.search.search import Parameters, Variations, allocate
from muster.allocation.stop import Stop
from muster.generation.uniform import large_mission
from muster.model.problem import Problem


@pytest.mark.long
@settings(max_examples=400)
@given(
    seed=st.integers(0, 10**6),
    tasks=st.integers(0, 14),
    robots=st.integers(1, 5),
    near=st.sampled_from([1, 12]),
)
def test_no_plan_is_rejected_by_the_judge(seed, tasks, robots, near):
    mission = random_mission(seed, tasks=tasks, robots=robots)
    plan = muster.solve(mission, "search", iterations=150, seed=seed, near=near)
    verdict = muster.verify(mission, plan)
    assert verdict.violations == ()
    assert plan.objective_value == pytest.approx(verdict.value(), rel=1e-9)


def test_taking_out_a_task_on_a_short_cut_does_not_break_a_capacity():
    mission = replace(random_mission(1013, tasks=9, robots=3, min_suitability=0), suitability=None)
    plan = muster.solve(mission, "search", iterations=3000, objective="max")
    assert muster.verify(mission, plan, objective="max").violations == ()


def best_plan(problem):
    """(minus weight, objective) of the best of all plans."""
    n, m = len(problem.tasks), len(problem.robots)
    best = (0.0, 0.0)
    for robots in itertools.product(range(-1, m), repeat=n):
        shares = [[j for j in range(n) if robots[j] == i] for i in range(m)]
        if not all(problem.allowed[i, j] for i, share in enumerate(shares) for j in share):
            continue
        weight = sum(problem.tasks[j].priority for share in shares for j in share)
        if weight < -best[0]:
            continue
        for routes in itertools.product(*(itertools.permutations(share) for share in shares)):
            inspection = core.Inspection(problem.core, [list(route) for route in routes])
            if inspection.admissible and all(map(math.isfinite, inspection.usages)):
                best = min(best, (-weight, inspection.objective))
    return best


@pytest.mark.long
@settings(max_examples=60)
@given(seed=st.integers(0, 10**6), robots=st.integers(1, 2))
def test_small_missions_are_solved_to_the_optimum(seed, robots):
    mission = random_mission(seed, tasks=4, robots=robots)
    problem = Problem.compile(mission).ready()
    plan = muster.solve(mission, "search", iterations=5000, seed=seed)
    weight, value = best_plan(problem)
    assert plan.weight_completed == pytest.approx(-weight)
    assert plan.objective_value == pytest.approx(value)


@pytest.mark.parametrize(
    ("name", "ignore", "value", "iterations"),
    [
        ("31T-6R", (), 213.5615, 50_000),
        pytest.param("31T-6R", ("prerequisites", "suitability"), 191.1537, 50_000, marks=pytest.mark.long),
        ("16T-3R", (), 342.9001, 50_000),
        ("24T-5R", (), 189.2522, 50_000),
        ("31T-3R44-3R26", (), 219.4802, 50_000),
        pytest.param("31T-2R65-4R25", (), 232.1816, 150_000, marks=pytest.mark.long),
        pytest.param("eil51-5", (), 629.9601, 50_000, marks=pytest.mark.long),
    ],
)
def test_best_known_values_are_reached(name, ignore, value, iterations):
    mission = muster.load(name)
    plan = muster.solve(mission, "search", iterations=iterations, seed=1, ignore=ignore)
    verdict = muster.verify(mission, plan, ignore)
    assert verdict.valid
    assert verdict.tasks_completed == verdict.tasks_total
    assert verdict.value("total+max") <= value * 1.0001


def test_the_plan_is_the_same_for_every_number_of_threads():
    mission = muster.load("eil51-5")
    plans = [muster.solve(mission, "search", iterations=4000, seed=3, threads=threads) for threads in (0, 1, 3)]
    assert len({plan.routes for plan in plans}) == 1


def test_threads_work_out_children_until_time_is_up():
    mission = muster.load("eil51-5")
    plan = muster.solve(mission, "search", time_limit=0.5, threads=3)
    assert muster.verify(mission, plan).valid
    assert plan.objective_value < muster.solve(mission, "greedy").objective_value


def test_teams_that_are_too_large_to_try_every_place():
    mission = large_mission(600, 30)
    plan = muster.solve(mission, "search", iterations=3000)
    greedy = muster.solve(mission, "greedy")
    assert muster.verify(mission, plan).valid
    assert plan.complete
    assert plan.objective_value < 0.85 * greedy.objective_value


def test_it_goes_on_from_a_start_plan_and_completes_it():
    mission = muster.load("31T-6R")
    start = muster.Plan(routes=(muster.Route("r_0", ("28",)),))
    plan = muster.solve(mission, "search", start=start, iterations=500)
    assert plan.complete


@pytest.mark.parametrize(
    ("name", "value"),
    [
        *(("threads", -1), ("plans", -1), ("near", 0), ("longest_string", -1)),
        *(("hot", -1), ("cold", 0), ("removed", 0.5), ("blink", 1.0)),
    ],
)
def test_parameters_out_of_range_are_refused(name, value):
    with pytest.raises(muster.ParameterError, match=name):
        Parameters(**{name: value})


@pytest.mark.parametrize("timed", [False, True])
def test_variations_of_a_plan_differ_from_it_and_keep_the_rules(timed):
    mission = random_mission(7, tasks=14, robots=4, min_suitability=0)
    mission = replace(mission, suitability=None)
    if timed:
        tasks = tuple(replace(task, deadline_s=2000.0) for task in mission.tasks)
        mission = replace(mission, tasks=tasks)
    problem = Problem.compile(mission)
    first = allocate(problem, Stop(iterations=100), 1, Parameters(), None).routes
    variations = [Variations(problem, first, 2), Variations(problem, first, 2)]
    found = [[each.of(first) for _ in range(60)] for each in variations]
    assert found[0] == found[1]
    assert len({tuple(map(tuple, routes)) for routes in found[0]}) > 8
    for routes in found[0]:
        assert core.Inspection(problem.core, routes).admissible
        assert sum(map(len, routes)) == sum(map(len, first))
