"""State estimation in simulated worlds: what robots take for their poses, in telemetry and for steering.

Where robots err about their poses they go by what they know: an estimate from their sensors, updated in each step of
the world. `localisation` makes it of sensors that a user names, or of noisy poses in telemetry. Filters count with the
world's own noise, as one does who knows the data sheets of his sensors (`reckoning_noise`).
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping, Sequence
from typing import Protocol

import numpy as np

from muster.mission.errors import ParameterError
from muster.mission.model import Mission
from muster.mission.texts.near_matches import did_you_mean
from muster.mission.value_types import shown
from muster.motion.port import RobotPort, Telemetry, Waypoint
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
from muster.simulation import SimulatedWorld, WaypointPassed
from muster.simulation.port import SimulatedPort


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
        sensors, as `localisation.sensors_of` takes them; None: odometry, with the gyro where the noise has it, and
        with the gyro and the noisy poses of telemetry where the noise has those.

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
        is_inertial = noise.of_gyro or noise.of_pose
        sensors = sensors_of((ODOMETRY, INERTIAL) if is_inertial else (ODOMETRY,))
        localisation = Localisation(sensors, mission, seed, told=noise.of_pose)
    else:
        sensors = sensors_of(localise)
        require_possible(sensors, mission)
        localisation = Localisation(sensors, mission, seed)
    return EstimatedWorld(world, LocalisedPorts(world, localisation), steered=steered)


class EstimatedWorld:
    """A world in which robots estimate their poses in every step, and steer by that if they are `steered` by it."""

    def __init__(self, world: SimulatedWorld, ports: LocalisedPorts, *, steered: bool) -> None:
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
            estimate = port.updated(self._world.time_s)
            self._off.setdefault(robot, []).append(math.dist(estimate.pose[:3], truth[number]))
            if self._steered:
                self._world.believe(robot, estimate.pose, estimate.spread_m)


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
    """A robot's port with an estimate of its pose; a silent robot goes on estimating, and nobody hears of it."""

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

    def updated(self, now: float) -> PoseEstimate:
        """Return the estimate, with what sensors measured until now."""
        if now > self._updated_s + 1e-6:
            self.estimate.update()
            self._updated_s = now
        return self.estimate

    def _now(self) -> Telemetry | None:
        """A silent robot's telemetry keeps its time."""
        said = self._port.telemetry()
        if said is not None and said.time_s >= self._updated_s - 1e-6:
            self._last = self.estimate.told(said)
        return self._last
