"""The frames that tf ties to the map on ROS 2: what /tf and /tf_static say."""

from __future__ import annotations

import logging

from muster.mission.errors import TransformError
from muster_robots.localisation import BODY_FRAMES
from muster_robots.ros2.message_types import Point, Pose, TFMessage, Transform
from muster_robots.ros2.middleware import Middleware
from muster_robots.ros2.sensor_conversion import pose_matrix, stamp_of
from muster_robots.tied_frames import TiedFrames

MAP_FRAME = "map"
_log = logging.getLogger(__name__)


class Ros2MapFrame(TiedFrames):
    """Reads tf when it is asked to, in the thread that asks.

    Parameters
    ----------
    name : str
        Name of the map's frame.
    topics : str
        Namespace of the topics `tf` and `tf_static`; the root by default.
    shared : TiedFrames, optional
        See `TiedFrames`.
    """

    def __init__(
        self, middleware: Middleware, name: str = MAP_FRAME, topics: str = "", shared: TiedFrames | None = None
    ) -> None:
        super().__init__(name, shared)
        self.moved: list[str] = []
        """The frames that /tf has moved, by what was heard last."""
        self._readers = {
            static: middleware.reader(f"{topics}/{topic}", TFMessage)
            for topic, static in (("tf", False), ("tf_static", True))
        }

    def hear(self, now_s: float) -> None:
        """Take in what tf has said since."""
        self.moved = []
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
                continue
            if not static:
                self.moved.append(one.child_frame_id.strip("/"))


class RobotFrames(Ros2MapFrame):
    """The frames of one robot: of its own tf (`<robot>/tf`), whose names have no prefix, and of that of all robots."""

    def __init__(self, middleware: Middleware, topics: str, shared: TiedFrames) -> None:
        super().__init__(middleware, shared.name, topics, shared)
        self._all, self._prefix = shared, topics.strip("/")

    def bodies(self, now_s: float) -> list[tuple[TiedFrames, str]]:
        """Take in what the robot's own tf has said since; return where its body has moved, by tf and frame."""
        self.hear(now_s)
        theirs = {f"{self._prefix}/{name}" for name in BODY_FRAMES}
        shared = self._all.moved if isinstance(self._all, Ros2MapFrame) else []
        found: list[tuple[TiedFrames, str]] = [(self, one) for one in self.moved if one in BODY_FRAMES]
        return found + [(self._all, one) for one in shared if one in theirs]


def _pose(transform: Transform) -> Pose:
    place = transform.translation
    return Pose(Point(place.x, place.y, place.z), transform.rotation)
