"""How robots of a simulated world localise themselves: by which sensors, with which errors; the estimate of each robot.

`odometry` is integrated from the start, with the gyro of `inertial` if that is given, and corrected by the others.
Motion capture without odometry is taken as it is, as the thesis' real robots do.
"""

from __future__ import annotations

import math
from abc import ABC, abstractmethod
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, fields, replace

import numpy as np

from muster.mission.errors import ParameterError
from muster.mission.model import Mission, Robot
from muster.mission.texts.near_matches import did_you_mean
from muster.mission.value_types import shown
from muster.motion.grid import Floats
from muster.motion.map_world import Body, World, body_of
from muster.motion.port import Telemetry
from muster.perception import dead_reckoning
from muster.perception.errors import ReckoningErrors
from muster.perception.joint_estimate import JointEstimate
from muster.running.reckoning_noise import reckoning_errors
from muster.simulation import SimulatedWorld
from muster.simulation.landmark_sensors import LaserLandmarks, LaserParameters, TagCamera, TagParameters
from muster.simulation.map_scans import MapScanParameters, MapScans, ScannedMap
from muster.simulation.pose_sensors import (
    MotionCapture,
    MotionCaptureParameters,
    PoseSensor,
    SatelliteParameters,
    Satellites,
    SensorParameters,
    ToldPoses,
)

ODOMETRY, INERTIAL, TAGS, LASERS, SCANS, MOTION_CAPTURE, GPS, RTK = (
    "odometry",
    "inertial",
    "tags",
    "lasers",
    "scans",
    "motion-capture",
    "gps",
    "rtk",
)
SENSORS: Mapping[str, SensorParameters] = {
    ODOMETRY: SensorParameters(),
    INERTIAL: SensorParameters(),
    TAGS: TagParameters(),
    LASERS: LaserParameters(),
    SCANS: MapScanParameters(),
    MOTION_CAPTURE: MotionCaptureParameters(),
    GPS: SatelliteParameters(),
    RTK: SatelliteParameters(rate_hz=5.0, position_m=0.02),
}
"""Sensors by name, with their parameters by default. Errors of odometry and gyro are those of the world's noise."""

Localise = str | Sequence[str] | Mapping[str, Mapping[str, float | str]]
"""Sensors as a user names them: names, or names with parameters that differ from the default."""

START_M, START_RAD = 0.001, 0.001
"""Within which robots know their poses at the beginning: standard deviations."""
LEAST_M, LEAST_RAD = 1e-4, 1e-4
"""The same of poses that are exact."""


def sensors_of(localise: Localise) -> Mapping[str, SensorParameters]:
    """The sensors that a user names, with all parameters.

    Raises
    ------
    ParameterError
        for an unknown sensor or parameter, a value out of range, or sensors that are not enough for a pose.
    """
    if isinstance(localise, str):
        localise = [name for name in localise.split(",") if name]
    given = localise if isinstance(localise, Mapping) else {name: {} for name in localise}
    found = {name: _parameters(name, changes) for name, changes in given.items()}
    if ODOMETRY not in found and set(found) != {MOTION_CAPTURE}:
        names = ", ".join(found) or "nothing"
        raise ParameterError(f"localise: {names}; expected odometry among them, or motion-capture alone")
    return found


def _parameters(name: str, changes: Mapping[str, float | str]) -> SensorParameters:
    if name not in SENSORS:
        raise ParameterError(f"localise: {shown(name)}; expected {', '.join(SENSORS)}{did_you_mean(name, SENSORS)}")
    default = SENSORS[name]
    if not isinstance(changes, Mapping):
        raise ParameterError(f"localise: {name}: {shown(changes)}; expected a mapping of parameters")
    kinds = {one.name: type(getattr(default, one.name)) for one in fields(default)}
    values: dict[str, float | str] = {}
    for key, value in changes.items():
        if key not in kinds:
            expected = ", ".join(kinds) or "none"
            raise ParameterError(f"localise: {name}: {key}; expected {expected}{did_you_mean(key, kinds)}")
        values[key] = _value(name, key, value, kinds[key])
    return replace(default, **values)


def _value(name: str, key: str, value: float | str, kind: type) -> float | str:
    if kind is str:
        if not isinstance(value, str):
            raise ParameterError(f"localise: {name}: {key}: {shown(value)}; expected the id of a robot")
        return value
    try:
        number = math.nan if isinstance(value, bool) else float(value)
    except (TypeError, ValueError):
        number = math.nan
    if math.isnan(number):
        raise ParameterError(f"localise: {name}: {key}: {shown(value)}; expected a number")
    return number


def require_possible(sensors: Mapping[str, SensorParameters], mission: Mission) -> None:
    """Raise ParameterError if a mission does not have what sensors look for."""
    if TAGS in sensors and (not mission.tags or all(robot.camera is None for robot in mission.robots)):
        raise ParameterError(
            f"localise: tags in mission {mission.name}; expected a mission with tags, and a robot with a camera"
        )
    if LASERS in sensors and not any(landmark.known for landmark in mission.landmarks):
        raise ParameterError(f"localise: lasers in mission {mission.name}; expected a mission with known landmarks")
    if SCANS in sensors and (mission.map is None or mission.travel_off_lanes != "map"):
        raise ParameterError(f"localise: scans in mission {mission.name}; expected a mission that travels by its map")
    capture = sensors.get(MOTION_CAPTURE)
    if isinstance(capture, MotionCaptureParameters) and capture.robot:
        robots = [robot.id for robot in mission.robots]
        if capture.robot not in robots:
            hint = did_you_mean(capture.robot, robots)
            raise ParameterError(f"localise: motion-capture: robot: {capture.robot}; expected one of the mission{hint}")


@dataclass(frozen=True)
class Localisation:
    """The sensors of all robots of a mission; with `told` the noisy poses of telemetry correct odometry, too."""

    sensors: Mapping[str, SensorParameters]
    mission: Mission
    seed: int
    told: bool = False
    _maps: dict[Body, ScannedMap] = field(default_factory=dict, init=False, repr=False, compare=False)

    def of(self, world: SimulatedWorld, robot: str) -> PoseEstimate:
        """The estimate of one robot that is in the world."""
        capture = self.sensors.get(MOTION_CAPTURE)
        if ODOMETRY not in self.sensors:
            assert isinstance(capture, MotionCaptureParameters)  # as `sensors_of` requires
            return CapturedPose(world, robot, MotionCapture(world, robot, capture, self.seed))
        body = world.ports[robot].body
        others = [self._made(how, world, body) for how in self.sensors.values()]
        correcting = [sensor for sensor in others if sensor is not None]
        told = ToldPoses(world, robot) if self.told else None
        return ReckonedPose(world, robot, correcting, told, inertial=INERTIAL in self.sensors)

    def _made(self, how: SensorParameters, world: SimulatedWorld, robot: Robot) -> PoseSensor | None:
        if isinstance(how, MotionCaptureParameters):
            return MotionCapture(world, robot.id, how, self.seed)
        if isinstance(how, SatelliteParameters):
            return Satellites(world, robot.id, how, self.seed)
        if isinstance(how, LaserParameters):
            return LaserLandmarks(world, robot.id, self.mission.landmarks, how, self.seed)
        if isinstance(how, MapScanParameters):
            return MapScans(world, robot.id, self._map_of(robot), how, reckoning_errors(robot, world), self.seed)
        if isinstance(how, TagParameters) and robot.camera is not None:
            return TagCamera(world, robot, robot.camera, self.mission.tags, how, self.seed)
        return None

    def _map_of(self, robot: Robot) -> ScannedMap:
        body = body_of(robot)
        if body not in self._maps:
            self._maps[body] = ScannedMap.of(World.of(self.mission), body)
        return self._maps[body]


class PoseEstimate(ABC):
    """Where one robot takes itself to be; `update` once after each step of the world."""

    def __init__(self, world: SimulatedWorld, robot: str) -> None:
        self._world, self._port = world, world.ports[robot]
        self._number = list(world.ports).index(robot)
        self.pose = np.array([*world.positions[self._number], world.headings[self._number]])
        """(4,): x, y, z in metres, heading in radians."""
        self.spread_m = START_M
        """A standard deviation of each coordinate of the place in the plane."""

    @abstractmethod
    def update(self) -> None:
        """Take in what sensors measured in the last step."""

    @abstractmethod
    def looking(self) -> JointEstimate:
        """The estimate now, with all marks that were learned."""

    @abstractmethod
    def learn(self, estimate: JointEstimate) -> None:
        """Take over an estimate with what was seen."""

    def told(self, said: Telemetry) -> Telemetry:
        """Telemetry with the estimated pose, and the velocity by odometry in its axes."""
        counted = self._port.odometry()
        heading = float(self.pose[3])
        amid = heading - counted.turned_rad / 2
        ahead, left, up = (metres / counted.seconds for metres in counted.way_m)
        c, s = math.cos(amid), math.sin(amid)
        x, y, z = map(float, self.pose[:3])
        velocity = (c * ahead - s * left, s * ahead + c * left, up)
        return replace(said, position=(x, y, z), heading=heading, velocity=velocity)


class ReckonedPose(PoseEstimate):
    """Dead reckoning from where the robot truly starts, and what corrects it.

    With noisy poses that are `told`, it begins with the first of these.
    """

    def __init__(
        self,
        world: SimulatedWorld,
        robot: str,
        correcting: Sequence[PoseSensor],
        told: ToldPoses | None = None,
        *,
        inertial: bool,
    ) -> None:
        super().__init__(world, robot)
        self._correcting, self._inertial, self.told_poses = [*correcting, *([told] if told else [])], inertial, told
        self._errors = reckoning_errors(self._port.body, world)
        start, spread = self.pose, np.array([START_M, START_M, START_M, START_RAD])
        if told is not None:
            start, spread = told.start, np.array(told.deviations)
        self.estimate: JointEstimate = dead_reckoning.standing_at(start, spread, self._errors)
        if told is None:
            self._correct()
        self._take_pose()

    def update(self) -> None:
        """See `PoseEstimate`."""
        felt = self._port.inertial() if self._inertial else None
        turning = None if felt is None else felt.turning_radps
        self.estimate = dead_reckoning.moved(self.estimate, self._port.odometry(), self._errors, turning)
        self._correct()

    def looking(self) -> JointEstimate:
        """See `PoseEstimate`."""
        return self.estimate

    def learn(self, estimate: JointEstimate) -> None:
        """See `PoseEstimate`."""
        self.estimate = estimate
        self._take_pose()

    def _correct(self) -> None:
        for sensor in self._correcting:
            self.estimate = sensor.corrected(self.estimate)
        self._take_pose()

    def _take_pose(self) -> None:
        self.pose = self.estimate.mean[:4]
        self.spread_m = math.sqrt(float(np.square(self.estimate.deviations[:2]).mean()))


class GivenPose(PoseEstimate):
    """The true pose: of a robot that does not err about it."""

    deviations: Floats = np.array([LEAST_M, LEAST_M, LEAST_M, LEAST_RAD])

    def __init__(self, world: SimulatedWorld, robot: str) -> None:
        super().__init__(world, robot)
        self._estimate = dead_reckoning.standing_at(self.pose, self.deviations, ReckoningErrors())

    def update(self) -> None:
        """See `PoseEstimate`."""
        self.pose = self._last()

    def _last(self) -> Floats:
        return np.array([*self._world.positions[self._number], self._world.headings[self._number]])

    def looking(self) -> JointEstimate:
        """See `PoseEstimate`; what the pose errs by is new each time."""
        return self._estimate.with_pose(self._last(), self.deviations)

    def learn(self, estimate: JointEstimate) -> None:
        """See `PoseEstimate`; a pose that is given is not corrected."""
        self._estimate = estimate


class CapturedPose(GivenPose):
    """What motion capture measured last."""

    def __init__(self, world: SimulatedWorld, robot: str, capture: MotionCapture) -> None:
        super().__init__(world, robot)
        self._capture, self.deviations = capture, capture.deviations
        self.spread_m = float(capture.deviations[0])
        self.update()

    def update(self) -> None:
        """See `PoseEstimate`."""
        measured = self._capture.measured()
        if measured is not None:
            self.pose = measured

    def _last(self) -> Floats:
        return self.pose
