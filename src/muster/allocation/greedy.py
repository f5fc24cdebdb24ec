"""GrdTA: greedy task allocation.

TCF thesis, section 3.2.1, Algorithm 1. Deterministic; one pass.
"""

from __future__ import annotations

from dataclasses import dataclass

from muster import core
from muster.allocation.allocator import Routes, admissible_routes, finished_plan
from muster.allocation.problem import Problem
from muster.allocation.stop import Stop
from muster.mission.plan import Plan


@dataclass(frozen=True, kw_only=True)
class Parameters:
    """Greedy task allocation has none."""


class Greedy:
    """Each robot prefers the task of least debit (3.19); the matching of least c_ij + u_i (3.17) is made; again."""

    name = "greedy"
    summary = "one pass, milliseconds; GrdTA of the TCF thesis"
    anytime = False
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
        """A plan that goes on from the routes of `start`, if given, until no admissible matching is left."""
        routes = allocate(problem, stop, admissible_routes(problem, start) if start else None)
        inspection = core.Inspection(problem.core, routes)
        stop.improved(sum(problem.tasks[j].priority for route in routes for j in route), inspection.objective)
        return finished_plan(problem, stop, routes, allocator=self.name, seed=seed)


def allocate(problem: Problem, stop: Stop, start: Routes | None = None) -> Routes:
    """Algorithm 1. With the objective `total` it is the MinCost variant (3.27)."""
    greedy = core.Greedy(problem.core, balanced=problem.objective != "total")
    for robot, route in enumerate(start or ()):
        for task in route:
            greedy.assign(robot, task)
    while not stop.due():
        matching = greedy.select()  # steps 2 to 5
        if matching is None:
            break
        greedy.assign(matching.robot, matching.task)  # steps 6 to 8
    return greedy.routes
