"""What a robot's process and the simulated world tell each other. Plain data for pipes.

The world is to a robot what its sensors and motors are, and an operator who can reach it. It tells nothing that a robot
would not know by itself: what others do, robots tell each other.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

from muster.mission.model import Event
from muster.motion.port import Telemetry, Waypoint


@dataclass(frozen=True)
class Sense:
    """What a robot's body tells it.

    Parameters
    ----------
    now_s
        the mission's time, seconds.
    telemetry
        how it stands.
    orders, used
        how many orders it was given, and what it has used, in the mission's unit, as a gauge has it: for a robot that
        starts again.
    """

    now_s: float
    telemetry: Telemetry
    orders: int
    used: float


@dataclass(frozen=True)
class Befalls:
    """What an operator tells one robot, for all: an event as in a mission file."""

    event: Event


@dataclass(frozen=True)
class Radio:
    """Whether the robot's messages come through, both ways."""

    on: bool


@dataclass(frozen=True)
class Steer:
    """Way points for the robot's body."""

    waypoints: Sequence[Waypoint]


@dataclass(frozen=True, kw_only=True)
class Did:
    """What a robot has done, and whether it has more to do.

    Parameters
    ----------
    events
        (seconds, kind, data) of each, as an executor tells them.
    used
        so far, in the mission's unit.
    usages
        of tasks that it has done since it told last: planned, flown.
    idle
        whether it has nothing to do, nor a way to go.
    settled
        whether all that it hears have agreed.
    heard
        how many times it was told something that befalls.
    """

    events: Sequence[tuple[float, str, Mapping[str, Any]]]
    used: float
    usages: Mapping[str, tuple[float, float]]
    idle: bool
    settled: bool
    heard: int
