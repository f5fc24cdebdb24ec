"""The frames that tf ties to the map on ROS 2: what /tf and /tf_static say."""

from __future__ import annotations

import logging

from muster.mission.errors import TransformError
from muster_robots.ros2.message_types import Point, Pose, TFMessage, Transform
from muster_robots.ros2.middleware import Middleware
from muster_robots.ros2.sensor_conversion import pose_matrix, stamp_of
from muster_robots.tied_frames import TiedFrames

MAP_FRAME = "map"
_log = logging.getLogger(__name__)


class Ros2MapFrame(TiedFrames):
    """Reads tf when it is asked to, in the thread that asks."""

    def __init__(self, middleware: Middleware) -> None:
        super().__init__(MAP_FRAME)
        self._readers = {
            static: middleware.reader(topic, TFMessage) for topic, static in (("/tf", False), ("/tf_static", True))
        }

    def hear(self, now_s: float) -> None:
        """Take in what tf has said since."""
        for static, reader in self._readers.items():
            for message in reader.take():
                self._take(message, static=static, now_s=now_s)

    def _take(self, message: TFMessage, *, static: bool, now_s: float) -> None:
        """What contradicts what tf said before is left out."""
        for one in message.transforms:
            matrix = pose_matrix(_pose(one.transform))
            if matrix is None:
                continue
            try:
                stamp_s = stamp_of(one.header)
                self.take(one.header.frame_id, one.child_frame_id, stamp_s, matrix, static=static, now_s=now_s)
            except TransformError as error:
                _log.warning("tf: %s", error)


def _pose(transform: Transform) -> Pose:
    place = transform.translation
    return Pose(Point(place.x, place.y, place.z), transform.rotation)
