"""GrdGenTA: greedy, then genetic task allocation.

[tcf-thesis], section 3.2.2, Algorithm 7: the greedy plan and mutants of it are members of the first population.
"""

from __future__ import annotations

from muster.allocation.algorithms import genetic, greedy
from muster.allocation.algorithms.genetic import Parameters
from muster.allocation.allocator import Allocator, Outcome, Routes
from muster.allocation.capabilities import ALL
from muster.allocation.stop import Stop
from muster.model.problem import Problem


def allocate(problem: Problem, stop: Stop, seed: int, params: Parameters, start: Routes | None) -> Outcome:
    """Algorithm 7."""
    first = greedy.allocate(problem, stop, seed, greedy.Parameters(), start).routes  # 1
    return genetic.allocate(problem, stop, seed, params, first)  # 2 and 3


GREEDY_GENETIC = Allocator(
    name="greedy+genetic",
    summary="greedy, then a population around it; GrdGenTA of the TCF thesis",
    anytime=True,
    parameters=Parameters,
    algorithm=allocate,
    can=ALL,
)
