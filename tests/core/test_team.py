"""The working state of the search: what it says of a change equals what is found after it."""

import itertools
import math
from dataclasses import replace
from random import Random

import pytest
from hypothesis import given
from hypothesis import strategies as st
from tests.random_missions import random_mission

from muster import core
from muster.model.problem import Problem


def compiled(seed, **kwargs):
    return Problem.compile(random_mission(seed, **kwargs)).ready()


def without_prerequisites(seed):
    mission = random_mission(seed, objective="makespan")
    tasks = tuple(replace(task, prerequisites=()) for task in mission.tasks)
    return Problem.compile(replace(mission, tasks=tasks)).ready()


def random_team(problem, random, share=0.8):
    """A team with random routes that do not deadlock, whatever the capacities; prerequisites are done first."""
    team = core.Team(problem.core, [[] for _ in problem.robots])
    for j in random.sample(range(len(problem.tasks)), int(share * len(problem.tasks))):
        sold = {k for route in team.routes for k in route}
        if set(problem.prerequisites[j]) <= sold:
            i = random.randrange(len(problem.robots))
            first, last = team.bounds(j)[i]
            if first <= last:
                team.insert(j, i, random.randint(first, last))
    return team


def deadlocks(problem, routes):
    """Whether route order and prerequisites, through tasks that are left out too, have a cycle (Kahn)."""
    before = {j: set(problem.prerequisites[j]) for j in range(len(problem.tasks))}
    for route in routes:
        for earlier, later in itertools.pairwise(route):
            before[later] = before[later] | {earlier}
    done = set()
    while True:
        ready = {j for j in before if j not in done and before[j] <= done}
        if not ready:
            return len(done) < len(before)
        done |= ready


@given(seed=st.integers(0, 10**6))
def test_what_a_task_adds_is_found_after_it_is_put_there(seed):
    problem, random = compiled(seed, objective="makespan"), Random(seed)
    team = random_team(problem, random)
    for j in team.absent:
        for i, route in enumerate(team.routes):
            for at in range(len(route) + 1):
                growth, later = team.growth(i, j, at), team.later_arrivals(i, j, at)
                usage, arrivals = team.usages[i], team.arrivals[i]
                team.commit()
                team.insert(j, i, at)
                if math.isfinite(team.usages[i]):
                    assert team.usages[i] - usage == pytest.approx(growth, abs=1e-9)
                    assert team.arrivals[i] - arrivals == pytest.approx(later, abs=1e-9)
                team.rollback()


@given(seed=st.integers(0, 10**6))
def test_the_bounds_are_exactly_the_places_that_deadlock_nothing(seed):
    problem, random = compiled(seed, tasks=7), Random(seed)
    team = random_team(problem, random)
    sold = {k for route in team.routes for k in route}
    for j in team.absent:
        if not set(problem.prerequisites[j]) <= sold:
            continue
        for i, (first, last) in enumerate(team.bounds(j)):
            route = team.routes[i]
            for at in range(len(route) + 1):
                routes = [[*r[:at], j, *r[at:]] if k == i else r for k, r in enumerate(team.routes)]
                assert (first <= at <= last) == (not deadlocks(problem, routes)), (i, j, at)


@given(seed=st.integers(0, 10**6))
def test_figures_are_those_of_a_full_evaluation(seed):
    problem, random = without_prerequisites(seed) if seed % 2 else compiled(seed, objective="makespan"), Random(seed)
    team = random_team(problem, random)
    for _ in range(6):
        sold = [k for route in team.routes for k in route]
        if sold:
            team.remove(random.choice(sold))
        inspection = core.Inspection(problem.core, team.routes)
        assert team.usages == pytest.approx(inspection.usages)
        if inspection.makespan is not None and not any(problem.prerequisites):
            assert team.makespan() == pytest.approx(inspection.makespan)


@given(seed=st.integers(0, 10**6))
def test_undo_brings_everything_back(seed):
    problem, random = compiled(seed), Random(seed)
    team = random_team(problem, random)
    team.commit()
    routes, usages, arrivals, absent = team.routes, team.usages, team.arrivals, sorted(team.absent)
    for _ in range(10):
        sold = [k for route in team.routes for k in route]
        if sold and random.random() < 0.5:
            team.remove(random.choice(sold))
        elif team.absent:
            i = random.randrange(len(problem.robots))
            team.insert(random.choice(team.absent), i, random.randint(0, len(team.routes[i])))
    team.rollback()
    assert (team.routes, team.usages, team.arrivals, sorted(team.absent)) == (routes, usages, arrivals, absent)
    fresh = core.Team(problem.core, routes)
    assert (fresh.usages, fresh.arrivals) == (usages, arrivals)


@given(seed=st.integers(0, 10**6))
def test_parts_of_routes_go_where_they_are_put_and_back(seed):
    problem, random = compiled(seed, objective="makespan"), Random(seed)
    team = random_team(problem, random)
    team.commit()
    routes, usages = team.routes, team.usages
    expected = [list(route) for route in routes]
    for _ in range(4):
        i, to = random.choice([k for k, route in enumerate(expected) if route] or [0]), random.randrange(len(expected))
        if not expected[i]:
            return
        low = random.randrange(len(expected[i]))
        high = random.randrange(low, len(expected[i]))
        part = expected[i][low : high + 1]
        if problem.core.is_symmetric and random.random() < 0.5:
            team.reverse(part[0], part[-1])
            expected[i][low : high + 1] = part[::-1]
        else:
            at = random.choice([k for k in range(len(expected[to]) + 1) if to != i or not low < k <= high])
            team.move(part[0], part[-1], to, at)
            del expected[i][low : high + 1]
            at -= len(part) if to == i and at > high else 0
            expected[to][at:at] = part
        assert team.routes == expected
        assert team.usages == pytest.approx(core.Team(problem.core, expected).usages)
    team.rollback()
    assert (team.routes, team.usages) == (routes, usages)
