"""What real robots' cameras and lasers show, and the tasks that follow: target_localization of [tcf-thesis], 5.3.2.

Sans I/O: a bridge tells it poses, images and scans with the stamps that they carry, and it answers with what follows.
An image counts at the pose that its robot had when it was taken: poses are interpolated between their stamps.
"""

from __future__ import annotations

import math
import threading
from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any, Literal

import numpy as np

from muster.mission.errors import ParameterError, TransformError
from muster.mission.mission_parts import positions
from muster.mission.model import Event, Mission, Robot
from muster.motion.frames import Floats
from muster.motion.transform_tree import TransformTree
from muster.perception.camera import Intrinsics, mount_of_mission
from muster.perception.camera_observer import CameraObserver
from muster.perception.cameras.images import Image
from muster.perception.detection import TagDetector
from muster.perception.estimates import RawEstimates
from muster.perception.found_tasks import FoundTasks
from muster.perception.localisation import Uncertainty
from muster.perception.point_search import FoundCriteria, FoundPoint, PointSearch
from muster.perception.points_of_interest import radius_95
from muster.perception.scan_obstacles import seen_on_map

Locate = Literal["ground", "size"]
_MAP = "map"
_NEAR_S = 0.2
"""An image that is newer than the last pose by no more than this counts at that pose."""


@dataclass(frozen=True, kw_only=True)
class SearchSettings:
    """How targets are found.

    Parameters
    ----------
    locate
        `ground`: a tag is where its ray meets the ground; `size`: by its known size, wherever it hangs.
    tag_size_m
        the side of a tag's black square, for `size`, of tags that the mission does not list.
    position_m, angle_rad
        standard deviations of the poses that robots report.
    calibrations
        intrinsics of robots' cameras, in place of those that their messages carry.
    criteria
        when a point counts as found.

    Raises
    ------
    ParameterError
        if a number is out of range.
    """

    locate: Locate = "ground"
    tag_size_m: float | None = None
    position_m: float = 0.03
    angle_rad: float = 0.02
    calibrations: Mapping[str, Intrinsics] = field(default_factory=dict)
    criteria: FoundCriteria = FoundCriteria()

    def __post_init__(self) -> None:
        if self.locate not in ("ground", "size"):
            raise ParameterError(f"locate: {self.locate}; expected ground or size")
        if self.tag_size_m is not None and not 0 < self.tag_size_m < math.inf:
            raise ParameterError(f"tag_size_m: {self.tag_size_m}; expected metres above 0")


@dataclass(frozen=True)
class ImageResult:
    """What follows from an image: estimates on the map, points that are newly found or moved, and remarks."""

    estimates: RawEstimates
    finds: tuple[tuple[FoundPoint, Event | None], ...] = ()
    remarks: tuple[str, ...] = ()

    @property
    def rows(self) -> list[dict[str, Any]]:
        """The estimates as plain data."""
        raw = self.estimates
        assert raw.covariances is not None
        return [
            {"tag": tag, "position": position, "covariance": covariance, "stamp_s": stamp}
            for tag, position, covariance, stamp in zip(
                raw.tags.tolist(),
                raw.positions.round(4).tolist(),
                raw.covariances.tolist(),
                raw.times_s.tolist(),
                strict=True,
            )
        ]


class TargetSearch:
    """The search of a team for one mission.

    Parameters
    ----------
    mission
        its robots have cameras, its `found` says what becomes of what they see.
    detector
        looks for tags in images.
    """

    def __init__(self, mission: Mission, detector: TagDetector, settings: SearchSettings | None = None) -> None:
        self._robots = {robot.id: robot for robot in mission.robots}
        self._detector, self._settings = detector, settings or SearchSettings()
        self._ground_m = ground_of(mission)
        self._tasks = FoundTasks(mission, self._ground_m)
        self._search = PointSearch(self._settings.criteria)
        self._lock = threading.Lock()  # of poses
        self._poses = TransformTree()
        self._last: dict[str, tuple[float, Floats]] = {}
        self._intrinsics = dict(self._settings.calibrations)
        known = {tag.id: tag.size_m for tag in mission.tags}
        size = self._settings.tag_size_m
        every: Mapping[int, float] = known if size is None else {**dict.fromkeys(range(_TAGS), size), **known}
        self._sizes = every if self._settings.locate == "size" else None

    @property
    def cameras(self) -> tuple[str, ...]:
        """The robots with cameras."""
        return tuple(robot.id for robot in self._robots.values() if robot.camera is not None)

    @property
    def points(self) -> list[dict[str, Any]]:
        """What was found so far, as plain data: positions with covariances, and tasks."""
        return [_row(find, self._tasks.task(find)) for find in self._search.finds]

    def hear_pose(self, robot: str, stamp: float, pose: Floats) -> None:
        """Take the pose (4, 4) of a robot's body in the map at a time, seconds; from any thread."""
        with self._lock:
            if robot in self._last and stamp < self._last[robot][0] - _BACK_S:  # a clock that was set back
                self._poses, self._last = TransformTree(), {}
            self._poses.set_transform(_MAP, robot, stamp, pose)
            self._last[robot] = (stamp, pose)

    def hear_intrinsics(self, robot: str, intrinsics: Intrinsics) -> None:
        """Take a camera's intrinsics; those of the settings come before them."""
        if robot not in self._settings.calibrations:
            self._intrinsics[robot] = intrinsics

    def hear_image(self, robot: str, stamp: float, image: Image) -> ImageResult:
        """Look for tags in an image that a robot took at a time, seconds."""
        nothing, its = RawEstimates.joined([]), self._robots.get(robot)
        if its is None or its.camera is None:
            return ImageResult(nothing, remarks=(f"{robot}: an image; expected a camera of it in the mission",))
        pose, intrinsics = self.pose_at(robot, stamp), self._intrinsics.get(robot)
        if intrinsics is None:
            return ImageResult(nothing, remarks=(f"{robot}: no camera_info; expected the camera's intrinsics",))
        if pose is None:
            return ImageResult(nothing, remarks=(f"{robot}: no pose of the time of an image; expected one",))
        seen = self._observer(its, intrinsics).look(image, pose, stamp)
        news = self._search.take(seen.estimates, stamp)
        finds = tuple((find, self._tasks.event(find, stamp)) for find in news)
        return ImageResult(seen.estimates, finds, seen.remarks)

    def hear_scan(self, robot: str, scanner: Floats, ranges: Floats, bearings: Floats) -> dict[str, Any]:
        """The obstacles and landmarks of a scan, on the map; `scanner` is the scanner's pose (4, 4) there."""
        its = self._robots.get(robot)
        return seen_on_map(ranges, bearings, scanner, margin_m=0.0 if its is None else its.radius_m)

    def refused(self, task: str) -> None:
        """What was found did not become this task after all."""
        self._tasks.refused(task)

    def pose_at(self, robot: str, stamp: float) -> Floats | None:
        """The pose (4, 4) of a robot's body in the map at a time; None if it is not known."""
        with self._lock:
            last_s, last = self._last.get(robot, (math.inf, None))
            if last is None or last_s < stamp <= last_s + _NEAR_S:
                return last
            try:
                return self._poses.lookup(_MAP, robot, stamp)
            except TransformError:
                return None

    def _observer(self, robot: Robot, intrinsics: Intrinsics) -> CameraObserver:
        assert robot.camera is not None
        errors = Uncertainty(position_m=self._settings.position_m, angle_rad=self._settings.angle_rad)
        return CameraObserver(
            robot=robot.id,
            intrinsics=intrinsics,
            mount=mount_of_mission(robot.camera),
            detector=self._detector,
            uncertainty=errors,
            ground_m=self._ground_m,
            sizes_m=self._sizes,
        )


_TAGS = 587
"""Ids of the family 36h11."""
_BACK_S = 1.0


def ground_of(mission: Mission) -> float:
    """The height of the ground: 0, or the lowest place of a mission in space."""
    return min([0.0, *(place[2] for _, place in positions(mission) if len(place) == 3)])


def _row(find: FoundPoint, task: str | None) -> dict[str, Any]:
    point = find.point
    return {
        "tag": find.tag,
        "number": find.number,
        "position": [round(float(c), 4) for c in point.position],
        "covariance": [[float(c) for c in row] for row in point.covariance],
        "deviation_m": round(math.sqrt(float(np.linalg.eigvalsh(point.covariance)[-1])), 4),
        "sure_to_m": round(radius_95(point.covariance[:2, :2]), 4),
        "sightings": point.sightings,
        "robots": list(point.robots),
        "found_s": find.at_s,
        "task": task,
    }
