"""Messages between a robot's process and the simulated world. Plain data for pipes.

The world stands for the robot's sensors and motors, and for an operator who can reach it. It tells a robot nothing that
the robot would not know by itself: robots learn from each other what the others do.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

from muster.execution.reports.team_report import RefusedOrder
from muster.mission.model import Event
from muster.motion.port import Telemetry, Waypoint
from muster.perception.occupancy_map import Scan


@dataclass(frozen=True)
class BodyState:
    """What a robot's sensors tell it.

    Parameters
    ----------
    now_s
        the mission's time, seconds.
    telemetry
        the robot's pose and progress.
    orders, used
        the number of orders that the body has received, and the usage so far in the mission's unit: for a restarted
        robot.
    """

    now_s: float
    telemetry: Telemetry
    orders: int
    used: float


@dataclass(frozen=True)
class LidarScan:
    """What the robot's lidar sees, where robots have no map. Places of robots that it hears are left out."""

    scan: Scan


@dataclass(frozen=True)
class MapPieces:
    """The pieces of its map that a robot has made in a life, for those who look on."""

    life: int
    pieces: Sequence[bytes]


@dataclass(frozen=True)
class OperatorEvent:
    """What an operator tells one robot for the whole team: an event as in a mission file."""

    event: Event


@dataclass(frozen=True)
class RadioState:
    """Whether the robot's messages come through, in both directions."""

    on: bool


@dataclass(frozen=True)
class SteerCommand:
    """Way points for the robot's body."""

    waypoints: Sequence[Waypoint]


@dataclass(frozen=True, kw_only=True)
class WorkReport:
    """What a robot has done, and whether it has more to do.

    Parameters
    ----------
    events
        (seconds, kind, data) of each, as an executor reports them.
    used
        the usage so far, in the mission's unit.
    idle
        whether it has neither a task nor a path left.
    settled
        whether all robots that it hears have agreed.
    heard
        the number of operator events that it has received.
    refused_at_once, refused_by_team
        why it refused operator events since its last report, and all orders that do not count, as far as it knows.
    ways_closed
        how often it has gone another way, as its own was closed by what its team saw.
    """

    events: Sequence[tuple[float, str, Mapping[str, Any]]]
    used: float
    idle: bool
    settled: bool
    heard: int
    refused_at_once: Sequence[str] = ()
    refused_by_team: Sequence[RefusedOrder] = ()
    ways_closed: int = 0
