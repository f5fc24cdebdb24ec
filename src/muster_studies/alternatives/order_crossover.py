"""Genetic algorithm with order crossover.

[tcf-thesis], section 2.3, steps 1 to 5, after [tang2000]: strings of tasks and robots, roulette-wheel selection, order
crossover at one point, and mutations that reverse a substring or swap two symbols.

Where the text leaves room: the best string of a generation is kept; the probabilities are the usual ones of
[goldberg1989]; fitness is what an objective is better than the worst of the generation (`strings.fitness`).
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from muster.allocation.allocator import Allocator, Outcome, Routes
from muster.allocation.capabilities import BY_OBJECTIVE
from muster.allocation.stop import Stop
from muster.mission.values.arrays import Floats
from muster.mission.values.ranges import require_counts, require_within
from muster.model.problem import Problem
from muster_studies.alternatives.strings import Decoded, Strings, random_strings, ranking, roulette, string_of


@dataclass(frozen=True, kw_only=True)
class Parameters:
    """Parameters of the genetic algorithm with order crossover.

    Raises
    ------
    ParameterError
        if one is out of range.
    """

    population_size: int = 50
    crossover_probability: float = 0.6
    mutation_probability: float = 0.3  # of a string to be mutated once

    def __post_init__(self) -> None:
        require_counts(2, population_size=self.population_size)
        require_within(0, 1, crossover_probability=self.crossover_probability)
        require_within(0, 1, mutation_probability=self.mutation_probability)


def allocate(problem: Problem, stop: Stop, seed: int, params: Parameters, start: Routes | None) -> Outcome:
    """Steps 1 to 5; a start plan is a member of the first population."""
    random = np.random.default_rng(seed)
    decoded = Decoded(problem, stop, start)
    population = random_strings(problem, params.population_size, random)  # 1
    if start is not None:
        population[0] = string_of(problem, start)
    figures = decoded.figures(population)  # 2
    for _ in stop.iterations():
        population = next_generation(population, figures, params, random)
        figures = decoded.figures(population)  # 5
    return Outcome(decoded.best.routes)


def next_generation(population: Strings, figures: Floats, params: Parameters, random: np.random.Generator) -> Strings:
    """Steps 3 and 4 with parents drawn by the wheel; the best string stays."""
    parents = population[roulette(figures, len(population), random)]
    following = crossed(parents, params.crossover_probability, random)  # 3
    mutate(following, params.mutation_probability, random)  # 4
    following[0] = population[ranking(figures)[0]]
    return following


def crossed(parents: Strings, probability: float, random: np.random.Generator) -> Strings:
    """Pairs of neighbours exchange what is right of a random point; children of the pairs that do not are copies."""
    children = parents.copy()
    for k in range(0, len(parents) - 1, 2):
        if random.random() < probability:
            point = int(random.integers(1, parents.shape[1])) if parents.shape[1] > 1 else 0
            children[k] = order_crossover(parents[k], parents[k + 1], point)
            children[k + 1] = order_crossover(parents[k + 1], parents[k], point)
    return children


def order_crossover(first: Strings, second: Strings, point: int) -> Strings:
    """What is left of the point in the first string, then all other symbols in the order of the second."""
    kept = np.zeros(len(first), dtype=np.bool_)
    kept[first[:point]] = True
    return np.concatenate([first[:point], second[~kept[second]]])


def mutate(population: Strings, probability: float, random: np.random.Generator) -> None:
    """Reverse what is between two points of a string, or swap the symbols there."""
    count, length = population.shape
    for k in np.flatnonzero(random.random(count) < probability):
        a, b = np.sort(random.integers(length, size=2))
        if random.random() < 0.5:
            population[k, a : b + 1] = population[k, a : b + 1][::-1].copy()
        else:
            population[k, [a, b]] = population[k, [b, a]]


ORDER_CROSSOVER = Allocator(
    name="order-crossover",
    summary="a genetic algorithm with roulette wheel and order crossover; reviewed in the TCF thesis",
    anytime=True,
    parameters=Parameters,
    algorithm=allocate,
    can=BY_OBJECTIVE,
)
