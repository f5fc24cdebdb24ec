"""How alike the plans of a population become: the risk of a super-individual that [tcf-thesis], section 2.3, names."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass
from functools import partial
from statistics import fmean
from typing import Any

import numpy as np

from muster.allocation.algorithms import genetic
from muster.allocation.allocator import Routes
from muster.allocation.stop import Stop
from muster.model.problem import Problem
from muster_studies.alternatives import ipga, order_crossover
from muster_studies.alternatives.strings import Decoded, Strings, diversity, random_strings
from muster_studies.effort import Effort
from muster_studies.runs import mission_named
from muster_studies.tables import Cell, Table

MISSION, SEEDS, QUICK_SEEDS = "eil51-5-thesis", 5, 1
GENERATIONS = (0, 10, 100, 1000)
ALGORITHMS = ("genetic", "order-crossover", "ipga")


@dataclass(frozen=True)
class Evolution:
    """A population of an algorithm that evolves with a seed."""

    algorithm: str
    seed: int

    def measured(self) -> tuple[float, ...]:
        """Its diversity after each number of GENERATIONS."""
        problem = Problem.compile(mission_named(MISSION)).ready()
        plans = _genetic(problem, self.seed) if self.algorithm == "genetic" else _strings(problem, self)
        wanted = dict.fromkeys(GENERATIONS, 0.0)
        for generation, routes in zip(range(GENERATIONS[-1] + 1), plans, strict=False):
            if generation in wanted:
                wanted[generation] = diversity(np.array([predecessors(problem, one) for one in routes()]))
        return tuple(wanted.values())


def predecessors(problem: Problem, routes: Routes) -> Strings:
    """(n,) where each task is come to from: a task, or n + i for the start of robot i; -1 where it is left out."""
    before = np.full(len(problem.tasks), -1, dtype=np.int32)
    for i, route in enumerate(routes):
        before[route] = [problem.start(i), *route[:-1]][: len(route)]
    return before


def _genetic(problem: Problem, seed: int) -> Iterator[Any]:
    """The plans of GenTA's population, generation by generation, as functions that make their routes."""
    params = genetic.Parameters(population_size=50)
    population = genetic.first_population(problem, seed, params, None)
    while True:
        yield lambda: [population.routes(k) for k in range(len(population))]
        population.replace_worst(params.replaced_share)
        population.mutate(params.mutation_probability)
        population.cross(params.crossover_probability)


def _strings(problem: Problem, of: Evolution) -> Iterator[Any]:
    """The same of algorithms with strings."""
    random, decoded = np.random.default_rng(of.seed), Decoded(problem, Stop())
    population = random_strings(problem, 50, random)
    while True:
        yield partial(decoded.routes, population)
        figures = decoded.figures(population)
        if of.algorithm == "ipga":
            population = ipga.next_generation(population, figures, ipga.Parameters().group_size, random)
        else:
            population = order_crossover.next_generation(population, figures, order_crossover.Parameters(), random)


@dataclass(frozen=True)
class Diversity:
    """The diversity of populations of fifty as generations pass."""

    number: str = "diversity"

    def jobs(self, effort: Effort) -> Iterable[Evolution]:
        return [Evolution(name, seed) for name in ALGORITHMS for seed in range(_seeds(effort))]

    def table(self, effort: Effort, found: Mapping[Any, Any]) -> Table:
        rows: list[tuple[Cell, ...]] = []
        for name in ALGORITHMS:
            by_seed = [found[Evolution(name, seed)] for seed in range(_seeds(effort))]
            rows.append((name, *(100 * fmean(column) for column in zip(*by_seed, strict=True))))
        notes = (
            "Per cent of tasks to which two plans come from different places, the mean over all pairs of plans "
            f"and {_seeds(effort)} seeds; mission {MISSION}. 0: all plans are alike, by one super-individual.",
        )
        columns = ("allocator", *(f"after {count}" for count in GENERATIONS))
        return Table(self.number, "Diversity of a population of 50 [%]", columns, tuple(rows), notes)


def _seeds(effort: Effort) -> int:
    return QUICK_SEEDS if effort.quick else SEEDS
