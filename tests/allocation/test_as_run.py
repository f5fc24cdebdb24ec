"""The random algorithms as the published runs had them, against Table A.15 of [tcf-thesis]."""

import numpy as np
import pytest

import muster
from muster import core
from muster.allocation.algorithms.bounds_of_mutation import BOUNDS
from muster.library import published
from muster.mission.errors import ParameterError
from muster.model.problem import Problem

A_15 = published("tcf-salesmen")["tables"]["A.15"]["total+max"]
SALESMEN = muster.load("eil51-5-thesis")


def runs(allocator: str, seeds: int, iterations: int) -> np.ndarray:
    """The objectives of some runs."""
    plans = [muster.solve(SALESMEN, allocator=allocator, seed=seed, iterations=iterations) for seed in range(seeds)]
    return np.array([plan.objective_value for plan in plans])


def p_values(allocator: str, values: np.ndarray) -> tuple[float, float]:
    """Of the tests of Mann and Whitney, and of Kolmogorov and Smirnov, against the published runs."""
    stats = pytest.importorskip("scipy.stats")
    return stats.mannwhitneyu(values, A_15[allocator]).pvalue, stats.ks_2samp(values, A_15[allocator]).pvalue


@pytest.mark.long
def test_from_the_greedy_plan_hill_climbing_ends_at_the_published_values():
    found = set(np.round(runs("greedy+hill-climbing-as-run", 16, 30_000), 2))
    assert len(found & set(A_15["greedy+hill-climbing"])) >= 3
    assert not set(np.round(runs("greedy+hill-climbing", 4, 30_000), 2)) & set(A_15["greedy+hill-climbing"])


@pytest.mark.long
def test_climbing_from_random_plans_is_trapped_as_published():
    values = runs("hill-climbing-as-run", 20, 30_000)
    assert min(p_values("hill-climbing", values)) > 0.05
    assert max(p_values("hill-climbing", runs("hill-climbing", 20, 30_000))) < 0.05


@pytest.mark.parametrize("bounds", BOUNDS)
def test_every_reading_of_the_bounds_keeps_the_rules(bounds):
    mission = muster.load("31T-6R50")
    for allocator in ("genetic", "hill-climbing"):
        plan = muster.solve(mission, allocator=allocator, seed=3, iterations=300, bounds=bounds)
        assert muster.verify(mission, plan).valid


def test_inner_bounds_never_displace_the_first_task_of_a_sequence():
    problem = Problem.compile(SALESMEN, "total+max", ()).ready()
    population = core.Population(problem.core, 1, 1, "receiver-inner")
    population.set_random(0)
    before = population.routes(0)
    for _ in range(2000):
        population.mutate(1.0)
    after = population.routes(0)
    assert after != before
    assert [route[0] for route in after] == [route[0] for route in before]


def test_an_empty_sequence_traps_every_task_that_has_dependants():
    problem = Problem.compile(SALESMEN, "total+max", ()).ready()
    towns = [problem.task_index[task.id] for task in problem.tasks if not task.prerequisites]
    returns = [problem.task_index[f"return_{i}"] for i in range(5)]
    routes = [[*towns[i::4], returns[i]] for i in range(4)] + [[returns[4]]]
    for bounds, moves in (("others", True), ("others-inner", False), ("receiver", True)):
        population = core.Population(problem.core, 1, 1, bounds)
        population.set(0, routes)
        for _ in range(500):
            population.mutate(1.0)
        assert (population.routes(0) != routes) is moves


def test_bounds_that_nobody_knows_are_an_error():
    with pytest.raises(ParameterError, match="did you mean 'others'"):
        muster.solve(SALESMEN, allocator="genetic", iterations=1, bounds="other")
