"""What a problem's robots do at its tasks: entries, exits and costs, once for each class of robots that do alike.

Only actions with geometry are looked at by robot; all other tasks are the same for everyone.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from muster.mission.model import Point, Robot, Task
from muster.motion.actions import Doing, Impossible, plan

Floats = npt.NDArray[np.float64]
Classes = npt.NDArray[np.int32]


@dataclass(frozen=True, eq=False)
class Doings:
    """Made by `Doings.of`.

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
    moving: Mapping[tuple[int, int], Doing]
    _like: tuple[int, ...]  # for each robot the first of the same shape
    _impossible: Mapping[int, Mapping[int, str]]  # for the first robot of each shape the reasons by task

    @classmethod
    def of(cls, robots: Sequence[Robot], tasks: Sequence[Task], *, by_body: bool) -> Doings:
        """With `by_body` robots of different bodies are in different classes."""
        moving = [j for j, task in enumerate(tasks) if task.action is not None and task.action.has_geometry]
        first_of: dict[object, int] = {}
        like = tuple(
            first_of.setdefault(_shape(robot) if moving or by_body else None, i) for i, robot in enumerate(robots)
        )
        impossible: dict[int, dict[int, str]] = {i: {} for i in first_of.values()}
        found: dict[int, dict[int, Doing]] = {i: {} for i in first_of.values()}
        usual: dict[int, Doing] = {}
        for j in moving:
            for i in found:
                own = plan(tasks[j], robots[i])
                if isinstance(own, Impossible):
                    impossible[i][j] = own.reason
                else:
                    found[i][j] = own
                    usual.setdefault(j, own)
        filled = {i: usual | own for i, own in found.items()}
        numbers: dict[object, int] = {}
        keys = {
            i: ((robots[i].radius_m, robots[i].kind) if by_body else None, tuple(d.points for d in own.values()))
            for i, own in filled.items()
        }
        classes = np.array([numbers.setdefault(keys[i], len(numbers)) for i in like], dtype=np.int32)
        firsts = tuple(int(np.argmax(classes == k)) for k in range(len(numbers)))
        entries = np.array([_coordinates([t.entry or t.position for t in tasks])] * len(firsts))
        exits = np.array([_coordinates([t.exit or t.position for t in tasks])] * len(firsts))
        costs = np.array([[t.actuation_cost for t in tasks]] * len(firsts), dtype=np.float64)
        by_class = {(k, j): doing for k, i in enumerate(firsts) for j, doing in filled[i].items()}
        for at, doing in by_class.items():
            entries[at], exits[at] = doing.waypoints[0].position, doing.waypoints[-1].position
            costs[at] = doing.cost_m
        return cls(classes, firsts, entries, exits, costs, by_class, like, impossible)

    def why_impossible(self, i: int, j: int) -> str | None:
        """Why robot i cannot do task j, whatever the plan; None if it can."""
        return self._impossible[self._like[i]].get(j)

    def cannot_do(self, i: int) -> frozenset[int]:
        """The tasks that robot i cannot do."""
        return frozenset(self._impossible[self._like[i]])


def _shape(robot: Robot) -> tuple[object, ...]:
    """What the doings of a robot may depend on (see `TaskAction`)."""
    return robot.kind, robot.radius_m, robot.kinematics, robot.camera


def _coordinates(points: Sequence[Point]) -> Floats:
    return np.array([(*p, 0.0)[:3] for p in points], dtype=np.float64).reshape(len(points), 3)
