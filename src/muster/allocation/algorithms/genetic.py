"""GenTA: genetic task allocation.

[tcf-thesis], section 3.2.2, Algorithm 3, with Algorithms 4 (mutation) and 5 (crossover); defaults of its Table A.1.

Where the text leaves room: the worst share is found by rank, as no tournament's size is given; the loop repeats steps 3
to 6, as step 2 would discard the population; tasks left out count as one more sequence that mutation may take from;
crossover keeps both tasks that change places between their prerequisites and dependants; a random robot that has no
capacity left is followed by the next that has.

Where tasks are bound to times, teams or relations, the members are orders of units with their teams (`UnitPopulation`).
"""

from __future__ import annotations

from dataclasses import dataclass

from muster import core
from muster.allocation.algorithms.bounds_of_mutation import RECEIVER, checked_bounds
from muster.allocation.algorithms.unit_population import UnitPopulation
from muster.allocation.allocator import Allocator, Outcome, Routes
from muster.allocation.capabilities import ALL
from muster.allocation.stop import Stop
from muster.mission.values.ranges import require_counts, require_within
from muster.model.problem import Problem


@dataclass(frozen=True, kw_only=True)
class Parameters:
    """Parameters of the genetic algorithm.

    Raises
    ------
    ParameterError
        if one is out of range.
    """

    population_size: int = 10
    mutation_probability: float = 0.7
    crossover_probability: float = 0.7
    replaced_share: float = 0.4
    start_mutants: int = 4  # of a start plan, beside the plan itself; the thesis leaves their number open
    bounds: str = RECEIVER

    def __post_init__(self) -> None:
        require_counts(1, population_size=self.population_size)
        require_within(0, 1, mutation_probability=self.mutation_probability, replaced_share=self.replaced_share)
        require_within(0, 1, crossover_probability=self.crossover_probability)
        require_counts(0, start_mutants=self.start_mutants)
        checked_bounds(self.bounds)


def allocate(problem: Problem, stop: Stop, seed: int, params: Parameters, start: Routes | None) -> Outcome:
    """Algorithm 3, from a random population; a start plan and mutants of it become members of it (Algorithm 7)."""
    return Outcome(evolve(first_population(problem, seed, params, start), stop, params))


AnyPopulation = core.Population | UnitPopulation


def population_of(problem: Problem, size: int, seed: int, bounds: str) -> AnyPopulation:
    """Plans to be changed; `bounds` are those of Algorithm 4, whose mutation knows no times, teams or relations."""
    if problem.core.is_timed:
        return UnitPopulation(problem, size, seed)
    return core.Population(problem.core, size, seed, bounds)


def first_population(problem: Problem, seed: int, params: Parameters, start: Routes | None) -> AnyPopulation:
    """Random admissible allocations; with a start plan it comes first, then its mutants (Algorithm 7, step 2)."""
    population = population_of(problem, params.population_size, seed, params.bounds)
    for member in range(params.population_size):
        if start is None or member > params.start_mutants:
            population.set_random(member)
        elif member == 0:
            population.set(0, start)
        else:
            population.set_mutant(member, 0)
    return population


def evolve(population: AnyPopulation, stop: Stop, params: Parameters) -> Routes:
    """Algorithm 3; steps carry its numbers. The best plan ever seen is kept apart, as members can be replaced."""
    best = Best(stop)
    best.note(population)
    for _ in stop.iterations():
        population.replace_worst(params.replaced_share)  # 4
        population.mutate(params.mutation_probability)  # 5
        population.cross(params.crossover_probability)  # 6
        best.note(population)  # 8
    return best.routes


class Best:
    """The best member seen so far."""

    def __init__(self, stop: Stop) -> None:
        self._stop = stop
        self._value: tuple[float, float] | None = None
        self.routes: Routes = []

    def note(self, population: AnyPopulation) -> None:
        """Keep the population's best member if it is the best so far."""
        member = population.best()
        value = -population.weight(member), population.objective(member)
        if self._value is None or value < self._value:
            self._value = value
            self.routes = population.routes(member)
            self._stop.improved(-value[0], value[1])


GENETIC = Allocator(
    name="genetic",
    summary="a population from random plans; GenTA of the TCF thesis",
    anytime=True,
    parameters=Parameters,
    algorithm=allocate,
    can=ALL,
)
