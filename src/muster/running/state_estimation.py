"""State estimation in simulated worlds: telemetry as it is, or fused by filters where robots err about their poses.

Filters run at the pace of the world, as those on board of a robot run at the pace of its sensors, whenever somebody
asks. They count with the world's own noise, as one does who knows the data sheets of his sensors.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping
from typing import Protocol

from muster.mission.model import Robot
from muster.motion.kinematics.registry import kinematics_named, limits_of
from muster.motion.port import RobotPort
from muster.perception.errors import AirErrors, GroundErrors
from muster.perception.pose_tracking import AirTracker, FusedPort, GroundTracker, Tracker
from muster.simulation import Noise, SimulatedWorld, WaypointPassed
from muster.simulation.port import SimulatedPort

LEAST_M, LEAST_RAD, LEAST_RADPS, LEAST_MPS = 0.001, 0.001, 0.001, 0.001
"""What robots err by in a filter's eyes where there is no noise: nothing is exact."""
LEAST_MPS2 = 0.02
SLIP_SHARE = 1 / 3
"""Of the greatest slip: what odometry errs by in a step, as slip is drawn evenly from 0."""


class RobotsInWorld(Protocol):
    """Robots' ports, and the time that goes by between what they say."""

    @property
    def ports(self) -> Mapping[str, RobotPort]:
        """By the robots' ids; those that join are in it as soon as they are in the world."""
        ...

    def advance(self, until_s: float) -> tuple[WaypointPassed, ...]:
        """As `SimulatedWorld.advance`."""
        ...


def with_state_estimation(world: SimulatedWorld) -> RobotsInWorld:
    """Where the world's noise leaves poses exact, the world itself; else with filters between."""
    return EstimatedWorld(world) if world.noise.of_pose else world


class EstimatedWorld:
    """A world whose telemetry passes through `FusedPort`s, which receive every step."""

    def __init__(self, world: SimulatedWorld) -> None:
        self._world = world
        self.ports = EstimatedPorts(world)
        self._listen()

    def advance(self, until_s: float) -> tuple[WaypointPassed, ...]:
        """See `SimulatedWorld`."""
        while self._world.time_s + self._world.dt_s <= until_s + 1e-6 * self._world.dt_s:
            passed = self._world.step()
            self._listen()
            if passed:
                return passed
        return ()

    def _listen(self) -> None:
        for port in self.ports.values():
            port.telemetry()


class EstimatedPorts(Mapping[str, FusedPort]):
    """Of all robots that are in the world, made as they come."""

    def __init__(self, world: SimulatedWorld) -> None:
        self._world = world
        self._fused: dict[str, FusedPort] = {}

    def __getitem__(self, robot: str) -> FusedPort:
        if robot not in self._fused:
            port = self._world.ports[robot]
            self._fused[robot] = FusedPort(port, tracker_of(port, self._world.noise, self._world.dt_s))
        return self._fused[robot]

    def __iter__(self) -> Iterator[str]:
        return iter(self._world.ports)

    def __len__(self) -> int:
        return len(self._world.ports)


def tracker_of(port: SimulatedPort, noise: Noise, dt_s: float) -> Tracker:
    """The filter of a robot that reports each `dt_s` seconds."""
    robot = port.body
    if kinematics_named(robot.kinematics).faces_its_way:
        return GroundTracker(ground_errors(robot, noise, dt_s))
    return AirTracker(air_errors(robot, noise, dt_s))


def ground_errors(robot: Robot, noise: Noise, dt_s: float) -> GroundErrors:
    """What a filter of a robot that faces its way counts with. Speeds may change by all that there is in a step."""
    share = max(noise.odometry, SLIP_SHARE * noise.slip)
    return GroundErrors(
        acceleration_mps2=robot.speed_mps / dt_s,
        yaw_acceleration_radps2=min(limits_of(robot).yaw_rate_radps, math.pi / dt_s) / dt_s,
        odometry_share=share,
        odometry_mps=LEAST_MPS,
        odometry_slip=max(0.02, noise.slip),
        gyro_radps=max(noise.gyro_radps, LEAST_RADPS),
        gyro_bias_radps=max(noise.gyro_bias_radps, LEAST_RADPS),
        position_m=max(noise.position_m, LEAST_M),
        heading_rad=max(noise.heading_rad, LEAST_RAD),
    )


def air_errors(robot: Robot, noise: Noise, dt_s: float) -> AirErrors:
    """The same of one that moves in any direction."""
    share = max(noise.odometry, SLIP_SHARE * noise.slip)
    return AirErrors(
        acceleration_mps2=math.hypot(max(noise.accelerometer_mps2, LEAST_MPS2), share * robot.speed_mps / dt_s),
        unfelt_mps2=robot.speed_mps,
        velocity_mps=math.hypot(LEAST_MPS, share * robot.speed_mps),
        odometry_slip=max(0.02, noise.slip),
        gyro_radps=max(noise.gyro_radps, LEAST_RADPS),
        gyro_bias_radps=max(noise.gyro_bias_radps, LEAST_RADPS),
        position_m=max(noise.position_m, LEAST_M),
        heading_rad=max(noise.heading_rad, LEAST_RAD),
    )
