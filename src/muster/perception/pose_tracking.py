"""State estimation of one robot: telemetry with errors in, telemetry with the filter's pose out.

Each report is used as a position fix, with its odometry and the inertial unit's reading. A `FusedPort` is a robot port
with the fused pose, so that execution needs no knowledge of filters.
"""

from __future__ import annotations

import math
from abc import ABC, abstractmethod
from dataclasses import replace

import numpy as np

from muster.mission.errors import ParameterError
from muster.motion.port import Inertial, RobotPort, Telemetry, TranslatedPort
from muster.perception import air_fusion, ground_fusion, heading_fusion
from muster.perception.errors import AirErrors, GroundErrors
from muster.perception.kalman import Correction, Estimate

_SAME_S = 1e-6


class Tracker(ABC):
    """The filter of one robot; reports come in order of their time."""

    _estimate: Estimate | None = None
    _fix: Correction | None = None

    @abstractmethod
    def fused(self, said: Telemetry) -> Telemetry:
        """The report with the filter's pose. A report that is no newer than the last does not change the filter."""

    @property
    def estimate(self) -> Estimate | None:
        """The filter's state after the last report; None before the first."""
        return self._estimate

    @property
    def fix(self) -> Correction | None:
        """The correction by the last report's position; None before the second report."""
        return self._fix


class GroundTracker(Tracker):
    """A robot that faces its way. Its speed comes from `odometry_m`, its position and heading from fixes.

    A gyro reading is used if it spans exactly the time between two reports.

    Raises
    ------
    ParameterError
        if the errors of position or heading are 0: there is nothing to filter then.
    """

    def __init__(self, errors: GroundErrors) -> None:
        _require("position_m", errors.position_m)
        _require("heading_rad", errors.heading_rad)
        self._errors = errors
        self._last: Telemetry | None = None

    def fused(self, said: Telemetry) -> Telemetry:
        if self._estimate is None or self._last is None:
            errors = self._errors
            pose = (*said.position[:2], said.heading)
            spread = (errors.position_m, errors.position_m, errors.heading_rad)
            self._estimate, self._last = ground_fusion.standing_at(pose, spread, errors), said
            self._height, self._height_variance = said.position[2], errors.position_m**2
        elif said.time_s > self._last.time_s:
            self._take_in(self._estimate, self._last, said)
            self._last = said
        x, y, heading, counted, _, _, slip = map(float, self._estimate.mean)
        speed = counted * (1 - slip)
        velocity = (speed * math.cos(heading), speed * math.sin(heading), said.velocity[2])
        return replace(said, position=(x, y, self._height), heading=heading, velocity=velocity)

    def _take_in(self, estimate: Estimate, last: Telemetry, said: Telemetry) -> None:
        errors, metres, dt = self._errors, said.odometry_m - last.odometry_m, said.time_s - last.time_s
        felt = _felt_in(said, dt)
        turning = None if felt is None else felt.turning_radps
        rise, level = _slope(said)
        estimate = ground_fusion.moved_as_counted(estimate, dt, level * metres, said.heading, errors, turning)
        self._fix = ground_fusion.by_position(estimate, said.position[:2], errors)
        self._estimate = self._fix.estimate
        self._climb(said.position[2], rise * metres, errors.climb_share * metres)

    def _climb(self, said_m: float, counted_m: float, spread_m: float) -> None:
        """The height has a filter of its own: one number, (2.1) to (2.5)."""
        climbed = self._height_variance + spread_m**2
        gain = climbed / (climbed + self._errors.position_m**2)
        self._height += counted_m
        self._height += gain * (said_m - self._height)
        self._height_variance = (1 - gain) * climbed


class AirTracker(Tracker):
    """A robot that moves in any direction. Its velocity is used as odometry.

    The inertial unit's reading is used if it spans exactly the time between two reports; without one the heading is as
    reported.

    Raises
    ------
    ParameterError
        if the errors of position, heading or velocity are 0: there is nothing to filter then.
    """

    def __init__(self, errors: AirErrors) -> None:
        _require("position_m", errors.position_m)
        _require("heading_rad", errors.heading_rad)
        _require("velocity_mps", errors.velocity_mps)
        self._errors = errors
        self._facing: Estimate | None = None
        self._time_s = -math.inf

    def fused(self, said: Telemetry) -> Telemetry:
        errors = self._errors
        if self._estimate is None:
            self._estimate = air_fusion.hovering_at(said.position, errors.position_m, errors)
            self._time_s = said.time_s
        elif said.time_s > self._time_s:
            dt, self._time_s = said.time_s - self._time_s, said.time_s
            felt = _felt_in(said, dt)
            self._turn(said, felt)
            moved = self._moved(self._estimate, said, dt, felt)
            self._fix = air_fusion.by_position(moved, np.array(said.position), errors)
            self._estimate = self._fix.estimate
        x, y, z, *velocity, slip = map(float, self._estimate.mean)
        east, north, up = (speed * (1 - slip) for speed in velocity)
        heading = said.heading if self._facing is None else float(self._facing.mean[heading_fusion.HEADING])
        return replace(said, position=(x, y, z), heading=heading, velocity=(east, north, up))

    def _turn(self, said: Telemetry, felt: Inertial | None) -> None:
        if felt is None:
            self._facing = None
        elif self._facing is None:
            self._facing = heading_fusion.turned_to(said.heading, self._errors.heading_rad, self._errors)
        else:
            turned = heading_fusion.turned(self._facing, felt.seconds, felt.turning_radps, self._errors)
            self._facing = heading_fusion.by_heading(turned, said.heading, self._errors).estimate

    def _moved(self, estimate: Estimate, said: Telemetry, dt: float, felt: Inertial | None) -> Estimate:
        errors = self._errors
        if felt is None or self._facing is None:
            blind = replace(errors, acceleration_mps2=errors.unfelt_mps2)
            return air_fusion.by_odometry(air_fusion.moved(estimate, dt, blind), said.velocity, errors).estimate
        ahead, left, up = felt.acceleration_mps2
        facing = float(self._facing.mean[heading_fusion.HEADING])
        c, s = math.cos(facing), math.sin(facing)
        pushed = c * ahead - s * left, s * ahead + c * left, up
        unsure = math.hypot(self._facing.deviations[heading_fusion.HEADING], errors.odometry_slip)
        spread = math.hypot(errors.acceleration_mps2, unsure * math.hypot(*pushed))
        aware = replace(errors, acceleration_mps2=spread)  # of how well heading and slip are known
        return air_fusion.moved_as_counted(estimate, dt, said.velocity, aware, pushed)


class FusedPort(TranslatedPort):
    """A robot's port whose telemetry is fused by its `tracker`."""

    def __init__(self, port: RobotPort, tracker: Tracker) -> None:
        super().__init__(port, tracker.fused)
        self.tracker = tracker


def _slope(said: Telemetry) -> tuple[float, float]:
    """By how much the way rises, and how far it goes level, for each metre of it, by odometry."""
    east, north, up = said.velocity
    speed = math.hypot(east, north, up)
    return (up / speed, math.hypot(east, north) / speed) if speed > 0 else (0.0, 1.0)


def _felt_in(said: Telemetry, dt: float) -> Inertial | None:
    """The inertial reading, if it is of the last `dt` seconds."""
    felt = said.inertial
    return felt if felt is not None and abs(felt.seconds - dt) < _SAME_S else None


def _require(name: str, deviation: float) -> None:
    if deviation == 0:
        raise ParameterError(f"{name}: 0; expected a number above 0: what is exact needs no filter")
