"""Receives the pose of one robot, from any of its topics and from tf, as a pose of the map (`localisation`).

Who is localised (`<robot>/pose`) does not go by odometry (`<robot>/odom`) any more: but only once such a pose counts.
"""

from __future__ import annotations

import math
import threading
import time
from collections.abc import Callable
from functools import partial
from types import SimpleNamespace
from typing import Any

from muster.motion.frames import Floats
from muster.motion.port import Place
from muster_robots.discovery import SHARED
from muster_robots.localisation import BODY_FRAMES, Localisation
from muster_robots.ros1.map_frame import MapFrame
from muster_robots.ros1.message_conversion import matrix_of
from muster_robots.ros1.node import hear
from muster_robots.ros1.ros import Odometry, PoseStamped, PoseWithCovarianceStamped, rospy

_MESSAGES = {
    SHARED["odom"]: Odometry,
    SHARED["pose"]: PoseStamped,
    SHARED["amcl_pose"]: PoseWithCovarianceStamped,
}
_POSES = (SHARED["pose"], SHARED["amcl_pose"])
_TYPES = {"odom": (SHARED["odom"],), "pose": _POSES, "amcl_pose": _POSES}
"""Types that count on a topic, by how the topic is used."""

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
        self._frame, self._take, self._wait_s, self._lock = frame, take, read_s, threading.Lock()
        self._where = {shared: f"{topics}/{shared}" for shared in SHARED}
        self._where["pose"] = pose_topic or self._where["pose"]
        self._localisation = Localisation(frame, poses_last_s=math.inf)
        self._source = ""  # of the last pose that counted
        self._read_s = 0.0
        self.heard_s: float | None = None  # real time, monotonic: when the last pose came that counts
        self._links = [
            hear(topic, rospy.AnyMsg, self._hear, callback_args=shared, queue_size=1, tcp_nodelay=True)
            for shared, topic in self._where.items()
        ]
        for name in BODY_FRAMES:
            body = f"{topics.strip('/')}/{name}"
            frame.watch(body, partial(self._hear_body, body))

    @property
    def untied(self) -> str:
        """What is wrong with the frame in which the robot gives poses; empty if tf ties it to the map."""
        return self._localisation.untied

    @property
    def expected(self) -> str:
        """The topics on which the robot may say where it is."""
        return " or ".join(self._where.values())

    def close(self) -> None:
        """Listen no more."""
        for link in self._links:
            link.unregister()

    def _hear(self, data: Any, shared: str) -> None:
        kind = data._connection_header["type"]
        if kind not in _TYPES[shared] or (self._source == "pose" != shared):
            return
        now = time.monotonic()
        if self._is_too_soon(shared, now):
            return
        message = _MESSAGES[kind]().deserialize(data._buff)
        found = matrix_of(message.pose if kind == SHARED["pose"] else message.pose.pose)
        if found is None:
            rospy.logwarn_throttle(10.0, f"{self._where[shared]}: a pose that is none; expected finite numbers")
            return
        said = {"odom": self._localisation.odometry, "pose": self._localisation.pose}
        with self._lock:
            judge = said.get(shared, self._localisation.fix)
            matrix = judge(now, self._where[shared], message.header.frame_id, found)
        self._count(message, matrix, _ahead(message) if shared == "odom" else None, shared, now)

    def hear_fix(self, message: Any) -> None:
        """Take in a PoseStamped by which the robot's navigation says where it is."""
        now, found = time.monotonic(), matrix_of(message.pose)
        if found is not None and self._source != "pose":
            with self._lock:
                matrix = self._localisation.fix(now, "feedback of its navigation", message.header.frame_id, found)
            self._count(message, matrix, None, "fix", now)

    def _hear_body(self, frame: str) -> None:
        now = time.monotonic()
        if self._is_too_soon("tf", now):
            return
        with self._lock:
            matrix = self._localisation.body(now, self._frame, frame)
        header = SimpleNamespace(frame_id=frame, stamp=rospy.Time.now())
        self._count(SimpleNamespace(header=header), matrix, None, "tf", now)

    def _is_too_soon(self, source: str, now: float) -> bool:
        too_soon = source == self._source and now - self._read_s < self._wait_s
        self.heard_s = now if too_soon else self.heard_s
        return too_soon

    def _count(self, message: Any, matrix: Floats | None, ahead: Place | None, source: str, now: float) -> None:
        if matrix is not None:
            self._source, self._read_s, self.heard_s = source, now, now
            self._take(message, matrix, ahead)


def _ahead(message: Any) -> Place:
    linear = message.twist.twist.linear
    return linear.x, linear.y, linear.z
