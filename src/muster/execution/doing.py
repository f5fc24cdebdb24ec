"""What a robot does at a task, as far as carrying out needs it; and what it is for a task without an action.

The time of work: `duration_s / efficiency` where a duration is given, else
`actuation_cost / speed`.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Protocol

from muster.mission.model import Point, Robot, Task
from muster.motion import actions
from muster.motion.actions import Impossible
from muster.motion.port import Place, Waypoint


class Doing(Protocol):
    """What a task makes a robot do.

    Attributes
    ----------
    waypoints
        what it passes from where it enters the task, holds included; passing the last is the end of the work.
    entry, exit
        where it arrives and where it leaves, metres in the map frame.
    cost_m
        usage of the work, by distance: what of it is not travelled is charged while the robot stays.
    """

    @property
    def waypoints(self) -> Sequence[Waypoint]: ...

    @property
    def entry(self) -> Place: ...

    @property
    def exit(self) -> Place: ...

    @property
    def cost_m(self) -> float: ...


@dataclass(frozen=True)
class PlainDoing:
    """The work of a task that names no geometry; see `Doing`."""

    waypoints: tuple[Waypoint, ...]
    entry: Place
    exit: Place
    cost_m: float


Doer = Callable[[Task, Robot], Doing | Impossible]
"""What a task makes a robot do, or why the robot cannot do it."""

Way = Callable[[Robot, Place, Place], Sequence[Place] | None]
"""The places that a robot passes from one place to another, the last included; None where there is no way."""


def plain(task: Task, robot: Robot) -> Doing | Impossible:
    """The work of a plain task: the robot stays at the entry and is at the exit when the time is over.

    Where the way to the exit takes longer than the work, the work ends when the robot is there.
    """
    entry, out = place(task.entry or task.position), place(task.exit or task.position)
    moving = math.dist(entry, out) / robot.speed_mps
    stays = max(0.0, plain_work_s(task, robot) - moving)
    waypoints = [Waypoint(entry, hold_s=stays, label=task.id)]
    if out != entry:
        waypoints.append(Waypoint(out, label=task.id))
    return PlainDoing(tuple(waypoints), entry, out, task.actuation_cost)


def acted(task: Task, robot: Robot) -> Doing | Impossible:
    """The work of any task: that of its action where this has geometry (see `motion.actions`), else the plain one."""
    if task.action is None or not task.action.has_geometry:
        return plain(task, robot)
    found = actions.plan(task, robot)
    if isinstance(found, Impossible):
        return found
    return PlainDoing(found.waypoints, place(found.entry), place(found.exit), found.cost_m)


def plain_work_s(task: Task, robot: Robot) -> float:
    """Seconds that a plain task takes a robot."""
    given = actions.duration_of(task)
    return task.actuation_cost / robot.speed_mps if given is None else given / robot.efficiency


def straight(robot: Robot, start: Place, goal: Place) -> Sequence[Place] | None:
    """The way without a map."""
    return (goal,)


def place(point: Point) -> Place:
    """A point of a mission, which may lie in the plane, as a place."""
    return (point[0], point[1], point[2] if len(point) > 2 else 0.0)


def path_length(start: Place, waypoints: Sequence[Waypoint]) -> float:
    """Metres from a place through way points."""
    places = [start, *(w.position for w in waypoints)]
    return sum(map(math.dist, places, places[1:]))
