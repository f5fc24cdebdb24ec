"""Base of ports of robots that report only poses: velocities estimated from poses, goals from way points."""

from __future__ import annotations

import math
from collections.abc import Sequence

from muster.mission.errors import ParameterError
from muster.motion.port import Place, Telemetry, Waypoint

_AT_ONCE_S = 0.01
"""Poses that come closer to each other say nothing of the velocity."""


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
