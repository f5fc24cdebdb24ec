"""Sensors of a simulated robot's pose that stand outside of it: motion capture and satellites.

They measure the true pose with errors, and correct an estimate of `perception.dead_reckoning`.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, fields
from typing import Protocol

import numpy as np

from muster.mission.errors import ParameterError
from muster.motion.frames import wrapped
from muster.motion.grid import Floats
from muster.perception.dead_reckoning import by_pose, by_position
from muster.perception.joint_estimate import Fix, JointEstimate
from muster.simulation.world import SimulatedWorld

_STREAM = 0x905E
"""Of the errors of these sensors, so that they are not those of anything else with the same seed."""
_LEAST_M, _LEAST_RAD = 1e-4, 1e-4
"""What a filter counts with at least: no sensor is exact."""


class PoseSensor(Protocol):
    """One sensor of one robot."""

    def corrected(self, estimate: JointEstimate) -> JointEstimate:
        """The estimate with what it measures now; the same estimate where it measures nothing now."""
        ...


@dataclass(frozen=True, kw_only=True)
class SensorParameters:
    """Parameters of a sensor: numbers of at least 0; `drop_out` is a share below 1, rates are above 0.

    Raises
    ------
    ParameterError
        if one is out of range.
    """

    def __post_init__(self) -> None:
        for field in fields(self):
            value = getattr(self, field.name)
            if not isinstance(value, str):
                _require(field.name, value)


def _require(name: str, value: float) -> None:
    if name in ("ahead_m", "left_m", "turn_deg"):
        expected, right = "a finite number", math.isfinite(value)
    elif name in ("rate_hz", "drop_out_s", "depth_m"):
        expected, right = "a finite number above 0", 0 < value < math.inf
    elif name == "drop_out":
        expected, right = "a share, 0 to below 1", 0 <= value < 1
    else:
        expected, right = "a finite number of at least 0", 0 <= value < math.inf
    if not right:
        raise ParameterError(f"{name}: {value}; expected {expected}")


@dataclass(frozen=True, kw_only=True)
class MotionCaptureParameters(SensorParameters):
    """Motion capture: a pose of each robot by its markers.

    Parameters
    ----------
    rate_hz
        readings a second; in a world at most one a step.
    position_m, heading_rad
        standard deviations of each coordinate and of the heading.
    drop_out, drop_out_s
        the share of time without readings, and how long that lasts in the mean.
    robot, ahead_m, left_m, turn_deg
        the robot whose markers are misaligned ([tcf-thesis], Figure 6.15): where the origin of the rigid body that is
        measured lies in the robot's own frame, and by how much it is turned to the left of it.
    """

    rate_hz: float = 100.0
    position_m: float = 0.0005
    heading_rad: float = 0.002
    drop_out: float = 0.0
    drop_out_s: float = 1.0
    robot: str = ""
    ahead_m: float = 0.0
    left_m: float = 0.0
    turn_deg: float = 0.0


@dataclass(frozen=True, kw_only=True)
class SatelliteParameters(SensorParameters):
    """Satellite navigation: white errors of each coordinate of the position; no heading."""

    rate_hz: float = 1.0
    position_m: float = 1.5
    drop_out: float = 0.0
    drop_out_s: float = 5.0


class Readings:
    """When a sensor gives readings: at a rate, except while it drops out, as a Markov chain."""

    def __init__(self, rate_hz: float, drop_out: float, drop_out_s: float, random: np.random.Generator) -> None:
        self._period_s, self._random, self._due_s, self._out = 1 / rate_hz, random, 0.0, False
        self._ends = min(1.0, self._period_s / drop_out_s)
        self._begins = min(1.0, self._ends * drop_out / (1 - drop_out))

    def due(self, now: float) -> bool:
        """Whether there is a reading now."""
        if now < self._due_s - 1e-9:
            return False
        self._due_s = max(self._due_s + self._period_s, now)
        self._out = self._random.random() < (1 - self._ends if self._out else self._begins)
        return not self._out


class _OfOneRobot:
    """A robot's number in its world, and the random numbers of one sensor of it."""

    def __init__(self, world: SimulatedWorld, robot: str, seed: int, stream: int) -> None:
        self._world, self._number = world, list(world.ports).index(robot)
        key = np.random.SeedSequence((seed, self._number), spawn_key=(_STREAM, stream))
        self._random = np.random.default_rng(key)

    @property
    def _pose(self) -> Floats:
        return np.array([*self._world.positions[self._number], self._world.headings[self._number]])


class MotionCapture(_OfOneRobot):
    """See `MotionCaptureParameters`."""

    def __init__(self, world: SimulatedWorld, robot: str, how: MotionCaptureParameters, seed: int) -> None:
        super().__init__(world, robot, seed, 1)
        self._readings = Readings(how.rate_hz, how.drop_out, how.drop_out_s, self._random)
        misaligned = robot == how.robot
        self._offset = (how.ahead_m, how.left_m, math.radians(how.turn_deg)) if misaligned else (0.0, 0.0, 0.0)
        self._errors = np.array([how.position_m] * 3 + [how.heading_rad])
        self.deviations = np.maximum(self._errors, [_LEAST_M] * 3 + [_LEAST_RAD])

    def measured(self) -> Floats | None:
        """The pose (4,) that it measures now: x, y, z, heading; None without a reading."""
        if not self._readings.due(self._world.time_s):
            return None
        x, y, z, heading = self._pose
        ahead, left, turn = self._offset
        c, s = math.cos(heading), math.sin(heading)
        markers = np.array([x + c * ahead - s * left, y + s * ahead + c * left, z, heading + turn])
        markers += self._random.normal(0.0, self._errors)
        markers[3] = wrapped(markers[3])
        return markers

    def corrected(self, estimate: JointEstimate) -> JointEstimate:
        """See `PoseSensor`."""
        pose = self.measured()
        return estimate if pose is None else by_pose(estimate, pose, self.deviations).estimate


class Satellites(_OfOneRobot):
    """See `SatelliteParameters`."""

    def __init__(self, world: SimulatedWorld, robot: str, how: SatelliteParameters, seed: int) -> None:
        super().__init__(world, robot, seed, 2)
        self._readings = Readings(how.rate_hz, how.drop_out, how.drop_out_s, self._random)
        self._error_m = how.position_m

    def corrected(self, estimate: JointEstimate) -> JointEstimate:
        """See `PoseSensor`."""
        if not self._readings.due(self._world.time_s):
            return estimate
        place = self._pose[:3] + self._random.normal(0.0, self._error_m, 3)
        return by_position(estimate, place, [max(self._error_m, _LEAST_M)] * 3).estimate


class ToldPoses:
    """The noisy poses of a robot's own telemetry; none while it is silent."""

    def __init__(self, world: SimulatedWorld, robot: str) -> None:
        self._world, self._port = world, world.ports[robot]
        noise, is_in_space = world.noise, len(self._port.body.position) == 3
        position_m = max(noise.position_m, _LEAST_M)
        self.deviations = (
            position_m, position_m, position_m if is_in_space else _LEAST_M, max(noise.heading_rad, _LEAST_RAD)
        )  # fmt: skip
        self.fix: Fix | None = None
        """The last correction."""
        said = self._port.telemetry()
        assert said is not None  # a simulated robot has telemetry from the beginning
        self.start = np.array([*said.position, said.heading])
        """The first pose that was told."""

    def corrected(self, estimate: JointEstimate) -> JointEstimate:
        """See `PoseSensor`."""
        said = self._port.telemetry()
        if said is None or said.time_s < self._world.time_s - 1e-6:
            return estimate
        self.fix = by_pose(estimate, [*said.position, said.heading], self.deviations)
        return self.fix.estimate
