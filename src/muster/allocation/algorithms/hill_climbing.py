"""HCTA: hill-climbing task allocation.

[tcf-thesis], section 3.2.2, Algorithm 2, with the mutation of Algorithm 4.
"""

from __future__ import annotations

from dataclasses import dataclass

from muster.allocation.algorithms.bounds_of_mutation import RECEIVER, checked_bounds
from muster.allocation.algorithms.genetic import Best, population_of
from muster.allocation.allocator import Allocator, Outcome, Routes
from muster.allocation.capabilities import ALL
from muster.allocation.stop import Stop
from muster.model.problem import Problem


@dataclass(frozen=True, kw_only=True)
class Parameters:
    """Parameters of hill climbing.

    Raises
    ------
    ParameterError
        if one is out of range.
    """

    bounds: str = RECEIVER

    def __post_init__(self) -> None:
        checked_bounds(self.bounds)


def climb(problem: Problem, stop: Stop, seed: int, params: Parameters, start: Routes | None) -> Outcome:
    """Algorithm 2: a population of one, where every iteration is one mutation; from a random plan or from `start`."""
    climber = population_of(problem, 1, seed, params.bounds)
    if start is None:
        climber.set_random(0)  # 1
    else:
        climber.set(0, start)
    best = Best(stop)
    best.note(climber)
    for _ in stop.iterations():
        climber.mutate(1.0)  # 2 and 3
        best.note(climber)
    return Outcome(best.routes)


HILL_CLIMBING = Allocator(
    name="hill-climbing",
    summary="mutations of one random plan; HCTA of the TCF thesis",
    anytime=True,
    parameters=Parameters,
    algorithm=climb,
    can=ALL,
)
