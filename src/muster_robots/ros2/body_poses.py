"""The stamped poses of a robot's body on ROS 2, in the map, with roll and pitch: for its camera and its laser."""

from __future__ import annotations

from muster.motion.frames import Floats
from muster_robots.ros2.map_frame import MAP_FRAME
from muster_robots.ros2.message_types import Odometry, PoseStamped
from muster_robots.ros2.middleware import Middleware
from muster_robots.ros2.sensor_conversion import pose_matrix, stamp_of


class BodyPoses:
    """Of `<robot>/pose`; of odometry, if that is in the map's frame and no pose has come."""

    def __init__(self, middleware: Middleware, topics: str) -> None:
        self._poses = middleware.reader(f"{topics}/pose", PoseStamped)
        self._odometry = middleware.reader(f"{topics}/odom", Odometry)
        self._localised = False

    def take(self) -> list[tuple[float, Floats]]:
        """Stamps in seconds and poses (4, 4), which have come since, oldest first."""
        said = [(message.header, message.pose) for message in self._poses.take()]
        reckoned = [(message.header, message.pose.pose) for message in self._odometry.take()]
        self._localised = self._localised or bool(said)
        taken = []
        for header, pose in said if self._localised else reckoned:
            matrix = pose_matrix(pose)
            if matrix is not None and header.frame_id.lstrip("/") == MAP_FRAME:
                taken.append((stamp_of(header), matrix))
        return taken
