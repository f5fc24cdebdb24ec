"""What binds tasks to times, teams and relations, as arrays for the core; nothing where no task or robot has any.

One function a rule. What is ignored is left out.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from muster.mission.model import Robot, Task, TeamPart

if TYPE_CHECKING:
    from muster.allocation.problem import Problem

_NEVER = math.inf


def time_arrays(problem: Problem) -> dict[str, Any]:
    """Keyword arguments of `core.Problem`."""
    arrays: dict[str, Any] = {}
    for rule in (_windows, _deadlines, _due, _shifts, _lags, _units, _parts, _needs, _relations):
        arrays.update(rule(problem))
    if problem.mission.rules.makespan_includes_return:
        arrays["makespan_includes_return"] = True
    return arrays


def _windows(problem: Problem) -> dict[str, Any]:
    if not problem.holds("window") or not any(task.window_s for task in problem.tasks):
        return {}
    rows = [sorted((low, _NEVER if high is None else high) for low, high in task.window_s) for task in problem.tasks]
    return {"windows": rows}


def _deadlines(problem: Problem) -> dict[str, Any]:
    if not problem.holds("deadline"):
        return {}
    return _times("deadline", (task.deadline_s for task in problem.tasks))


def _due(problem: Problem) -> dict[str, Any]:
    return _times("due", (task.due_s for task in problem.tasks))


def _shifts(problem: Problem) -> dict[str, Any]:
    if not problem.holds("shift"):
        return {}
    return _times("available_until", (robot.available_until_s for robot in problem.robots))


def _times(name: str, times: Iterable[float | None]) -> dict[str, Any]:
    known = [_NEVER if time is None else time for time in times]
    return {name: known} if any(time < _NEVER for time in known) else {}


def _lags(problem: Problem) -> dict[str, Any]:
    if not problem.holds("prerequisite") or not any(task.lags for task in problem.tasks):
        return {}
    lags = [
        task.lag(problem.tasks[k].id) for task, row in zip(problem.tasks, problem.prerequisites, strict=True) for k in row
    ]
    within = [_NEVER if lag.within_s is None else lag.within_s for lag in lags]
    return {"after": [lag.after_s for lag in lags], "within": within}


def _units(problem: Problem) -> dict[str, Any]:
    """Tasks that start together share a number."""
    if not problem.holds("relation") or not any(task.starts_with for task in problem.tasks):
        return {}
    first = list(range(len(problem.tasks)))

    def root(j: int) -> int:
        while first[j] != j:
            j = first[j]
        return j

    for j, k in _pairs(problem, lambda task: task.starts_with):
        first[max(root(j), root(k))] = min(root(j), root(k))
    number: dict[int, int] = {}
    return {"unit": [number.setdefault(root(j), len(number)) for j in range(len(problem.tasks))]}


def _parts(problem: Problem) -> dict[str, Any]:
    if not problem.holds("team") or not any(task.team or (task.robots_needed or 1) > 1 for task in problem.tasks):
        return {}
    of_kind = _one_of_each_kind(problem)
    return {"parts": [_rows(task, of_kind) for task in problem.tasks]}


def _rows(task: Task, of_kind: Sequence[Robot]) -> list[tuple[int, list[bool]]]:
    if task.team:
        return [(part.count, [_takes(part, robot) for robot in of_kind]) for part in task.team]
    if (task.robots_needed or 1) > 1:
        return [(task.robots_needed or 1, [True] * len(of_kind))]
    return []


def _takes(part: TeamPart, robot: Robot) -> bool:
    """Whether a robot can fill a part, its task aside."""
    if part.type is not None and part.type != robot.type or part.kind is not None and part.kind != robot.kind:
        return False
    return set(part.requires) <= set(robot.skills)


def _one_of_each_kind(problem: Problem) -> list[Robot]:
    robots: dict[int, Robot] = {}
    for robot, kind in zip(problem.robots, problem.kinds, strict=True):
        robots.setdefault(int(kind), robot)
    return [robots[kind] for kind in range(len(robots))]


def _needs(problem: Problem) -> dict[str, Any]:
    if not problem.holds("team"):
        return {}
    names = sorted({name for task in problem.tasks for name in task.needs or {}})
    if not names:
        return {}
    needs = [[(task.needs or {}).get(name, 0.0) for name in names] for task in problem.tasks]
    abilities = [[(robot.abilities or {}).get(name, 0.0) for name in names] for robot in problem.robots]
    return {"abilities": np.array(abilities, dtype=np.float64), "needs": np.array(needs, dtype=np.float64)}


def _relations(problem: Problem) -> dict[str, Any]:
    if not problem.holds("relation"):
        return {}
    same = _symmetric(problem, lambda task: task.same_robot_as)
    other = _symmetric(problem, lambda task: task.other_robot_than)
    return {name: rows for name, rows in (("same_robot", same), ("other_robot", other)) if any(rows)}


def _symmetric(problem: Problem, named: Callable[[Task], Sequence[str]]) -> list[list[int]]:
    rows: list[set[int]] = [set() for _ in problem.tasks]
    for j, k in _pairs(problem, named):
        rows[j].add(k)
        rows[k].add(j)
    return [sorted(row) for row in rows]


def _pairs(problem: Problem, named: Callable[[Task], Sequence[str]]) -> list[tuple[int, int]]:
    """Tasks and those that they name; of a part of a mission those within it."""
    index = problem.task_index
    return [(j, index[name]) for j, task in enumerate(problem.tasks) for name in named(task) if name in index]
