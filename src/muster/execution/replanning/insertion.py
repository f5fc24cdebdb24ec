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
from muster.execution.replanning.worthwhile import worthwhile
from muster.mission.system.garbage import collector_paused
from muster.model.problem import Problem


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

    @collector_paused()
    def merged(self, rest: RemainingMission, found: Mapping[str, Sequence[str]]) -> Revision | None:
        """Routes that a search found some time ago, made to fit what is now; None if they are not worth it.

        Robots without such a route keep theirs. Tasks that have begun or are gone meanwhile drop out, tasks that came
        are put in. No more tasks go to another robot than `rules.stability` allows, none for less than a gain, and
        none whose robot is nearly there (see `worthwhile`).
        """
        if not rest.crew:
            return None
        what = remaining_problem(rest, self.travel)
        problem = what.problem.ready()
        now = admissible_part(problem, routes_before(problem, rest))
        then = _filled(problem, routes_before(problem, replace(rest, routes=_still_to_do(rest, found))))
        best = worthwhile(problem, now, then, rest.headings, most=rest.mission.rules.stability)
        return None if best == now else revision_of(rest, what, best, ())


def _filled(problem: Problem, routes: Routes) -> Routes:
    """The admissible part of routes, with all tasks that fit."""
    return inserted(problem, admissible_part(problem, routes))


def _still_to_do(rest: RemainingMission, found: Mapping[str, Sequence[str]]) -> dict[str, list[str]]:
    """Of routes found for some of a crew that may have changed what is left of them, and those of the others."""
    there = {task.id for task in rest.tasks}
    came = {name for robot, route in found.items() for name in route if name not in rest.routes.get(robot, ())}
    routes = {robot: [name for name in route if name not in came] for robot, route in rest.routes.items()}
    routes |= {robot: list(route) for robot, route in found.items()}
    return {one.robot.id: [name for name in routes[one.robot.id] if name in there] for one in rest.crew}
