"""Incremental insertion: tasks that came meanwhile are put into routes that stay as they are.

One unit of work after the other goes where the objective grows least, the most urgent first, each at the cost of one
pass over the routes: cheapest insertion ([rosenkrantz1977]) on the schedule of the core.
"""

from __future__ import annotations

from muster.allocation.allocator import Routes
from muster.allocation.working_roster import WorkingRoster
from muster.model.problem import Problem


def inserted(problem: Problem, routes: Routes) -> Routes:
    """Admissible routes, with every task put in that fits: the rest of them keeps its order and its robots.

    Tasks are put in by priority, then by when they have ended at the latest, then in the order of the problem; each
    after its prerequisites.
    """
    roster = WorkingRoster(problem, routes)
    refused: set[int] = set()
    while waiting := [unit for unit in roster.ready() if unit not in refused]:
        for unit in sorted(waiting, key=lambda unit: _urgency(problem, unit)):
            if roster.core.present(unit):
                continue  # it came with the other one of a transport
            place = roster.best(unit, append_only=False)
            if place is None or not roster.put(place):
                refused.add(unit)
    roster.finish()
    return roster.routes


def _urgency(problem: Problem, unit: int) -> tuple[float, float]:
    """What comes first is less: the greatest priority of a unit's tasks, then their earliest latest end."""
    model = problem.model
    tasks = model.units[unit]
    return -max(problem.tasks[j].priority for j in tasks), float(model.ends_by[tasks].min())
