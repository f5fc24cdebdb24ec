"""GrdTA: greedy task allocation.

[tcf-thesis], section 3.2.1, Algorithm 1. Deterministic; one pass.

Where tasks are bound to times, teams and relations, units of work take the place of tasks: each step appends the unit
whose team has the least debit. A team's cost c is what its members pay together, and u the greatest usage among them
(3.17). With the objectives `makespan` and `lateness` the debit is what the objective grows by, waiting included. The
dependency coefficient (3.20) is left out there, as gaps say when a dependant can follow.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from muster import core
from muster.allocation.allocator import Allocator, Outcome, Routes
from muster.allocation.capabilities import ALL
from muster.allocation.stop import Stop
from muster.allocation.working_roster import WorkingRoster
from muster.model.problem import Problem
from muster.model.rules import all_rules

MOST_TASKS_OF_A_THOROUGH_RUN = 500
"""Up to so many tasks each step chooses among all units; beyond it, mainly among those near what was placed last."""


@dataclass(frozen=True, kw_only=True)
class Parameters:
    """Greedy task allocation has none."""


def allocate(problem: Problem, stop: Stop, seed: int, params: Parameters, start: Routes | None) -> Outcome:
    """Algorithm 1; with a start plan it goes on from its routes. With the objective `total`: MinCost (3.27)."""
    with stop.first_plan():
        routes = _append_units(problem, stop, start) if problem.core.is_timed else _append_tasks(problem, stop, start)
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


def _append_units(problem: Problem, stop: Stop, start: Routes | None) -> Routes:
    """Append one unit after the other to routes, until none can follow or it is time to stop."""
    roster = WorkingRoster(problem, start)
    robots = list(range(len(problem.robots)))
    while True:
        _grow(problem, roster, robots, stop)
        counts = [len(route) for route in roster.routes]
        roster.finish()
        # Robots that would have had too few tasks have none now; what they left is for the others.
        enough = [i for i in robots if not any(rule.too_few(problem, i, counts[i]) for rule in all_rules())]
        if len(enough) == len(robots):
            return roster.routes
        robots = enough


def _grow(problem: Problem, roster: WorkingRoster, robots: Sequence[int], stop: Stop) -> None:
    greedy = core.UnitGreedy(roster.core, robots, thorough=len(problem.tasks) <= MOST_TASKS_OF_A_THOROUGH_RUN)
    while greedy.append_one():
        if stop.due():
            stop.cut()
            return


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
