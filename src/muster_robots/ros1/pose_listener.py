"""Receives the pose of one robot, from any of its topics, as a pose of the map.

Who is localised (`<robot>/pose`) does not go by odometry (`<robot>/odom`) any more: but only once such a pose counts.
"""

from __future__ import annotations

import time
from collections.abc import Callable
from typing import Any

from muster.motion.frames import Floats
from muster.motion.port import Place
from muster_robots.discovery import SHARED
from muster_robots.ros1.map_frame import MapFrame
from muster_robots.ros1.message_conversion import matrix_of
from muster_robots.ros1.node import hear
from muster_robots.ros1.ros import Odometry, PoseStamped, rospy

_MESSAGES = {"odom": Odometry, "pose": PoseStamped}

Take = Callable[[Any, Floats, Place | None], None]
"""Is given a message that counts, its pose in the map (4, 4), and the body's own velocity in m/s, where it is said."""


class PoseListener:
    """Listens from when it is made; calls from threads of ROS.

    Parameters
    ----------
    topics
        the robot's namespace, such as `/r_0`.
    take
        called with each pose that counts.
    pose_topic
        where its pose is published, if not on `<robot>/pose`: by a motion capture system.
    read_s
        a pose is read no sooner after the one before on its topic; in between it is only heard that one came.
    """

    def __init__(
        self, topics: str, frame: MapFrame, take: Take, *, pose_topic: str | None = None, read_s: float = 0.0
    ) -> None:
        self._topics, self._frame, self._take, self._wait_s = topics, frame, take, read_s
        self._source = ""  # of the last pose that counted
        self._read_s = 0.0
        self.heard_s: float | None = None  # real time, monotonic: when the last pose came that counts
        self.untied = ""  # a frame in which poses are given that nothing ties to the map
        where = {shared: f"{topics}/{shared}" for shared in SHARED}
        if pose_topic is not None:
            where["pose"] = pose_topic
        self._links = [
            hear(where[shared], rospy.AnyMsg, self._hear, callback_args=shared, queue_size=1, tcp_nodelay=True)
            for shared in SHARED
        ]

    def close(self) -> None:
        """Listen no more."""
        for link in self._links:
            link.unregister()

    def _hear(self, data: Any, shared: str) -> None:
        if data._connection_header["type"] != SHARED[shared] or (shared, self._source) == ("odom", "pose"):
            return
        now = time.monotonic()
        if shared == self._source and now - self._read_s < self._wait_s:
            self.heard_s = now
            return
        message = _MESSAGES[shared]().deserialize(data._buff)
        found = matrix_of(message.pose if shared == "pose" else message.pose.pose)
        if found is None:
            rospy.logwarn_throttle(10.0, f"{self._topics}/{shared}: a pose that is none; expected finite numbers")
            return
        matrix = self._frame.to_map(message.header.frame_id, found)
        self.untied = message.header.frame_id if matrix is None else ""
        if matrix is not None:
            self._source, self._read_s, self.heard_s = shared, now, now
            self._take(message, matrix, _ahead(message) if shared == "odom" else None)


def _ahead(message: Any) -> Place:
    linear = message.twist.twist.linear
    return linear.x, linear.y, linear.z
