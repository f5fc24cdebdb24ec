"""What a robot says of itself, fused: telemetry with errors in, telemetry with the filter's pose out.

Each report is taken in as a position fix, with the odometer's count as odometry. So whoever carries a plan out works
with the fused pose where noise is on, and needs to know nothing of filters: a `FusedPort` is a robot's port as others.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import replace
from typing import Protocol

import numpy as np

from muster.mission.errors import ParameterError
from muster.motion.port import RobotPort, Telemetry, Waypoint
from muster.perception import air_fusion, ground_fusion
from muster.perception.errors import AirErrors, GroundErrors
from muster.perception.kalman import Estimate


class Tracker(Protocol):
    """Of one robot; reports come in the order in which they were made."""

    def fused(self, said: Telemetry) -> Telemetry:
        """The report with the filter's pose. One that is no newer than the last changes nothing in the filter."""
        ...

    @property
    def estimate(self) -> Estimate | None:
        """The filter's state after the last report; None before the first."""
        ...


class GroundTracker:
    """A robot that drives the way it looks. Its speed comes from `odometry_m`, place and heading from fixes.

    Raises
    ------
    ParameterError
        if place or heading are said without error: there is nothing to filter then.
    """

    def __init__(self, errors: GroundErrors) -> None:
        _require("position_m", errors.position_m)
        _require("heading_rad", errors.heading_rad)
        self._errors = errors
        self._estimate: Estimate | None = None
        self._last: Telemetry | None = None

    @property
    def estimate(self) -> Estimate | None:
        return self._estimate

    def fused(self, said: Telemetry) -> Telemetry:
        if self._estimate is None or self._last is None:
            errors = self._errors
            pose = (*said.position[:2], said.heading)
            spread = (errors.position_m, errors.position_m, errors.heading_rad)
            self._estimate, self._last = ground_fusion.standing_at(pose, spread, errors), said
        elif said.time_s > self._last.time_s:
            self._estimate, self._last = self._advanced(self._estimate, self._last, said), said
        x, y, heading, counted, _, _, slip = map(float, self._estimate.mean)
        speed = counted * (1 - slip)
        velocity = (speed * math.cos(heading), speed * math.sin(heading), said.velocity[2])
        return replace(said, position=(x, y, said.position[2]), heading=heading, velocity=velocity)

    def _advanced(self, estimate: Estimate, last: Telemetry, said: Telemetry) -> Estimate:
        metres = said.odometry_m - last.odometry_m
        dt = said.time_s - last.time_s
        estimate = ground_fusion.moved_as_counted(estimate, dt, metres, said.heading, self._errors)
        return ground_fusion.by_position(estimate, said.position[:2], self._errors).estimate


class AirTracker:
    """A robot that moves in any direction. Its velocity is odometry; its heading stays as it was said.

    Raises
    ------
    ParameterError
        if place or velocity are said without error: there is nothing to filter then.
    """

    def __init__(self, errors: AirErrors) -> None:
        _require("position_m", errors.position_m)
        _require("velocity_mps", errors.velocity_mps)
        self._errors = errors
        self._estimate: Estimate | None = None
        self._time_s = -math.inf

    @property
    def estimate(self) -> Estimate | None:
        return self._estimate

    def fused(self, said: Telemetry) -> Telemetry:
        errors = self._errors
        if self._estimate is None:
            self._estimate, self._time_s = air_fusion.hovering_at(said.position, errors.position_m), said.time_s
        elif said.time_s > self._time_s:
            moved = air_fusion.moved(self._estimate, said.time_s - self._time_s, errors)
            moved = air_fusion.by_odometry(moved, said.velocity, errors).estimate
            self._estimate = air_fusion.by_position(moved, np.array(said.position), errors).estimate
            self._time_s = said.time_s
        x, y, z, *velocity = map(float, self._estimate.mean)
        return replace(said, position=(x, y, z), velocity=(velocity[0], velocity[1], velocity[2]))


class FusedPort:
    """A robot's port whose telemetry is fused; orders go through as they are."""

    def __init__(self, port: RobotPort, tracker: Tracker) -> None:
        self._port = port
        self._tracker = tracker

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
        return None if said is None else self._tracker.fused(said)


def _require(name: str, deviation: float) -> None:
    if deviation == 0:
        raise ParameterError(f"{name}: 0; expected a number above 0: what is exact needs no filter")
