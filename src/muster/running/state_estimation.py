"""State estimation in simulated worlds: what robots take for their poses, in telemetry and for steering.

Where robots err about their poses they go by what they know: an estimate from their sensors, updated in each step of
the world. `localisation` makes it of sensors that a user names, `pose_tracking` of noisy poses in telemetry. Filters
count with the world's own noise, as one does who knows the data sheets of his sensors.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping, Sequence
from typing import Protocol

import numpy as np

from muster.mission.errors import ParameterError
from muster.mission.model import Mission, Robot
from muster.mission.texts.near_matches import did_you_mean
from muster.mission.value_types import shown
from muster.motion.kinematics.registry import kinematics_named, limits_of
from muster.motion.port import RobotPort, Telemetry, Waypoint
from muster.perception.errors import AirErrors, GroundErrors
from muster.perception.pose_tracking import AirTracker, FusedPort, GroundTracker, Tracker
from muster.running.localisation import (
    INERTIAL,
    ODOMETRY,
    Localisation,
    Localise,
    PoseEstimate,
    require_possible,
    sensors_of,
)
from muster.running.run_request import ESTIMATE, POSES
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


def with_state_estimation(
    world: SimulatedWorld,
    mission: Mission,
    *,
    pose: str | None = None,
    localise: Localise | None = None,
    seed: int = 0,
) -> RobotsInWorld:
    """The world itself where robots steer by their true poses and tell them; else with estimates between.

    Parameters
    ----------
    pose
        `true` or `estimate`; None: `estimate` where sensors are named, or noise makes estimates differ from the truth.
    localise
        sensors, as `localisation.sensors_of` takes them; None: noisy poses in telemetry where the noise has any, else
        odometry, with the gyro where the noise has it.

    Raises
    ------
    ParameterError
        if `pose` is neither, or the sensors are unknown or not possible in this mission.
    """
    if pose is not None and pose not in POSES:
        raise ParameterError(f"pose: {shown(pose)}; expected {', '.join(POSES)}{did_you_mean(str(pose), POSES)}")
    noise = world.noise
    steered = pose == ESTIMATE or (pose is None and (noise.of_pose or noise.of_odometry or bool(localise)))
    if not localise:
        if not steered and not noise.of_pose:
            return world
        if noise.of_pose:
            return EstimatedWorld(world, FusedPorts(world), steered=steered)
        localise = (ODOMETRY, INERTIAL) if noise.of_gyro else (ODOMETRY,)
    sensors = sensors_of(localise)
    require_possible(sensors, mission)
    return EstimatedWorld(world, LocalisedPorts(world, Localisation(sensors, mission, seed)), steered=steered)


class EstimatingPort(RobotPort, Protocol):
    """A robot's port with an estimate of its pose."""

    def believed(self, now: float) -> tuple[tuple[float, float, float, float], float] | None:
        """The pose that the robot takes for its own now, and a standard deviation in metres; None: it knows none."""
        ...


class EstimatedWorld:
    """A world in which robots estimate their poses in every step, and steer by that if they are `steered` by it."""

    def __init__(self, world: SimulatedWorld, ports: Mapping[str, EstimatingPort], *, steered: bool) -> None:
        self._world, self._steered = world, steered
        self.ports = ports
        self._off: dict[str, list[float]] = {}
        self._listen()

    def advance(self, until_s: float) -> tuple[WaypointPassed, ...]:
        """See `SimulatedWorld`."""
        while self._world.time_s + self._world.dt_s <= until_s + 1e-6 * self._world.dt_s:
            passed = self._world.step()
            self._listen()
            if passed:
                return passed
        return ()

    @property
    def remark(self) -> str:
        """For the report: by how much robots were off where they took themselves to be."""
        most = {robot: max(off) for robot, off in self._off.items()}
        worst = max(most, key=lambda robot: most[robot])
        mean = float(np.mean(np.concatenate(list(self._off.values()))))
        end = max(off[-1] for off in self._off.values())
        steering = "steered by their estimated poses" if self._steered else "steered by their true poses"
        return (
            f"robots {steering}; estimates were {mean:.4f} m off in the mean, {most[worst]:.4f} m at most ({worst}), "
            f"{end:.4f} m at most at the end"
        )

    def _listen(self) -> None:
        truth = self._world.positions
        for number, (robot, port) in enumerate(self.ports.items()):
            believed = port.believed(self._world.time_s)
            if believed is None:
                continue
            pose, spread_m = believed
            self._off.setdefault(robot, []).append(math.dist(pose[:3], truth[number]))
            if self._steered:
                self._world.believe(robot, np.array(pose), spread_m)


class FusedPorts(Mapping[str, "FusedEstimate"]):
    """Of all robots that are in the world, made as they come; noisy poses in telemetry are fused with odometry."""

    def __init__(self, world: SimulatedWorld) -> None:
        self._world = world
        self._fused: dict[str, FusedEstimate] = {}

    def __getitem__(self, robot: str) -> FusedEstimate:
        if robot not in self._fused:
            port = self._world.ports[robot]
            self._fused[robot] = FusedEstimate(port, tracker_of(port, self._world.noise, self._world.dt_s))
        return self._fused[robot]

    def __iter__(self) -> Iterator[str]:
        return iter(self._world.ports)

    def __len__(self) -> int:
        return len(self._world.ports)


class FusedEstimate(FusedPort):
    """See `EstimatingPort`; a silent robot's filter rests."""

    def believed(self, now: float) -> tuple[tuple[float, float, float, float], float] | None:
        """See `EstimatingPort`."""
        said = self.telemetry()
        if said is None or said.time_s < now - 1e-6 or self.tracker.estimate is None:
            return None
        spread_m = float(np.sqrt(self.tracker.estimate.covariance[[0, 1], [0, 1]].mean()))
        return (*said.position, said.heading), spread_m


class LocalisedPorts(Mapping[str, "LocalisedPort"]):
    """Of all robots that are in the world, made as they come; each localises itself by its sensors."""

    def __init__(self, world: SimulatedWorld, localisation: Localisation) -> None:
        self._world, self._localisation = world, localisation
        self._localised: dict[str, LocalisedPort] = {}

    def __getitem__(self, robot: str) -> LocalisedPort:
        if robot not in self._localised:
            estimate = self._localisation.of(self._world, robot)
            self._localised[robot] = LocalisedPort(self._world.ports[robot], estimate, self._world.time_s)
        return self._localised[robot]

    def __iter__(self) -> Iterator[str]:
        return iter(self._world.ports)

    def __len__(self) -> int:
        return len(self._world.ports)


class LocalisedPort:
    """See `EstimatingPort`; a silent robot goes on estimating, and nobody hears of it."""

    def __init__(self, port: SimulatedPort, estimate: PoseEstimate, now: float) -> None:
        self._port, self.estimate, self._updated_s = port, estimate, now
        self._last = self._now()

    @property
    def robot(self) -> str:
        """See `RobotPort`."""
        return self._port.robot

    def send(self, waypoints: Sequence[Waypoint]) -> int:
        """See `RobotPort`."""
        return self._port.send(waypoints)

    def cancel(self) -> int:
        """See `RobotPort`."""
        return self._port.cancel()

    def telemetry(self) -> Telemetry | None:
        """See `RobotPort`."""
        return self._now()

    def believed(self, now: float) -> tuple[tuple[float, float, float, float], float] | None:
        """See `EstimatingPort`."""
        if now > self._updated_s + 1e-6:
            self.estimate.update()
            self._updated_s = now
        x, y, z, heading = map(float, self.estimate.pose)
        return (x, y, z, heading), self.estimate.spread_m

    def _now(self) -> Telemetry | None:
        """A silent robot's telemetry keeps its time."""
        said = self._port.telemetry()
        if said is not None and said.time_s >= self._updated_s - 1e-6:
            self._last = self.estimate.told(said)
        return self._last


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
