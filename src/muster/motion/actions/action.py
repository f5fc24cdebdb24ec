"""The interface of an action: way points from a task's entry to its exit, and their cost.

Heights count in a 3-D mission alone. In a mission in the plane the way points of every action lie in the plane, and an
action's height tells no more than how far away an observer stands.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise
from typing import Any, Protocol

from muster.mission.action_keys import ActionKeys
from muster.mission.model import Point, Robot, Task
from muster.motion.port import Waypoint

Leg = tuple[Point, Point]


@dataclass(frozen=True)
class TaskMotion:
    """How a robot does a task.

    Parameters
    ----------
    waypoints
        at least one, from the entry to the exit.
    dimensions
        2 or 3: how many coordinates the mission's positions have.
    typed_cost
        what the mission says that the task costs; None where the way points tell.
    is_travel
        whether the robot travels between its way points as between tasks, along lanes where it keeps to them.
    """

    waypoints: tuple[Waypoint, ...]
    dimensions: int
    typed_cost: float | None = None
    is_travel: bool = False

    @property
    def points(self) -> tuple[Point, ...]:
        """The places of the way points, with the mission's number of coordinates."""
        return tuple(waypoint.position[: self.dimensions] for waypoint in self.waypoints)

    @property
    def entry(self) -> Point:
        return self.points[0]

    @property
    def exit(self) -> Point:
        return self.points[-1]

    @property
    def legs(self) -> tuple[Leg, ...]:
        """The legs that are paid for: none where the cost is typed."""
        return () if self.typed_cost is not None else tuple(pairwise(self.points))

    @property
    def cost_m(self) -> float:
        """What it costs, metres: the typed cost, else the straight length of the way points.

        Over a map a leg is as long as the shortest path, which `robot_paths.RobotPaths` knows and this does not.
        """
        if self.typed_cost is not None:
            return self.typed_cost
        return _length(self.points)

    @property
    def hold_s(self) -> float:
        """Seconds for which the robot stays, in all."""
        return sum(waypoint.hold_s for waypoint in self.waypoints)

    def done(self, passed: int) -> bool:
        """Whether the task is done, so many of its way points passed, holds included (`Telemetry.passed`)."""
        return passed >= len(self.waypoints)


@dataclass(frozen=True)
class Impossible:
    """Why a robot cannot do an action, whatever the plan."""

    reason: str


class TaskAction(Protocol):
    """One kind of action.

    Where the way points are, and whether there are any, may depend of the robot on its `kind`, `radius_m`, `kinematics`
    and `camera` alone: robots that agree in these are planned for together.
    """

    @property
    def name(self) -> str:
        """What a mission calls it."""
        ...

    @property
    def keys(self) -> ActionKeys:
        """What a mission says of it."""
        ...

    def plan(self, task: Task, robot: Robot) -> TaskMotion | Impossible:
        """How the robot does the task, whose action this is."""
        ...


def along(
    task: Task, robot: Robot, points: Sequence[Point], headings: Sequence[float | None] | None = None
) -> TaskMotion:
    """Pass points in order, and wait in the last for what is left of the task's duration.

    Points have the mission's number of coordinates, or a height besides, which is dropped in the plane. `headings` are
    those at the points, radians; None: as it arrives. An entry and an exit that the mission gives are passed before and
    after. What is left is reckoned by straight legs; where a map makes them longer, less is left.
    """
    dimensions = len(task.position)
    own = [point[:dimensions] for point in points]
    before = [task.entry] if task.entry is not None and task.entry != own[0] else []
    after = [task.exit] if task.exit is not None and task.exit != own[-1] else []
    rest = _rest_s(task, robot, _length([*before, *own, *after]))
    turns = headings or [None] * len(own)
    on_the_way = [Waypoint(_place(point), turn) for point, turn in zip(own[:-1], turns[:-1], strict=True)]
    last = Waypoint(_place(own[-1]), turns[-1], rest)
    return TaskMotion((*_passed(before), *on_the_way, last, *_passed(after)), dimensions)


def staying(task: Task, robot: Robot) -> TaskMotion:
    """Arrive and leave where the mission says, and stay for as long as it takes, for what the mission types in.

    The robot stays at the task's position where it arrives or leaves there, else at the entry.
    """
    entry, out = task.entry or task.position, task.exit or task.position
    points = [entry] if entry == out else [entry, out]
    rest = _rest_s(task, robot, _length(points))
    stays = len(points) - 1 if task.exit is None else 0
    waypoints = [Waypoint(_place(point), hold_s=rest if k == stays else 0.0) for k, point in enumerate(points)]
    return TaskMotion(tuple(waypoints), len(task.position), typed_cost=task.actuation_cost, is_travel=True)


def given(task: Task, *keys: str) -> tuple[Any, ...]:
    """The values that a mission gives for keys of the task's action, fields or an action's own."""
    assert task.action is not None
    return tuple(task.action.value(key) for key in keys)


def raised(point: Point, height_m: float) -> Point:
    """(3) metres: a point so much higher; a point in the plane is on the ground."""
    x, y, z = _place(point)
    return x, y, z + height_m


def duration_of(task: Task) -> float | None:
    """Seconds that the task takes a robot of efficiency 1, where they are given."""
    own = None if task.action is None else task.action.duration_s
    return task.duration_s if own is None else own


def _rest_s(task: Task, robot: Robot, metres: float) -> float:
    """What is left of the time that the task takes (docs/design.md, Meaning), so many metres travelled; at least 0."""
    duration = duration_of(task)
    whole = task.actuation_cost / robot.speed_mps if duration is None else duration / robot.efficiency
    return max(0.0, whole - metres / robot.speed_mps)


def _length(points: Sequence[Point]) -> float:
    return sum(math.dist(start, end) for start, end in pairwise(points))


def _passed(points: Sequence[Point]) -> list[Waypoint]:
    return [Waypoint(_place(point)) for point in points]


def _place(point: Point) -> tuple[float, float, float]:
    x, y, z = (*point, 0.0)[:3]
    return x, y, z
