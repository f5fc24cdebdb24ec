"""Strings of tasks and robots, their decoding and their fitness."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from tests.random_missions import random_mission

import muster
from muster import core
from muster.model.problem import Problem
from muster_studies.alternatives import ipga, order_crossover
from muster_studies.alternatives.strings import diversity, fitness, random_strings, ranking, read, roulette, string_of


def test_a_string_is_read_as_a_ring():
    problem = Problem.compile(muster.load("6T-2R"))  # tasks 0 to 5, markers 6 and 7
    tasks, robots = read(problem, np.array([[3, 6, 0, 5, 7, 1, 2, 4]], dtype=np.int32))
    assert tasks.tolist() == [[0, 5, 1, 2, 4, 3]]
    assert robots.tolist() == [[0, 1, 1, 1, 1, 0]]


@given(seed=st.integers(0, 10**6))
def test_every_string_stands_for_an_admissible_plan(seed):
    problem = Problem.compile(random_mission(seed))
    decoder, random = core.Decoder(problem.core), np.random.default_rng(seed)
    tasks, robots = read(problem, random_strings(problem, 3, random))
    for decode in (lambda: decoder.in_order(tasks, robots), lambda: decoder.nearest_next(robots)):
        figures = decode()
        for k in range(3):
            inspection = core.Inspection(problem.core, decoder.routes(k))
            assert inspection.admissible
            assert figures[k, 1] == inspection.objective
            assert figures[k, 2] == pytest.approx(sum(inspection.usages))
            assert figures[k, 3] == max(inspection.usages)


@pytest.mark.long(keep=2)
@pytest.mark.parametrize("name", ["31T-6R50", "24T-5R", "eil51-5", "depot"])
def test_the_string_of_a_complete_plan_decodes_to_the_plan(name):
    problem = Problem.compile(muster.load(name))
    plan = muster.solve(problem.mission, "search", iterations=1000)
    assert plan.complete
    tasks_of = {route.robot: route.tasks for route in plan.routes}
    routes = [[problem.task_index[task] for task in tasks_of[robot.id]] for robot in problem.robots]
    decoder = core.Decoder(problem.core)
    decoder.in_order(*read(problem, string_of(problem, routes)[None]))
    assert decoder.routes(0) == routes


def test_wrong_indices_are_refused():
    problem = Problem.compile(muster.load("6T-2R"))
    decoder = core.Decoder(problem.core)
    order, robots = np.arange(6, dtype=np.int32)[None], np.zeros((1, 6), dtype=np.int32)
    for wrong in ((order * 0, robots), (order + 1, robots), (order, robots + 2), (order, robots[:, :5])):
        with pytest.raises(ValueError, match=r"robot|task"):
            decoder.in_order(*map(np.ascontiguousarray, wrong))


def test_the_wheel_prefers_better_plans():
    figures = np.array([[5.0, 10.0, 0, 0], [5.0, 20.0, 0, 0], [4.0, 1.0, 0, 0]])
    assert ranking(figures).tolist() == [0, 1, 2]
    weights = fitness(figures)
    assert weights[0] == pytest.approx(11 * weights[1])
    assert weights[1] > weights[2] > 0
    drawn = np.bincount(roulette(figures, 10_000, np.random.default_rng(0)), minlength=3) / 10_000
    assert drawn == pytest.approx(weights / weights.sum(), abs=0.02)


def test_diversity_is_the_mean_over_pairs():
    strings = np.random.default_rng(0).integers(3, size=(7, 5)).astype(np.int32)
    pairs = [np.mean(strings[a] != strings[b]) for a in range(7) for b in range(a)]
    assert diversity(strings) == pytest.approx(np.mean(pairs))
    assert diversity(strings[:1]) == 0.0


def test_order_crossover_keeps_the_order_of_both():
    first, second = np.array([0, 1, 2, 3, 4, 5], dtype=np.int32), np.array([5, 3, 1, 0, 2, 4], dtype=np.int32)
    assert order_crossover.order_crossover(first, second, 2).tolist() == [0, 1, 5, 3, 2, 4]


@given(seed=st.integers(0, 10**6), length=st.integers(1, 9))
def test_mutations_are_permutations(seed, length):
    random = np.random.default_rng(seed)
    strings = np.tile(np.arange(length, dtype=np.int32), (4, 1))
    order_crossover.mutate(strings, 1.0, random)
    for string in (*strings, ipga.mutant(strings[0], random)):
        assert sorted(string.tolist()) == list(range(length))
