"""The port of a robot: the one interface to a robot, simulated or real."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Protocol

Place = tuple[float, float, float]
"""Metres in the map frame; z is 0 in a mission in the plane."""


def planar(place: Sequence[float]) -> tuple[float, float]:
    """Return a place without its height."""
    return (place[0], place[1])


@dataclass(frozen=True)
class Waypoint:
    """A place that a robot goes to, and what it does there.

    Parameters
    ----------
    position
        the place, reached straight from the robot's position or from the way point before.
    heading
        radians from east, anticlockwise, to which it turns there; None: it keeps the heading with which it arrives.
    hold_s
        seconds for which it stays.
    label
        returned by telemetry when the way point is passed; it has a meaning for the sender only.
    via
        whether it only marks the way to the next one, so that who steers the robot may choose another way.
    speed_mps
        the greatest speed on the way to it; inf: that of the robot.
    uses
        what the stay there uses beside the way, in the mission's unit; None: its seconds, with usage by distance times
        the speed.
    service
        id of the station that serves the robot while it stays there; empty: none.
    """

    position: Place
    heading: float | None = None
    hold_s: float = 0.0
    label: str = ""
    via: bool = False
    speed_mps: float = math.inf
    uses: float | None = None
    service: str = ""


@dataclass(frozen=True)
class Inertial:
    """Measurements of a robot's inertial unit since the last report: levelled, and without gravity.

    Parameters
    ----------
    seconds
        the duration over which the other values are means.
    acceleration_mps2
        ahead, to the left, up: the difference between the mean velocity of this duration and that of the same duration
        before, per second.
    turning_radps
        the rate of change of the heading.
    """

    seconds: float
    acceleration_mps2: Place
    turning_radps: float


@dataclass(frozen=True)
class Telemetry:
    """What a robot last reported of itself.

    Parameters
    ----------
    time_s
        the time of the report, in seconds of the mission's clock.
    position, heading, velocity
        map frame: metres, radians, m/s, by its odometry.
    odometry_m
        metres travelled since the beginning of the mission.
    order, passed
        the number of the last `send` that it accepted, and how many of its way points it has passed, holds included.
    inertial
        of its inertial unit; None where it has none, or has not moved yet.
    charge
        the share of its battery that is left, 0 to 1, and of its work capacity where the mission gives it no battery;
        None where it does not report that.
    refused
        why it cannot reach the next way point of this order, by its own navigation; empty while it goes on.
    waits_for
        the robot that it waits for in traffic; empty while it waits for nobody, None where it does not tell.
    left_m
        metres that it has still to go to the next way point that is no `via`, by its own navigation; None where that
        does not say.
    suspended
        why it takes no part for now, by its bridge: a pilot or a failsafe of its own has it; empty while it takes part.
    carried_out
        the number of an order that was replaced while the robot was not heard, and how many of its way points the robot
        has passed all the same; None where there is no such order.
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
    waits_for: str | None = None
    left_m: float | None = None
    suspended: str = ""
    carried_out: tuple[int, int] | None = None

    @property
    def energy_left(self) -> float | None:
        """The share of its energy that is left, which is the `charge` of its battery."""
        return self.charge


class RobotPort(Protocol):
    """The interface to one robot."""

    @property
    def robot(self) -> str:
        """Its id."""
        ...

    def send(self, waypoints: Sequence[Waypoint]) -> int:
        """Replace the way points that are left by these; return the number of this order, from 1."""
        ...

    def cancel(self) -> int:
        """Stop the robot where it is, without way points; return the number of this order."""
        ...

    def telemetry(self) -> Telemetry | None:
        """The last report; None before the first one. The report of a silent robot keeps its time."""
        ...


BeforeOrder = Callable[[str, Sequence[Waypoint]], None]
"""Receives an order before it is sent: whose it is, and its way points, none where the robot is to stay."""


class TranslatedPort:
    """A port that changes each telemetry report; orders pass unchanged.

    Parameters
    ----------
    translate
        returns the changed report.
    before_order
        receives each order before it passes.
    """

    def __init__(
        self, port: RobotPort, translate: Callable[[Telemetry], Telemetry], before_order: BeforeOrder | None = None
    ) -> None:
        self._port, self._retell, self._before_order = port, translate, before_order

    @property
    def robot(self) -> str:
        return self._port.robot

    def send(self, waypoints: Sequence[Waypoint]) -> int:
        """See `RobotPort`."""
        if self._before_order is not None:
            self._before_order(self.robot, waypoints)
        return self._port.send(waypoints)

    def cancel(self) -> int:
        """See `RobotPort`."""
        if self._before_order is not None:
            self._before_order(self.robot, ())
        return self._port.cancel()

    def telemetry(self) -> Telemetry | None:
        """See `RobotPort`."""
        said = self._port.telemetry()
        return None if said is None else self._retell(said)
