"""What a schedule is made of: nodes that begin at one moment, and what bounds their begins from below."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import ClassVar, NamedTuple

from muster.mission.tasks import Task
from muster.verification.measure import MeasuredRoute, Step
from muster.verification.station_queues import Name, Turn
from muster.verification.verdict import Violation

ROUNDING = 1e-9
"""By how much a time may be above a limit, relative, or in seconds where it is below one."""


class Times(NamedTuple):
    """When the robot is at a stop, seconds."""

    arrives: float
    starts: float
    ends: float


@dataclass(frozen=True)
class Deadlock:
    """There is no schedule: tasks wait for each other in a cycle, which `violation` names step by step."""

    violation: Violation
    is_kept: ClassVar[bool] = False


@dataclass(frozen=True)
class Schedule:
    """By robot the times at the stops of its route, in order; the limits that these break.

    `leaves` is when each robot leaves its start, and `back` when each route that has stops ends.
    """

    times: Mapping[str, Sequence[Times]]
    broken: tuple[Violation, ...]
    leaves: Mapping[str, float]
    back: Mapping[str, float]

    @property
    def is_kept(self) -> bool:
        """Whether no limit is broken."""
        return not self.broken


def is_after(time: float, limit: float) -> bool:
    """Whether a time is later than a limit, by more than rounding."""
    return time > limit + ROUNDING * max(1.0, abs(limit))


def names_of(route: MeasuredRoute) -> list[Name]:
    """The names of a route's stops, in order."""
    return [
        stop.task.id if isinstance(stop, Step) else Turn(stop.station.id, route.robot.id, k)
        for k, stop in enumerate(route.stops)
    ]


def place_name(name: Name) -> str:
    """The id of the task or station."""
    return name if isinstance(name, str) else name.station


@dataclass(frozen=True)
class Node:
    """Tasks that begin at the same moment; without tasks: one visit of a station."""

    tasks: list[Task]
    legs: list[tuple[Name | None, str, float]] = field(default_factory=list)  # stop before, robot, seconds of the leg
    awaited: list[tuple[str, float, float]] = field(default_factory=list)  # prerequisite, least and most lag


@dataclass(frozen=True)
class Bound:
    """What raises the begin of a node: the end of a stop, the begin of one that waits for it, and seconds.

    By a leg of `robot`, or by the queue of a station where `queues`; else by a lag: the most if `delays` the task
    before, else the least.
    """

    before: Name
    seconds: float
    robot: str | None = None
    delays: Name | None = None
    queues: bool = False


@dataclass(frozen=True)
class Links:
    """How nodes follow on each other.

    Parameters
    ----------
    node_of
        for each stop the name of its node.
    """

    routes: Sequence[MeasuredRoute]
    node_of: Mapping[Name, Name]
    nodes: Mapping[Name, Node]

    def stop_after(self, robot: str, before: Name) -> Name:
        """The stop that a robot goes to from another."""
        names = next(names_of(route) for route in self.routes if route.robot.id == robot)
        return names[names.index(before) + 1]

    def waiting(self, node: Name, before: Name) -> str:
        """The task of a node that waits for a prerequisite."""
        return next(task.id for task in self.nodes[node].tasks if before in task.prerequisites)
