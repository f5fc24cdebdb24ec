"""IPGA: improved partheno-genetic algorithm, mutations without crossover.

[zhou2018], as [tcf-thesis], section 2.3, reviews it: selection and mutation are one step, without a mutation
probability. The population is divided at random into groups; the best of a group stays, and the rest of the group is a
temporary population of its mutants. A mutation takes a random segment of the string and puts it back elsewhere: as it
was or reversed (flip), with its ends swapped, or slid round by one to the left or right. As markers of robots are
symbols like tasks, it moves the ends of subtours, too.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from muster.allocation.allocator import Allocator, Outcome, Routes
from muster.allocation.capabilities import BY_OBJECTIVE
from muster.allocation.stop import Stop
from muster.mission.errors import ParameterError
from muster.mission.values.arrays import Floats
from muster.mission.values.ranges import require_counts
from muster.model.problem import Problem
from muster_studies.alternatives.strings import Decoded, Strings, random_strings, ranking, string_of


@dataclass(frozen=True, kw_only=True)
class Parameters:
    """Parameters of the improved partheno-genetic algorithm.

    Raises
    ------
    ParameterError
        if one is out of range.
    """

    population_size: int = 50
    group_size: int = 10

    def __post_init__(self) -> None:
        require_counts(2, group_size=self.group_size)
        if self.population_size < self.group_size or self.population_size % self.group_size:
            raise ParameterError(
                f"population_size: {self.population_size}; expected a multiple of group_size, {self.group_size}"
            )


def allocate(problem: Problem, stop: Stop, seed: int, params: Parameters, start: Routes | None) -> Outcome:
    """Generation after generation; a start plan is a member of the first."""
    random = np.random.default_rng(seed)
    decoded = Decoded(problem, stop, start)
    population = random_strings(problem, params.population_size, random)
    if start is not None:
        population[0] = string_of(problem, start)
    figures = decoded.figures(population)
    for _ in stop.iterations():
        population = next_generation(population, figures, params.group_size, random)
        figures = decoded.figures(population)
    return Outcome(decoded.best.routes)


def next_generation(population: Strings, figures: Floats, group_size: int, random: np.random.Generator) -> Strings:
    """The best of each random group, and its mutants in place of the others."""
    places = np.empty(len(population), dtype=np.int64)
    places[ranking(figures)] = np.arange(len(population))
    groups = random.permutation(len(population)).reshape(-1, group_size)
    best = groups[np.arange(len(groups)), np.argmin(places[groups], axis=1)]
    following = np.repeat(population[best], group_size, axis=0)
    for k in range(len(following)):
        if k % group_size:
            following[k] = mutant(following[k], random)
    return following


def mutant(string: Strings, random: np.random.Generator) -> Strings:
    """The string with one segment changed and put back at a random place."""
    length = len(string)
    a, b = np.sort(random.integers(length, size=2))
    segment, rest = string[a : b + 1], np.concatenate([string[:a], string[b + 1 :]])
    at = int(random.integers(len(rest) + 1))
    changed = _CHANGES[int(random.integers(len(_CHANGES)))](segment)
    return np.concatenate([rest[:at], changed, rest[at:]])


def _swapped(segment: Strings) -> Strings:
    changed = segment.copy()
    changed[[0, -1]] = segment[[-1, 0]]
    return changed


_CHANGES = (
    lambda segment: segment,
    lambda segment: segment[::-1],
    _swapped,
    lambda segment: np.roll(segment, -1),
    lambda segment: np.roll(segment, 1),
)

IPGA = Allocator(
    name="ipga",
    summary="mutants of the best of groups, no crossover; reviewed in the TCF thesis",
    anytime=True,
    parameters=Parameters,
    algorithm=allocate,
    can=BY_OBJECTIVE,
)
