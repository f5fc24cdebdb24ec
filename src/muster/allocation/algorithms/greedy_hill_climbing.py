"""GrdHCTA: greedy, then hill-climbing task allocation.

[tcf-thesis], section 3.2.2, Algorithm 6: hill climbing from the greedy plan.
"""

from __future__ import annotations

from muster.allocation.algorithms import greedy
from muster.allocation.algorithms.hill_climbing import Parameters, climb
from muster.allocation.allocator import Allocator, Outcome, Routes
from muster.allocation.capabilities import ALL
from muster.allocation.stop import Stop
from muster.model.problem import Problem


def allocate(problem: Problem, stop: Stop, seed: int, params: Parameters, start: Routes | None) -> Outcome:
    """Algorithm 6."""
    first = greedy.allocate(problem, stop, seed, greedy.Parameters(), start).routes  # 1
    return climb(problem, stop, seed, params, first)  # 2


GREEDY_HILL_CLIMBING = Allocator(
    name="greedy+hill-climbing",
    summary="greedy, then mutations of its plan; GrdHCTA of the TCF thesis",
    anytime=True,
    parameters=Parameters,
    algorithm=allocate,
    can=ALL,
)
