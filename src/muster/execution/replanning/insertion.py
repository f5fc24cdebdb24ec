"""Planning of standing fleets: new tasks go into the routes at once, and better routes are taken over when found.

Both keep what robots have begun, and the order of all other tasks but for what is put between; a search that takes its
time works on a snapshot meanwhile (`standing.Improver`).
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

from muster.allocation.algorithms.insertion import inserted
from muster.allocation.allocator import Routes
from muster.allocation.fixed import admissible_part
from muster.execution.replanning.reallocation import (
    Revision,
    nobody,
    rest_to_plan,
    revision_of,
    routes_before,
    without_units,
)
from muster.execution.replanning.remaining_problem import RemainingMission, remaining_problem
from muster.execution.replanning.travel import Travel
from muster.model.problem import Problem

_BETTER = 1e-6
"""By which share of the objective routes must be better to be taken over."""


@dataclass(frozen=True)
class Insertion:
    """Plans the rest again by putting tasks without a robot into the routes as they are (`allocation.insertion`).

    It takes one pass over the routes for each such task, and moves no other: robots that fail leave theirs to others.

    Parameters
    ----------
    travel
        how travel is measured.
    """

    travel: Travel

    def __call__(self, rest: RemainingMission) -> Revision:
        """The rest planned again."""
        if not rest.crew:
            return nobody(rest)
        what, problem, before, forced = rest_to_plan(rest, self.travel)
        routes = _filled(problem, without_units(problem, before, forced))
        return revision_of(rest, what, routes, forced)

    def merged(self, rest: RemainingMission, found: Mapping[str, Sequence[str]]) -> Revision | None:
        """Routes that a search found some time ago, made to fit what is now; None if they are no better.

        Tasks that have begun or are gone meanwhile drop out, tasks that came are put in. As few tasks go to another
        robot as `rules.stability` allows.
        """
        if not rest.crew:
            return None
        what = remaining_problem(rest, self.travel)
        problem = what.problem.ready()
        now = admissible_part(problem, routes_before(problem, rest))
        then = _filled(problem, routes_before(problem, replace(rest, routes=_still_to_do(rest, found))))
        if not _is_better(problem, then, now):
            return None
        revision, most = revision_of(rest, what, then, ()), rest.mission.rules.stability
        return revision if most is None or len(revision.moved) <= most else None


def _filled(problem: Problem, routes: Routes) -> Routes:
    """The admissible part of routes, with all tasks that fit."""
    return inserted(problem, admissible_part(problem, routes))


def _still_to_do(rest: RemainingMission, found: Mapping[str, Sequence[str]]) -> dict[str, list[str]]:
    """Of routes for a crew that may have changed what is left of them."""
    there = {task.id for task in rest.tasks}
    return {s.robot.id: [name for name in found.get(s.robot.id, ()) if name in there] for s in rest.crew}


def _is_better(problem: Problem, then: Routes, now: Routes) -> bool:
    """Whether routes complete more, or as much for a better objective."""
    (weight, objective), (weight_now, objective_now) = problem.value(then), problem.value(now)
    if weight != weight_now:
        return weight > weight_now
    return objective < objective_now - _BETTER * abs(objective_now)
