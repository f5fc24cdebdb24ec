"""Routes that begin as they are, for planning anew while robots are under way: what they have done, do, or go on to do.

The tasks that stay are a plan by themselves, so that whatever is planned behind them, they can be done.
"""

from __future__ import annotations

import math
from dataclasses import replace

from muster import core
from muster.allocation.allocator import Routes, admissible_routes
from muster.allocation.feasibility import ROUNDING
from muster.allocation.problem import Problem
from muster.mission.plan import Plan


def keeping(problem: Problem, plan: Plan) -> Problem:
    """The same problem for plans whose routes begin with the routes of this one.

    Raises
    ------
    ParameterError
        if the plan is not admissible, or names robots or tasks that the problem does not have.
    """
    routes = admissible_routes(problem, plan, "fixed")
    return replace(problem, fixed=tuple(tuple(route) for route in routes))


def admissible_part(problem: Problem, routes: Routes) -> Routes:
    """As much of routes, each of which begins with its robot's fixed tasks, as is still admissible.

    Tasks go that their robot may not do, that wait for one that is not there, and from the end of a route that costs
    too much. Of routes that wait for each other in a circle only the fixed tasks are left.
    """
    least = [len(problem.beginning(i)) for i in range(len(problem.robots))]
    part = [[j for k, j in enumerate(route) if k < least[i] or problem.may(i, j)] for i, route in enumerate(routes)]
    while True:
        there = {j for route in part for j in route}
        part = [[j for j in route if there.issuperset(problem.prerequisites[j])] for route in part]
        inspection = core.Inspection(problem.core, part)
        if inspection.admissible:
            return part
        shortened = [
            route[:-1] if _too_much(usage, problem.capacity[i]) and len(route) > least[i] else route
            for i, (route, usage) in enumerate(zip(part, inspection.usages, strict=True))
        ]
        if shortened == part and there == {j for route in part for j in route}:
            return [list(problem.beginning(i)) for i in range(len(problem.robots))]
        part = shortened


def _too_much(usage: float, capacity: float) -> bool:
    return math.isinf(usage) or usage > capacity * (1 + ROUNDING)
