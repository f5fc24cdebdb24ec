"""Base of ports of robots that report only poses: velocities estimated from poses, goals from way points."""

from __future__ import annotations

import logging
import math
from collections.abc import Callable, Sequence
from dataclasses import replace

from muster.mission.errors import ParameterError
from muster.motion.port import Place, Telemetry, Waypoint

_AT_ONCE_S = 0.01
"""Poses that come closer to each other say nothing of the velocity."""
_log = logging.getLogger(__name__)


class Attention:
    """Whether somebody receives a robot's orders.

    Where nobody does, the robot cannot be driven, whatever it says of its place: the time of its telemetry stands
    still from then on, so that it counts as silent, and its tasks go to others.

    Parameters
    ----------
    robot : str
        The robot's id, for the warning.
    expected : str
        The subscriber or action server that is expected, such as "a subscriber of /r_0/cmd_vel (geometry_msgs/Twist)".
    is_paid : Callable
        Returns whether there is one.
    """

    def __init__(self, robot: str, expected: str, is_paid: Callable[[], bool]) -> None:
        self._robot, self._expected, self._is_paid = robot, expected, is_paid
        self._lost_s: float | None = None

    @property
    def missing(self) -> str:
        """What is missing, and what is expected; empty if somebody receives the orders."""
        return "" if self._is_paid() else f"nobody receives its orders; expected {self._expected}"

    def judged(self, said: Telemetry | None) -> Telemetry | None:
        """Return the telemetry as it counts: of the time at which somebody received the robot's orders last."""
        if said is None or self._is_paid():
            self._lost_s = None
            return said
        if self._lost_s is None:
            self._lost_s = said.time_s
            _log.warning("robot %s: %s; it counts as silent", self._robot, self.missing)
        return replace(said, time_s=min(said.time_s, self._lost_s))


def velocity_by(before: Telemetry | None, place: Place, now: float) -> Place:
    """Of a robot that is at a place now, by its pose before, m/s; that of before, where both came at once."""
    if before is None:
        return (0.0, 0.0, 0.0)
    seconds = now - before.time_s
    if seconds < _AT_ONCE_S:
        return before.velocity
    x, y, z = ((new - old) / seconds for new, old in zip(place, before.position, strict=True))
    return (x, y, z)


def goal_heading(aim: Waypoint, said: Telemetry | None) -> float:
    """The heading at a way point, radians; where it wants none, that of the way there, or as the robot stands there."""
    if aim.heading is not None:
        return aim.heading
    if said is None:
        return 0.0
    east, north = aim.position[0] - said.position[0], aim.position[1] - said.position[1]
    return math.atan2(north, east) if math.hypot(east, north) > 0 else said.heading


def require_finite(robot: str, waypoints: Sequence[Waypoint]) -> None:
    """Check way points before a robot gets them.

    Raises
    ------
    ParameterError
        if a number of one is not finite.
    """
    for point in waypoints:
        if not all(map(math.isfinite, (*point.position, point.heading or 0.0, point.hold_s))):
            raise ParameterError(f"way point of {robot}: {point}; expected finite numbers")
