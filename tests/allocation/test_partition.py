"""Teams that are searched part by part."""

from random import Random

import pytest
from hypothesis import given
from hypothesis import strategies as st
from tests.random_missions import random_mission

import muster
from muster.allocation.search.partition import divide, number_of_parts
from muster.allocation.search.search import SEARCH, Parameters
from muster.allocation.search.workers import Job, Limits, Threads
from muster.allocation.stop import Stop
from muster.generation.uniform import large_mission
from muster.model.problem import Problem


@pytest.mark.long
@given(seed=st.integers(0, 10**6), parts=st.integers(2, 5))
def test_plans_are_admissible_and_prerequisites_stay_together(seed, parts):
    mission = random_mission(seed, tasks=12, robots=5)
    plan = muster.solve(mission, "search", iterations=200, seed=seed, parts=parts)
    assert muster.verify(mission, plan).violations == ()


@given(seed=st.integers(0, 10**6), parts=st.integers(1, 6), division=st.integers(0, 3))
def test_a_division_holds_every_robot_once_and_no_task_twice(seed, parts, division):
    problem = Problem.compile(random_mission(seed, tasks=12, robots=5)).ready()
    random = Random(seed)
    routes = [[] for _ in problem.robots]
    if division:
        for j in random.sample(range(12), 8):
            routes[random.randrange(5)].append(j)
    pieces = list(divide(problem, routes, parts, division))
    assert sorted(i for piece in pieces for i in piece.robots) == list(range(5))
    tasks = [j for piece in pieces for j in piece.tasks]
    assert len(tasks) == len(set(tasks))
    for piece in pieces:
        held = set(piece.tasks)
        assert {j for i in piece.robots for j in routes[i]} <= held
        assert all(set(problem.prerequisites[j]) <= held for j in held)


@pytest.mark.long
def test_more_divisions_help_and_the_plan_is_nearly_that_of_a_whole_search():
    mission = large_mission(400, 20)
    whole = muster.solve(mission, "search", iterations=20_000)
    parted = muster.solve(mission, "search", iterations=20_000, parts=4)
    values = [value for _, value in parted.history]
    assert values == sorted(values, reverse=True)
    assert parted.complete
    assert parted.objective_value < 1.05 * whole.objective_value


@pytest.mark.long
def test_the_same_seed_and_iterations_give_the_same_plan():
    mission = large_mission(300, 12)
    first, second = (muster.solve(mission, "search", iterations=2_000, seed=5, parts=3) for _ in range(2))
    assert first.routes == second.routes


def test_a_start_plan_is_kept_or_improved():
    mission = large_mission(200, 10)
    start = muster.solve(mission, "search", iterations=3_000)
    plan = muster.solve(mission, "search", iterations=400, parts=3, start=start)
    assert plan.objective_value <= start.objective_value


@pytest.mark.parametrize(("tasks", "parts"), [(0, 1), (15_000, 1), (15_001, 11), (100_000, 67)])
def test_number_of_parts(tasks, parts):
    assert number_of_parts(tasks) == parts


@pytest.mark.parametrize("tasks", [600, pytest.param(16_000, marks=pytest.mark.long)])
def test_interrupted_before_anything_has_begun_there_is_a_whole_plan(tasks):
    mission = large_mission(tasks, tasks // 50)
    problem = Problem.compile(mission)
    stop = Stop(time_limit=600.0)
    stop.interrupt()
    plan = SEARCH.solve(problem, stop)
    assert plan.complete
    assert muster.verify(mission, plan).valid


def test_parts_that_have_not_begun_when_time_is_up_are_left_to_greedy():
    problem = Problem.compile(large_mission(60, 6)).ready()
    late = Stop(time_limit=0.0)
    job = Job(problem, 0, [[] for _ in problem.robots], Limits(0.0, None), lambda *_: pytest.fail("begun"))
    assert list(Threads(2).map([job, job], late)) == [None, None]
    plan = SEARCH.solve(problem, late, params=Parameters(parts=3))
    assert plan.complete
