"""Checks the routes that a plugin's algorithm returned."""

from __future__ import annotations

from collections.abc import Sequence

from muster.mission.errors import ParameterError
from muster.model.problem import Problem

Routes = list[list[int]]


def checked_routes(problem: Problem, returned: object, called: str) -> Routes:
    """What a function returned, if it is a route for each robot and no task stands in two places, but for a team's.

    Raises
    ------
    ParameterError
        if it is something else.
    """
    robots, tasks = len(problem.robots), len(problem.tasks)
    if not isinstance(returned, Sequence) or len(returned) != robots:
        found = f"{len(returned)} routes" if isinstance(returned, Sequence) else type(returned).__name__
        raise ParameterError(f"allocator {called}: returned {found}; expected {robots} routes, one for each robot")
    seen: set[int] = set()
    routes: Routes = []
    for route in returned:
        routes.append(_checked_route(route, tasks, called))
        for at, task in enumerate(routes[-1]):
            if task in seen and (not problem.model.is_for_team(task) or task in routes[-1][:at]):
                name = problem.tasks[task].id
                raise ParameterError(f"allocator {called}: returned task {name} twice; expected each at most once")
            seen.add(task)
    return routes


def _checked_route(route: object, tasks: int, called: str) -> list[int]:
    try:
        indices = [task.__index__() for task in route]  # type: ignore[attr-defined]
    except (TypeError, AttributeError):
        message = f"allocator {called}: returned a route that is no list of indices of tasks"
        raise ParameterError(f"{message}; expected indices into problem.tasks") from None
    for task in indices:
        if not 0 <= task < tasks:
            raise ParameterError(f"allocator {called}: returned index {task}; expected indices from 0 to {tasks - 1}")
    return indices
