"""Sensors of a simulated robot that see landmarks at known places: tags by its camera, cylinders by its laser.

What they see corrects an estimate of `perception.dead_reckoning`.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from muster.mission.model import Camera, Landmark, Robot, Tag
from muster.motion.frames import angles, wrapped
from muster.motion.grid import Floats
from muster.perception.camera import Intrinsics, View, mount_of_mission
from muster.perception.dead_reckoning import by_landmark, by_range_and_bearing
from muster.perception.geometric_detection import MIDDLE_SHARE, GroundTag, sightings_of
from muster.perception.ground_sightings import LevelCamera
from muster.perception.joint_estimate import HEADING, JointEstimate, X, Y, Z
from muster.perception.laser import Scanner
from muster.perception.spikes import SpikeParameters, landmarks
from muster.perception.tags import tag_pose
from muster.simulation.cameras import true_body
from muster.simulation.lasers import Laser
from muster.simulation.pose_sensors import Readings, SensorParameters
from muster.simulation.world import SimulatedWorld

_STREAM = 0x7A65
_RANGE_SHARE, _BEARING_SHARE = 0.5, 0.25
"""Of the error of a range, and of the angle between beams: how far the middle of a landmark is off in one scan."""
_LASTING_M = 0.001
"""What of the distance lasts while the robot stands, as the beams meet the landmark in the same places."""
_LEAST_PX = 0.05
"""Within which the middle of a tag is known at best."""
_SURE = 3.0
"""Standard deviations of the estimate by which what is seen may be off a landmark and be that landmark."""


@dataclass(frozen=True, kw_only=True)
class TagParameters(SensorParameters):
    """Tags of the mission as landmarks: `corner_px` is the standard deviation of each corner in the picture."""

    corner_px: float = 0.2


@dataclass(frozen=True, kw_only=True)
class LaserParameters(SensorParameters):
    """Cylinders of the mission's `landmarks`, found in scans by SPIKE.

    Parameters
    ----------
    rate_hz
        scans a second.
    range_m
        standard deviation of each range.
    depth_m
        by how much more what is behind a landmark is away.
    near_m
        how far from a landmark what is taken for it may be seen, beside what the pose may be off.
    """

    rate_hz: float = 10.0
    range_m: float = 0.01
    depth_m: float = 0.07
    near_m: float = 0.1


class TagCamera:
    """A robot's camera that knows where tags lie: [tcf-thesis] (2.7), solved for the robot."""

    def __init__(
        self,
        world: SimulatedWorld,
        robot: Robot,
        camera: Camera,
        tags: Sequence[Tag],
        how: TagParameters,
        seed: int,
    ) -> None:
        self._world, self._number = world, list(world.ports).index(robot.id)
        self._tags = [
            GroundTag(tag.id, tag_pose(tag.position, math.radians(tag.heading_deg)), tag.size_m) for tag in tags
        ]
        self._places = [(tag.id, np.array(tag.position[:2])) for tag in tags]
        fov = math.radians(camera.fov_deg)
        self._camera = LevelCamera(
            intrinsics=Intrinsics.of_view(camera.width_px, camera.height_px, fov),
            mount=mount_of_mission(camera),
            ground_m=world.ground_m,
            pixel_px=max(MIDDLE_SHARE * how.corner_px, _LEAST_PX),
        )
        self._corner_px = how.corner_px
        self._random = np.random.default_rng(np.random.SeedSequence((seed, self._number), spawn_key=(_STREAM,)))
        self._readings = Readings(camera.rate_hz, 0.0, 1.0, self._random)

    def corrected(self, estimate: JointEstimate) -> JointEstimate:
        """See `PoseSensor`."""
        if not self._readings.due(self._world.time_s):
            return estimate
        frame, axes = self._world.frames[self._number], self._world.axes[self._number]
        view = View.from_body(self._camera.intrinsics, true_body(frame, axes), self._camera.mount)
        sightings = sightings_of(self._tags, view, self._random, self._corner_px).all
        height = float(estimate.mean[Z] + frame[2] - self._world.positions[self._number, 2])
        roll, pitch = angles(axes)[:2] + self._random.normal(0.0, self._world.noise.attitude_rad, 2)
        estimate = estimate.with_new_picture(self._world.noise.attitude_rad)
        for tag, seen in self._camera.seen(sightings, height, roll, pitch):
            landmark = _nearest(_in_map(estimate, seen.place), [at for name, at in self._places if name == tag])
            estimate = by_landmark(estimate, landmark, seen).gated(estimate)
        return estimate


class LaserLandmarks:
    """A robot's laser that knows where some of the mission's cylinders stand, and sees all of them."""

    def __init__(
        self, world: SimulatedWorld, robot: str, cylinders: Sequence[Landmark], how: LaserParameters, seed: int
    ) -> None:
        self._world = world
        self._laser = Laser(world, robot, Scanner(range_m=how.range_m), seed=seed)
        self._places = [np.array(one.position[:2]) for one in cylinders if one.known]
        self._cylinders = np.array([(*one.position[:2], one.radius_m) for one in cylinders])
        there = self._cylinders
        radii = there[:, 2]
        self._search = SpikeParameters(
            depth_m=how.depth_m, smallest_m=0.5 * float(radii.min()), largest_m=1.6 * float(radii.max())
        )
        self._near_m = how.near_m
        self._readings = Readings(how.rate_hz, 0.0, 1.0, np.random.default_rng(seed))
        step = float(self._laser.bearings[1] - self._laser.bearings[0])
        self._step = step
        self._white = np.array([max(_RANGE_SHARE * how.range_m, 1e-3), _BEARING_SHARE * step])
        self._lasting = np.array([_LASTING_M, _BEARING_SHARE * step])
        self._looks: dict[tuple[float, ...], _Looks] = {}

    def corrected(self, estimate: JointEstimate) -> JointEstimate:
        """See `PoseSensor`."""
        if not self._readings.due(self._world.time_s):
            return estimate
        for mark in landmarks(self._laser.scan(self._cylinders), self._laser.bearings, self._search):
            place = _in_map(estimate, np.array(mark.position))
            known = _nearest(place, self._places)
            spread = float(np.hypot(*estimate.deviations[:2]) + mark.range_m * estimate.deviations[HEADING])
            if math.dist(place, known) <= self._near_m + _SURE * spread:
                deviations = self._deviations(estimate, known)
                seen = by_range_and_bearing(estimate, known, mark.range_m, mark.bearing_rad, deviations)
                estimate = seen.gated(estimate)
        return estimate

    def _deviations(self, estimate: JointEstimate, known: Floats) -> tuple[float, float]:
        """What a sighting counts for: from one place those of one landmark share what lasts of their errors.

        The information of k of them is 1 / (B + W / k), with the variances B of what lasts and W of what does not;
        here it is what the last of them adds to that.
        """
        looks, pose = self._looks.get(tuple(known)), estimate.mean[[X, Y, HEADING]]
        if looks is None or looks.is_elsewhere(pose, self._step):
            looks = self._looks[tuple(known)] = _Looks(pose)
        looks.count += 1
        white, lasting = self._white**2, self._lasting**2
        variances = (looks.count * lasting + white) * ((looks.count - 1) * lasting + white) / white
        range_m, bearing_rad = np.sqrt(variances).tolist()
        return range_m, bearing_rad


@dataclass
class _Looks:
    """How often a landmark was seen from about one pose (3,): x, y, heading."""

    pose: Floats
    count: int = 0

    def is_elsewhere(self, pose: Floats, beam_rad: float) -> bool:
        """Whether beams meet the landmark otherwise by now."""
        turned = abs(float(wrapped(pose[2] - self.pose[2])))
        return math.dist(pose[:2], self.pose[:2]) > _LASTING_M * 10 or turned > beam_rad


def _in_map(estimate: JointEstimate, place: Floats) -> Floats:
    """A place (2,) of the robot's level axes in the map, by its estimated pose."""
    c, s = math.cos(estimate.mean[HEADING]), math.sin(estimate.mean[HEADING])
    return np.asarray(estimate.mean[:2] + np.array([[c, -s], [s, c]]) @ place)


def _nearest(place: Floats, known: Sequence[Floats]) -> Floats:
    return min(known, key=lambda one: math.dist(place, one))
