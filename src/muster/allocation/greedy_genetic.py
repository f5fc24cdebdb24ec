"""GrdGenTA: greedy, then genetic task allocation.

TCF thesis, section 3.2.2, Algorithm 7: the greedy plan and mutants of it are members of the first population.
"""

from __future__ import annotations

from muster.allocation.allocator import admissible_routes, finished_plan
from muster.allocation.genetic import Parameters, evolve, first_population
from muster.allocation.greedy import allocate
from muster.allocation.problem import Problem
from muster.allocation.stop import Stop
from muster.mission.plan import Plan


class GreedyGenetic:
    """Greedy task allocation makes a good plan at once; the genetic algorithm goes on from it."""

    name = "greedy+genetic"
    summary = "greedy, then a population around it; GrdGenTA of the TCF thesis"
    anytime = True
    parameters = Parameters

    def solve(
        self,
        problem: Problem,
        stop: Stop,
        *,
        seed: int = 0,
        params: Parameters | None = None,
        start: Plan | None = None,
    ) -> Plan:
        """The best plan found until `stop`; with `start`, greedy goes on from its routes."""
        first = allocate(problem, stop, admissible_routes(problem, start) if start else None)
        params = params or Parameters()
        best = evolve(first_population(problem, seed, params, first), stop, params)
        return finished_plan(problem, stop, best, allocator=self.name, seed=seed)
