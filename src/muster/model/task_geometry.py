"""Entries, exits and costs of tasks, once for each class of robots that pass the same points at all tasks.

Only tasks whose action has geometry differ between robots.
"""

from __future__ import annotations

from collections.abc import Callable, Hashable, Mapping, Sequence
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from muster.mission.model import Point, Robot, Task
from muster.mission.values.arrays import Floats
from muster.motion.actions import Impossible, TaskMotion, plan
from muster.motion.actions.action import Leg

Classes = npt.NDArray[np.int32]


@dataclass(frozen=True, eq=False)
class TaskGeometry:
    """The geometry of a problem's tasks, made by `TaskGeometry.of`.

    Parameters
    ----------
    classes
        (m,) of one class are robots that pass the same points at all tasks that they can do.
    firsts
        a robot of each class, which stands for all.
    entries, exits
        (classes, n, 3) metres in the map frame. At a task that a robot cannot do they are those of another, or the
        position.
    costs
        (classes, n) metres, straight.
    moving
        for each class and task with geometry that some robot can do, how it is done.
    """

    classes: Classes
    firsts: tuple[int, ...]
    entries: Floats
    exits: Floats
    costs: Floats
    moving: Mapping[tuple[int, int], TaskMotion]
    _like: tuple[int, ...]  # for each robot the first of the same shape
    _impossible: Mapping[int, Mapping[int, str]]  # for the first robot of each shape the reasons by task

    @classmethod
    def of(
        cls, robots: Sequence[Robot], tasks: Sequence[Task], *, kinds: Sequence[Hashable] | None = None
    ) -> TaskGeometry:
        """The geometry for some robots; those of different `kinds`, one a robot, are in different classes."""
        moving = [j for j, task in enumerate(tasks) if task.action is not None and task.action.has_geometry]
        first_of: dict[object, int] = {}
        own: Sequence[Hashable] = kinds or [None] * len(robots)
        shapes = [(_shape(robot), kind) if moving or kind else None for robot, kind in zip(robots, own, strict=True)]
        like = tuple(first_of.setdefault(shape, i) for i, shape in enumerate(shapes))
        found = {i: {j: plan(tasks[j], robots[i]) for j in moving} for i in first_of.values()}
        done = _completed(found)
        keys = {i: (own[i], tuple(doing.points for doing in done[i].values())) for i in done}
        numbers = {key: k for k, key in enumerate(dict.fromkeys(keys.values()))}
        classes = np.array([numbers[keys[i]] for i in like], dtype=np.int32)
        firsts = tuple(int(np.argmax(classes == k)) for k in range(len(numbers)))
        count = len(firsts)
        entries = np.array([_coordinates([t.entry or t.position for t in tasks])] * count)
        exits = np.array([_coordinates([t.exit or t.position for t in tasks])] * count)
        costs = np.array([[t.actuation_cost for t in tasks]] * count, dtype=np.float64)
        by_class = {(k, j): doing for k, i in enumerate(firsts) for j, doing in done[i].items()}
        for at, doing in by_class.items():
            entries[at], exits[at] = doing.waypoints[0].position, doing.waypoints[-1].position
            costs[at] = doing.cost_m
        return cls(classes, firsts, entries, exits, costs, by_class, like, _reasons(found))

    def legs(self, length: Callable[[int, Leg, TaskMotion], float]) -> tuple[Mapping[int, tuple[float, ...]], ...]:
        """By class: for each task with geometry the lengths of its legs; `length` is of a class, a leg and the work."""
        rows: tuple[dict[int, tuple[float, ...]], ...] = tuple({} for _ in self.firsts)
        for (k, j), doing in self.moving.items():
            rows[k][j] = tuple(length(k, leg, doing) for leg in doing.legs)
        return rows

    def refusal(self, i: int, j: int) -> str | None:
        """Why robot i cannot do task j, whatever the plan; None if it can."""
        return self._impossible[self._like[i]].get(j)

    def refused(self, i: int) -> frozenset[int]:
        """The tasks that robot i cannot do."""
        return frozenset(self._impossible[self._like[i]])


def _completed(found: Mapping[int, Mapping[int, TaskMotion | Impossible]]) -> dict[int, dict[int, TaskMotion]]:
    """How each robot does each task that some robot can do; one that cannot is said to do it as the first that can."""
    able = {i: {j: own for j, own in row.items() if isinstance(own, TaskMotion)} for i, row in found.items()}
    usual: dict[int, TaskMotion] = {}
    for row in able.values():
        usual = row | usual
    order = sorted(usual)
    return {i: {j: row.get(j, usual[j]) for j in order} for i, row in able.items()}


def _reasons(found: Mapping[int, Mapping[int, TaskMotion | Impossible]]) -> dict[int, dict[int, str]]:
    return {i: {j: own.reason for j, own in row.items() if isinstance(own, Impossible)} for i, row in found.items()}


def _shape(robot: Robot) -> tuple[object, ...]:
    """The attributes of a robot on which the way points of an action may depend (see `TaskAction`)."""
    return robot.kind, robot.radius_m, robot.kinematics, robot.camera


def _coordinates(points: Sequence[Point]) -> Floats:
    return np.array([(*p, 0.0)[:3] for p in points], dtype=np.float64).reshape(len(points), 3)
