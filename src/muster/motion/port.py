"""The port of a robot: the one way to reach it, be it simulated or real, whatever carries the plan out."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Protocol

Place = tuple[float, float, float]
"""Metres in the map frame; z is 0 in a mission in the plane."""


@dataclass(frozen=True)
class Waypoint:
    """Where a robot goes, and what it does there.

    Parameters
    ----------
    position
        where it goes, straight from where it is or from the way point before.
    heading
        radians from east, anticlockwise, to which it turns there; None: as it arrives.
    hold_s
        seconds for which it stays.
    label
        given back by telemetry when it is passed; the sender's own affair.
    """

    position: Place
    heading: float | None = None
    hold_s: float = 0.0
    label: str = ""


@dataclass(frozen=True)
class Inertial:
    """What a robot's inertial unit felt since the last report, as its autopilot gives it: levelled, gravity taken off.

    Parameters
    ----------
    seconds
        for how long: what follows are means.
    acceleration_mps2
        ahead, to the left, up: by how much the velocity of this time differs from that of as long a time before, a
        second.
    turning_radps
        how fast the heading grows.
    """

    seconds: float
    acceleration_mps2: Place
    turning_radps: float


@dataclass(frozen=True)
class Telemetry:
    """What a robot last said of itself.

    Parameters
    ----------
    time_s
        when, in seconds of the mission's clock.
    position, heading, velocity
        map frame: metres, radians, m/s, as its odometry has them.
    odometry_m
        metres travelled since the beginning of the mission.
    order, passed
        the number of the last `send` that it took, and how many of its way points it has passed, holds included.
    inertial
        of its inertial unit; None where it has none, or has not moved yet.
    charge
        share of its work capacity that its battery leaves, 0 to 1; None where it says nothing of it.
    refused
        why it will not get to the next way point of this order, as its own navigation says; empty while it goes on.
    """

    time_s: float
    position: Place
    heading: float
    velocity: Place
    odometry_m: float
    order: int
    passed: int
    inertial: Inertial | None = None
    charge: float | None = None
    refused: str = ""


class RobotPort(Protocol):
    """One robot."""

    @property
    def robot(self) -> str:
        """Its id."""
        ...

    def send(self, waypoints: Sequence[Waypoint]) -> int:
        """Give it way points in place of those that it still has; returns the number of this order, from 1."""
        ...

    def cancel(self) -> int:
        """Let it stop where it is, without way points; returns the number of this order."""
        ...

    def telemetry(self) -> Telemetry | None:
        """What it last said; None before it has said anything. Of a silent robot the times do not go on."""
        ...


class RetoldPort:
    """A port whose telemetry is told in other words; orders go through as they are.

    Parameters
    ----------
    retell
        what becomes of each report.
    """

    def __init__(self, port: RobotPort, retell: Callable[[Telemetry], Telemetry]) -> None:
        self._port, self._retell = port, retell

    @property
    def robot(self) -> str:
        return self._port.robot

    def send(self, waypoints: Sequence[Waypoint]) -> int:
        """See `RobotPort`."""
        return self._port.send(waypoints)

    def cancel(self) -> int:
        """See `RobotPort`."""
        return self._port.cancel()

    def telemetry(self) -> Telemetry | None:
        """See `RobotPort`."""
        said = self._port.telemetry()
        return None if said is None else self._retell(said)
