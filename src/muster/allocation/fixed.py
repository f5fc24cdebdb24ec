"""Routes that begin as they are, for planning anew while robots are under way: what they have done, do, or go on to do.

The tasks that stay are a plan by themselves, so that whatever is planned behind them, they can be done.
"""

from __future__ import annotations

from dataclasses import replace

from muster.allocation.allocator import admissible_routes
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
