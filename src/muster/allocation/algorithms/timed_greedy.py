"""Greedy task allocation where tasks are bound to times, teams and relations.

[tcf-thesis], section 3.2.1, Algorithm 1, with units of work in place of tasks: each step appends the unit whose team
has the least debit. A team's cost c is what its members pay together, and u the greatest usage among them (3.17). With
the objectives `makespan` and `lateness` the debit is what the objective grows by, waiting included. The dependency
coefficient (3.20) is left out, as gaps say when a dependant can follow.
"""

from __future__ import annotations

import math
from collections.abc import Sequence

from muster import core
from muster.allocation.stop import Stop
from muster.allocation.working_roster import Routes, WorkingRoster
from muster.model.problem import Problem
from muster.model.rules import RULES

_IN_TIME = ("makespan", "lateness")


def append_units(problem: Problem, stop: Stop, start: Routes | None) -> Routes:
    """Append one unit after the other to routes, until none can follow or it is time to stop."""
    roster = WorkingRoster(problem, start)
    robots = list(range(len(problem.robots)))
    while True:
        _append_units(problem, roster, robots, stop)
        counts = [len(route) for route in roster.routes]
        roster.finish()
        # Robots that would have had too few tasks have none now; what they left is for the others.
        enough = [i for i in robots if not any(rule.too_few(problem, i, counts[i]) for rule in RULES)]
        if len(enough) == len(robots):
            return roster.routes
        robots = enough


def _append_units(problem: Problem, roster: WorkingRoster, robots: Sequence[int], stop: Stop) -> None:
    refused: set[int] = set()
    while (chosen := _select(problem, roster, robots, refused, stop)) is not None:
        if roster.put(chosen):
            refused.clear()
        else:
            refused.add(chosen.unit)


def _select(
    problem: Problem, roster: WorkingRoster, robots: Sequence[int], refused: set[int], stop: Stop
) -> core.UnitInsertion | None:
    """The matching of the least debit; of equal ones that of the first unit. None if it is time to stop, too."""
    chosen, least = None, math.inf
    for unit in roster.ready():
        if stop.due():
            stop.cut()
            return None
        insertion = None if unit in refused else roster.best(unit, robots)
        if insertion is None or insertion.unit in refused:  # of a transport it is that of the first task
            continue
        if (debit := _debit(problem, roster, insertion)) < least:
            chosen, least = insertion, debit
    return chosen


def _debit(problem: Problem, roster: WorkingRoster, insertion: core.UnitInsertion) -> float:
    if problem.objective in _IN_TIME:
        return insertion.score
    balanced = problem.objective != "total"
    return insertion.growth + (roster.usage(insertion) if balanced else 0.0)
