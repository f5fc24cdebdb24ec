"""Solutions of vehicle routing (`.sol`), as CVRPLIB and others publish them: `Route #1: 5 3 2` lines and `Cost X`.

A route says nothing of its vehicle: the first one is that of the mission's first robot. Customers have numbers from 1
on: in a mission whose tasks are the nodes 2, 3, ... of an instance file, each is the node's number less 1. All other
tasks, and stations, stand with their ids.
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Mapping, Sequence
from pathlib import Path

from muster.mission.errors import Finding, ParameterError, PlanError
from muster.mission.model import Mission
from muster.mission.plan import Plan, Route
from muster.mission.value_types import shown

_ROUTE = re.compile(r"^\s*Route\s*#?\s*\d+\s*:(.*)$", re.IGNORECASE)


def sol_text(mission: Mission, routes: Iterable[Sequence[str]], cost: float) -> str:
    """The routes, without those that are empty, and the cost.

    Raises
    ------
    ParameterError
        for an id with a space, which would be read as two.
    """
    numbers = _numbers(mission)
    lines: list[str] = []
    for route in filter(None, routes):
        spaced = [name for name in route if len(name.split()) != 1]
        if spaced:
            raise ParameterError(f"--to sol: {shown(spaced[0])}; expected ids without spaces")
        lines.append(f"Route #{len(lines) + 1}: {' '.join(numbers.get(name, name) for name in route)}")
    return "\n".join([*lines, f"Cost {_figure(cost)}"]) + "\n"


def read_sol(path: Path, text: str, mission: Mission) -> Plan | None:
    """Return the plan in the text of a file: its routes alone. The cost is not read: published ones are rounded.

    Returns None where neither the file's name nor a line says that it is such a solution.

    Raises
    ------
    PlanError
        if it has no routes, or more than the mission has robots.
    """
    ids = {number: name for name, number in _numbers(mission).items()}
    found = [(line, match[1].split()) for line, match in enumerate(map(_ROUTE.match, text.splitlines()), 1) if match]
    if not found and path.suffix.lower() != ".sol":
        return None
    if not found:
        raise PlanError([Finding(str(path), None, "Route", "missing", "lines such as Route #1: 5 3 2")])
    busy = [(line, words) for line, words in found if words]
    robots = mission.robots
    if len(busy) > len(robots):
        expected = f"at most {len(robots)}, the robots of the mission; --salesmen M gives an instance file more"
        raise PlanError([Finding(str(path), busy[len(robots)][0], "Route", f"{len(busy)} routes", expected)])
    tasks = [tuple(ids.get(word, word) for word in words) for _, words in busy]
    tasks += [()] * (len(robots) - len(tasks))
    return Plan(routes=tuple(Route(robot.id, row) for robot, row in zip(robots, tasks, strict=True)))


def _numbers(mission: Mission) -> Mapping[str, str]:
    """By task the number of the customer, where that is not the task's id."""
    ids = [task.id for task in mission.tasks]
    are_nodes = ids == [str(k) for k in range(2, len(ids) + 2)]
    return {name: str(int(name) - 1) for name in ids} if are_nodes else {}


def _figure(cost: float) -> str:
    return str(int(cost)) if cost.is_integer() and cost < 1e15 else repr(cost)
