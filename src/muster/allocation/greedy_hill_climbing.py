"""GrdHCTA: greedy, then hill-climbing task allocation.

TCF thesis, section 3.2.2, Algorithm 6: hill climbing from the greedy plan.
"""

from __future__ import annotations

from muster.allocation.allocator import admissible_routes, finished_plan
from muster.allocation.greedy import allocate
from muster.allocation.hill_climbing import Parameters, climb
from muster.allocation.problem import Problem
from muster.allocation.stop import Stop
from muster.mission.plan import Plan


class GreedyHillClimbing:
    """Greedy task allocation makes a good plan at once; hill climbing goes on from it."""

    name = "greedy+hill-climbing"
    summary = "greedy, then mutations of its plan; GrdHCTA of the TCF thesis"
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
        routes = climb(problem, stop, seed, first)
        return finished_plan(problem, stop, routes, allocator=self.name, seed=seed)
