"""The motion of a task as a robot carries it out: way points of its action, connected by paths."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from itertools import pairwise
from typing import Protocol

from muster.mission.model import Point, Robot, Task
from muster.motion.actions import Impossible, TaskMotion, duration_of
from muster.motion.leg_times import LegTimes
from muster.motion.port import Place, Waypoint

MotionPlanner = Callable[[Task, Robot], TaskMotion | Impossible]
"""What a task makes a robot do, or why the robot cannot do it."""


class Way(Protocol):
    """The ways that robots go."""

    def __call__(self, robot: Robot, start: Place, goal: Place, *, at_work: bool = False) -> Sequence[Waypoint] | None:
        """Return what a robot passes from one place to another, the last included; None where there is no way.

        At work robots keep to no lanes.
        """
        ...


@dataclass(frozen=True)
class Work:
    """How one robot does one task.

    Parameters
    ----------
    waypoints
        what it passes from where it enters the task, holds included; passing the last is the end of the work.
    cost_m
        usage of the work, by distance: what of it is not travelled is used while the robot stays.
    driven_s
        seconds that the robot drives from the entry to the exit.
    """

    waypoints: tuple[Waypoint, ...]
    cost_m: float
    driven_s: float

    @property
    def entry(self) -> Place:
        return self.waypoints[0].position

    @property
    def exit(self) -> Place:
        return self.waypoints[-1].position

    @cached_property
    def way_m(self) -> float:
        """Metres from the entry to the exit."""
        return path_length(self.entry, self.waypoints)

    @property
    def lasts_s(self) -> float:
        """Seconds that it takes, from the entry on."""
        return self.driven_s + sum(waypoint.hold_s for waypoint in self.waypoints)

    @property
    def stayed_cost_m(self) -> float:
        """Usage by distance that is not travelled."""
        return max(0.0, self.cost_m - self.way_m)


def work_of(task: Task, robot: Robot, plan_motion: MotionPlanner, way: Way, times: LegTimes) -> Work | Impossible:
    """How a robot does a task: what `plan_motion` says, by `way` from each way point to the next.

    What the task takes, if that is given, it takes by the robot's motion profile and over a map too: by what driving
    takes longer there the robot stays less. Where that alone takes longer, so does the work.
    """
    found = plan_motion(task, robot)
    if isinstance(found, Impossible):
        return found
    waypoints, metres, travelled_s = [found.waypoints[0]], list[float](), 0.0
    for before, waypoint in pairwise(found.waypoints):
        there = way(robot, before.position, waypoint.position, at_work=not found.is_travel)
        if there is None:
            return Impossible(f"unreachable: there is no way from {_told(before)} to {_told(waypoint)}")
        passed = [*along(there)[:-1], replace(waypoint, speed_mps=there[-1].speed_mps)]
        metres.append(path_length(before.position, passed))
        travelled_s += travel_s(times, before.position, passed)
        waypoints += passed
    driven_s = times.work_seconds(places_of(found.waypoints), metres)
    if times.along_lanes and found.is_travel:
        driven_s = travelled_s
    if duration_of(task) is not None or found.typed_cost is not None:
        straight_s = path_length(found.waypoints[0].position, found.waypoints) / robot.speed_mps
        waypoints = list(_staying_less(waypoints, max(0.0, driven_s - straight_s)))
    return Work(tuple(waypoints), sum(metres) if found.typed_cost is None else found.typed_cost, driven_s)


def _staying_less(waypoints: Sequence[Waypoint], by_s: float) -> Iterator[Waypoint]:
    """Way points with so much less hold in all, as far as they have it."""
    for waypoint in waypoints:
        less = min(by_s, waypoint.hold_s)
        by_s -= less
        yield replace(waypoint, hold_s=waypoint.hold_s - less)


def _told(waypoint: Waypoint) -> str:
    return f"({', '.join(f'{c:g}' for c in waypoint.position)})"


def straight(robot: Robot, start: Place, goal: Place, *, at_work: bool = False) -> Sequence[Waypoint] | None:
    """The way without a map."""
    return (Waypoint(goal),)


def along(way: Sequence[Waypoint], label: str = "") -> list[Waypoint]:
    """Way points along a way, all but the last of which only mark it."""
    return [replace(point, label=label, via=k + 1 < len(way)) for k, point in enumerate(way)]


def places_of(way: Sequence[Waypoint]) -> list[Place]:
    """Return the places of way points."""
    return [waypoint.position for waypoint in way]


def place(point: Point) -> Place:
    """A point of a mission, which may lie in the plane, as a place."""
    return (point[0], point[1], point[2] if len(point) > 2 else 0.0)


def travel_s(times: LegTimes, start: Place, waypoints: Sequence[Waypoint]) -> float:
    """Seconds from rest at a place to rest at the last of the way points, by a way that passes the others."""
    if not waypoints:
        return 0.0
    end = waypoints[-1].position
    if times.along_lanes:
        return times.way_seconds([start, *places_of(waypoints)], [waypoint.speed_mps for waypoint in waypoints])
    return float(times.seconds(path_length(start, waypoints), abs(end[2] - start[2]), math.dist(start, end)))


def path_length(start: Place, waypoints: Sequence[Waypoint]) -> float:
    """Metres from a place through way points."""
    places = [start, *(w.position for w in waypoints)]
    return sum(map(math.dist, places, places[1:]))
