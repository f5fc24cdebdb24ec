"""target_localization of [tcf-thesis], section 5.3.2, on ROS 2: what robots' cameras and lasers show, and the tasks.

It is part of `muster ros2` and polled with the fleet. It publishes JSON in std_msgs/String: all points found on
`/target_localization/points`, what an image shows on `<robot>/tags`, what a scan shows on `<robot>/obstacles`.
"""

from __future__ import annotations

import json
import logging
from collections.abc import Callable, Mapping
from functools import partial
from typing import Any

from muster.mission.errors import ParameterError
from muster.mission.model import Event, Mission
from muster.perception.detection import TagDetector
from muster_robots.ros2.body_poses import BodyPoses
from muster_robots.ros2.message_types import String
from muster_robots.ros2.middleware import Middleware
from muster_robots.ros2.sensor_conversion import image_from, intrinsics_from, scan_from, stamp_of
from muster_robots.ros2.sensor_message_types import CameraInfo, Image, LaserScan
from muster_robots.target_search import SearchSettings, TargetSearch

_log = logging.getLogger(__name__)


class Ros2TargetLocalization:
    """The search of a team.

    Parameters
    ----------
    topics
        the namespaces of the robots' topics, by their ids.

    Raises
    ------
    MissingExtraError
        if the extra `physics`, of which the detector is, is not installed.
    """

    def __init__(
        self, mission: Mission, middleware: Middleware, topics: Mapping[str, str], settings: SearchSettings
    ) -> None:
        self._search = TargetSearch(mission, TagDetector(), settings)
        self._points = middleware.writer("/target_localization/points", String)
        self._robots = [
            _Sensors(robot, own, middleware, camera=robot in self._search.cameras) for robot, own in topics.items()
        ]
        self._warned: set[str] = set()

    def look(self) -> list[Event]:
        """Take in what has come; returns new tasks, and those that lie elsewhere, with times of the robots' clocks."""
        events = []
        for sensors in self._robots:
            for stamp, pose in sensors.poses.take():
                self._search.hear_pose(sensors.robot, stamp, pose)
            heard = [
                *(partial(self._take_info, sensors, info) for info in sensors.infos()),
                *(partial(self._take_image, sensors, image) for image in sensors.images()),
                *(partial(self._take_scan, sensors, scan) for scan in sensors.scans.take()[-1:]),
            ]
            events += [event for take in heard for event in self._try(sensors.robot, take)]
        return events

    def _take_info(self, sensors: _Sensors, info: CameraInfo) -> list[Event]:
        self._search.hear_intrinsics(sensors.robot, intrinsics_from(info))
        return []

    def _take_image(self, sensors: _Sensors, image: Image) -> list[Event]:
        result = self._search.hear_image(sensors.robot, stamp_of(image.header), image_from(image))
        for remark in result.remarks:
            self._warn(remark)
        if len(result.estimates):
            sensors.tags.write(_text(result.rows))
        if result.finds:
            self._points.write(_text(self._search.points))
        return [event for _, event in result.finds if event is not None]

    def _take_scan(self, sensors: _Sensors, scan: LaserScan) -> list[Event]:
        stamp = stamp_of(scan.header)
        body = self._search.pose_at(sensors.robot, stamp)
        if body is not None:
            seen = self._search.hear_scan(sensors.robot, body, *scan_from(scan))
            sensors.obstacles.write(_text({"stamp_s": stamp, **seen}))
        return []

    def _try(self, robot: str, take: Callable[[], list[Event]]) -> list[Event]:
        """A message that is wrong is left out, with a warning."""
        try:
            return take()
        except ParameterError as error:
            self._warn(f"{robot}: {error}")
            return []

    def _warn(self, remark: str) -> None:
        """Once for each kind: what is so in one image is so in many."""
        kind = remark.partition(": ")[2]
        if kind not in self._warned:
            self._warned.add(kind)
            _log.warning("%s", remark)


class _Sensors:
    """The sensors of one robot."""

    def __init__(self, robot: str, topics: str, middleware: Middleware, *, camera: bool) -> None:
        self.robot = robot
        self.poses = BodyPoses(middleware, topics)
        self.scans = middleware.reader(f"{topics}/scan", LaserScan)
        self.tags = middleware.writer(f"{topics}/tags", String)
        self.obstacles = middleware.writer(f"{topics}/obstacles", String)
        self._images = middleware.reader(f"{topics}/camera/image_raw", Image) if camera else None
        self._infos = middleware.reader(f"{topics}/camera/camera_info", CameraInfo) if camera else None

    def images(self) -> list[Image]:
        """The newest image that has come since; older ones would only delay it."""
        return [] if self._images is None else self._images.take()[-1:]

    def infos(self) -> list[CameraInfo]:
        """The newest intrinsics that have come since."""
        return [] if self._infos is None else self._infos.take()[-1:]


def _text(data: Any) -> String:
    return String(json.dumps(data, ensure_ascii=False))
