"""Greedy task allocation where tasks are bound to times, teams and relations.

[tcf-thesis], section 3.2.1, Algorithm 1, with units of work in place of tasks: each step appends the unit whose team
has the least debit. A team's cost c is what its members pay together, and u the greatest usage among them (3.17). With
the objectives `makespan` and `lateness` the debit is what the objective grows by, waiting included. The dependency
coefficient (3.20) is left out, as gaps say when a dependant can follow.
"""

from __future__ import annotations

from collections.abc import Sequence

from muster import core
from muster.allocation.stop import Stop
from muster.allocation.working_roster import Routes, WorkingRoster
from muster.model.problem import Problem
from muster.model.rules import all_rules

MOST_TASKS_OF_A_THOROUGH_RUN = 500
"""Up to so many tasks each step chooses among all units; beyond it, mainly among those near what was placed last."""


def append_units(problem: Problem, stop: Stop, start: Routes | None) -> Routes:
    """Append one unit after the other to routes, until none can follow or it is time to stop."""
    roster = WorkingRoster(problem, start)
    robots = list(range(len(problem.robots)))
    while True:
        _append_units(problem, roster, robots, stop)
        counts = [len(route) for route in roster.routes]
        roster.finish()
        # Robots that would have had too few tasks have none now; what they left is for the others.
        enough = [i for i in robots if not any(rule.too_few(problem, i, counts[i]) for rule in all_rules())]
        if len(enough) == len(robots):
            return roster.routes
        robots = enough


def _append_units(problem: Problem, roster: WorkingRoster, robots: Sequence[int], stop: Stop) -> None:
    greedy = core.UnitGreedy(roster.core, robots, thorough=len(problem.tasks) <= MOST_TASKS_OF_A_THOROUGH_RUN)
    while greedy.append_one():
        if stop.due():
            stop.cut()
            return
