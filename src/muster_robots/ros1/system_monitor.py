"""The node `/system_monitor`: pose, usage and availability of each robot ([tcf-thesis], Table 5.1, 2).

It discovers robots itself (Figure 5.7) and hears them whether a mission is carried out or not; what they do it hears
from the controller. Latched topics, twice a second: `system_monitor/robots` (a list), and of each `<robot>/status`
(std_msgs/String with JSON).
"""

from __future__ import annotations

import json
import threading
import time
from collections.abc import Callable
from typing import Any

from muster.motion.frames import Floats
from muster.motion.port import Place
from muster_robots.custody_settings import CustodySettings
from muster_robots.discovery import robots_in
from muster_robots.odometer import Odometer
from muster_robots.ros1.map_frame import MapFrame
from muster_robots.ros1.message_conversion import place_and_heading, text_of
from muster_robots.ros1.node import hear, publish
from muster_robots.ros1.pose_listener import PoseListener
from muster_robots.ros1.ros import String, rospy

_REPORT_S = 0.5
_READ_S = 0.1
"""Least time between two poses that are decoded: a person watches, and decoding costs more than receiving."""
_SILENT_S = CustodySettings.link_lost_s
"""A robot that is silent for longer is not available."""


class SystemMonitor:
    """Watches from when it is made; this process is a node by then.

    Parameters
    ----------
    namespace
        in which robots are; "" for the root.
    topics
        the namespace of a robot's topics.
    frame
        of the mission, in tf's words.
    poses
        topic of a robot's pose, where others publish it; None: `<robot>/pose`.
    """

    def __init__(
        self,
        *,
        namespace: str,
        topics: Callable[[str], str],
        frame: str,
        poses: Callable[[str], str | None] = lambda robot: None,
    ) -> None:
        self._namespace, self._topics, self._poses = namespace, topics, poses
        self._frame = MapFrame(frame)
        self._watched: dict[str, WatchedRobot] = {}
        self._doing: dict[str, dict[str, str]] = {}
        self._publishers: dict[str, Any] = {}  # by full name (TCF, Figure 5.7, step 5)
        self._subscriber = hear("/muster/robots", String, self._hear_controller, queue_size=10)
        self._thread = threading.Thread(target=self._report_on, daemon=True)
        self._thread.start()

    def _hear_controller(self, message: Any) -> None:
        self._doing = json.loads(message.data)

    def _report_on(self) -> None:
        while not rospy.is_shutdown():
            self._discover()
            rows = [self._row(robot) for robot in sorted(self._watched.keys() | self._doing.keys())]
            self._say("/system_monitor/robots", rows)
            for row in rows:
                self._say(f"{self._topics(row['robot'])}/status", row)
            time.sleep(_REPORT_S)

    def _discover(self) -> None:
        """Where the master does not answer, those that are known are watched on."""
        try:
            for robot in {*robots_in(rospy.get_published_topics(), self._namespace), *self._doing}:
                if robot not in self._watched:
                    self._watched[robot] = WatchedRobot(self._topics(robot), self._frame, self._poses(robot))
        except Exception as error:  # rospy raises whatever the network does; the controller says so, and ends
            rospy.logdebug(f"the ROS master does not answer: {error}")

    def _row(self, robot: str) -> dict[str, Any]:
        doing = self._doing.get(robot, {"activity": "idle"})
        watched = self._watched.get(robot)
        ago = None if watched is None else watched.heard_ago_s
        heard = ago is not None and ago <= _SILENT_S
        row = {"robot": robot, "available": heard and doing["activity"] in ("idle", "returning"), **doing}
        place = None if watched is None else watched.place
        return {
            **row,
            "position": None if place is None else [round(c, 4) for c in place],
            "heading": None if watched is None or watched.heading is None else round(watched.heading, 4),
            "usage_m": 0.0 if watched is None else round(watched.odometer.metres, 3),
            "heard_ago_s": None if ago is None else round(ago, 2),
        }

    def _say(self, topic: str, data: Any) -> None:
        if topic not in self._publishers:
            self._publishers[topic] = rospy.Publisher(topic, String, queue_size=10, latch=True)
        publish(self._publishers[topic], text_of(data))


class WatchedRobot:
    """Where one robot is, and how far it has gone since it was discovered."""

    def __init__(self, topics: str, frame: MapFrame, pose_topic: str | None = None) -> None:
        self.odometer = Odometer(flat=False)
        self.place: Place | None = None
        self.heading: float | None = None
        self._listener = PoseListener(topics, frame, self._hear, pose_topic=pose_topic, read_s=_READ_S)

    @property
    def heard_ago_s(self) -> float | None:
        """Seconds; None if no message has arrived."""
        heard_s = self._listener.heard_s
        return None if heard_s is None else time.monotonic() - heard_s

    def _hear(self, _: Any, matrix: Floats, __: Place | None) -> None:
        self.place, self.heading = place_and_heading(matrix)
        self.odometer.hear(self.place)
