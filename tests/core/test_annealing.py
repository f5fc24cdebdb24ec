"""Annealing: what it keeps, what it finds, and that units do not matter to it."""

from dataclasses import replace
from random import Random

import pytest
from hypothesis import given
from hypothesis import strategies as st
from tests.random_missions import random_mission, with_travel_tables

import muster
from muster import core
from muster.allocation.allocator import routes_of
from muster.mission.model import OBJECTIVES
from muster.model.problem import Problem


@given(seed=st.integers(0, 10**6), tables=st.booleans(), objective=st.sampled_from(OBJECTIVES))
def test_annealing_keeps_the_tasks_and_never_ends_worse(seed, tables, objective):
    mission = random_mission(seed, tasks=9, objective=objective)
    mission = with_travel_tables(mission, seed) if tables else mission
    problem = Problem.compile(mission).ready()
    routes = routes_of(problem, muster.solve(mission, "genetic", iterations=3, seed=seed))
    annealing = core.Annealing(problem.core, routes, seed)
    objectives = [core.Inspection(problem.core, routes).objective]
    for robot in range(len(routes)):
        annealing.anneal(robot, 300)
        after = core.Inspection(problem.core, annealing.routes)
        assert after.admissible
        objectives.append(after.objective)
    assert objectives == sorted(objectives, reverse=True)
    assert [sorted(route) for route in annealing.routes] == [sorted(route) for route in routes]


def test_annealing_finds_the_shortest_order():
    mission = muster.Mission(
        robots=(muster.Robot(id="r", position=(0, 0)),),
        tasks=tuple(muster.Task(id=str(k), position=(x, 0)) for k, x in enumerate([5, 1, 4, 2, 3, 6, 8, 7])),
    )
    problem = Problem.compile(mission).ready()
    annealing = core.Annealing(problem.core, [list(range(8))], 1)
    annealing.anneal(0, 5000)
    assert annealing.routes == [[1, 3, 4, 2, 0, 5, 7, 6]]


def annealed(objective, *, speed=1.0, metre=1.0):
    """Forty tasks in random order after a while."""
    random = Random(5)
    places = [(random.uniform(0, 100) * metre, random.uniform(0, 100) * metre) for _ in range(40)]
    mission = muster.Mission(
        rules=muster.Rules(objective=objective),
        robots=(muster.Robot(id="r", position=(0, 0), speed_mps=speed),),
        tasks=tuple(muster.Task(id=str(k), position=place) for k, place in enumerate(places)),
    )
    annealing = core.Annealing(Problem.compile(mission).ready().core, [list(range(40))], 3)
    annealing.anneal(0, 2000)
    return annealing.routes


@pytest.mark.parametrize("objective", OBJECTIVES)
@pytest.mark.parametrize("factor", [2.0**-10, 2.0**10])
def test_neither_speed_nor_scale_matters_to_annealing(objective, factor):
    """Powers of two scale without rounding: the very same orders are tried and taken."""
    routes = annealed(objective)
    assert annealed(objective, speed=factor) == routes
    assert annealed(objective, metre=factor) == routes


@given(seed=st.integers(0, 10**6), factor=st.sampled_from([2.0**-6, 2.0**6]))
def test_the_pace_of_a_whole_mission_does_not_matter_to_annealing(seed, factor):
    """With prerequisites: all speeds by a factor, and all times by its inverse."""
    mission = random_mission(seed, tasks=9, objective="makespan", usage="distance")
    paced = replace(
        mission,
        robots=tuple(
            replace(r, speed_mps=r.speed_mps * factor, available_from_s=r.available_from_s / factor)
            for r in mission.robots
        ),
        tasks=tuple(replace(t, duration_s=t.duration_s and t.duration_s / factor) for t in mission.tasks),
    )
    routes = routes_of(Problem.compile(mission), muster.solve(mission, "genetic", iterations=1, seed=seed))
    outcomes = []
    for each in (mission, paced):
        annealing = core.Annealing(Problem.compile(each).core, routes, seed)
        for robot in range(len(routes)):
            annealing.anneal(robot, 200)
        outcomes.append(annealing.routes)
    assert outcomes[0] == outcomes[1]
