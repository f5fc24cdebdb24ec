"""GrdTA: greedy task allocation.

[tcf-thesis], section 3.2.1, Algorithm 1. Deterministic; one pass.
"""

from __future__ import annotations

from dataclasses import dataclass

from muster import core
from muster.allocation.algorithms.timed_greedy import append_units
from muster.allocation.allocator import Allocator, Outcome, Routes
from muster.allocation.capabilities import ALL
from muster.allocation.stop import Stop
from muster.model.problem import Problem


@dataclass(frozen=True, kw_only=True)
class Parameters:
    """Greedy task allocation has none."""


def allocate(problem: Problem, stop: Stop, seed: int, params: Parameters, start: Routes | None) -> Outcome:
    """Algorithm 1; with a start plan it goes on from its routes. With the objective `total`: MinCost (3.27)."""
    with stop.first_plan():
        routes = append_units(problem, stop, start) if problem.core.is_timed else _append_tasks(problem, stop, start)
    stop.improved(*problem.value(routes))
    return Outcome(routes)


def _append_tasks(problem: Problem, stop: Stop, start: Routes | None) -> Routes:
    greedy = core.Greedy(problem.core, balanced=problem.objective != "total")
    for robot, route in enumerate(start or ()):
        for task in route:
            greedy.assign(robot, task)
    while (matching := greedy.select()) is not None:  # steps 2 to 5
        if stop.due():
            stop.cut()
            break
        greedy.assign(matching.robot, matching.task)  # steps 6 to 8
    return greedy.routes


def completed(problem: Problem, start: Routes | None = None) -> Routes:
    """Complete routes (by default empty ones) greedily, without a time limit; other algorithms start from them."""
    return allocate(problem, Stop(), 0, Parameters(), start).routes


GREEDY = Allocator(
    name="greedy",
    summary="one pass, milliseconds; GrdTA of the TCF thesis",
    anytime=False,
    parameters=Parameters,
    algorithm=allocate,
    keeps_fixed=True,
    can=ALL,
)
