"""HCTA: hill-climbing task allocation.

TCF thesis, section 3.2.2, Algorithm 2, with the mutation of Algorithm 4.
"""

from __future__ import annotations

from dataclasses import dataclass

from muster import core
from muster.allocation.allocator import Routes, admissible_routes, finished_plan
from muster.allocation.genetic import Best
from muster.allocation.problem import Problem
from muster.allocation.stop import Stop
from muster.mission.plan import Plan


@dataclass(frozen=True, kw_only=True)
class Parameters:
    """Hill climbing has none."""


class HillClimbing:
    """One task allocation mutates; a mutant that is better is kept."""

    name = "hill-climbing"
    summary = "mutations of one random plan; HCTA of the TCF thesis"
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
        """The best plan found until `stop`, from a random plan or from `start`."""
        routes = climb(problem, stop, seed, admissible_routes(problem, start) if start else None)
        return finished_plan(problem, stop, routes, allocator=self.name, seed=seed)


def climb(problem: Problem, stop: Stop, seed: int, start: Routes | None) -> Routes:
    """Algorithm 2: a population of one, where every iteration is one mutation."""
    climber = core.Population(problem.core, 1, seed)
    if start is None:
        climber.set_random(0)  # 1
    else:
        climber.set(0, start)
    best = Best(stop)
    best.note(climber)
    for _ in stop.iterations():
        climber.mutate(1.0)  # 2 and 3
        best.note(climber)
    return best.routes
