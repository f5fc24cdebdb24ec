"""The maps of robots on ROS 1, as `robot_maps` takes them: heard in ROS' own threads."""

from __future__ import annotations

from typing import Any

import numpy as np

from muster_robots.robot_maps import MapMessage, RobotMaps
from muster_robots.ros1.map_frame import MapFrame
from muster_robots.ros1.message_conversion import matrix_of
from muster_robots.ros1.node import hear
from muster_robots.ros1.ros import OccupancyGrid, rospy


class Ros1Maps(RobotMaps):
    """Hears `<robot>/map` of the robots that it is told of."""

    def __init__(self, frames: MapFrame) -> None:
        super().__init__(frames, rospy.logwarn)
        self._heard: list[Any] = []

    def listen(self, robot: str, topics: str) -> None:
        """Hear the maps of a robot whose topics are in a namespace, such as `/r_0`."""
        topic = self.expect(robot, topics)
        self._heard.append(hear(topic, OccupancyGrid, lambda said: self.take(robot, message_of(said)), queue_size=1))

    def close(self) -> None:
        """Listen no more."""
        for link in self._heard:
            link.unregister()


def message_of(message: Any) -> MapMessage:
    """Return a message nav_msgs/OccupancyGrid as `RobotMaps` takes it."""
    info = message.info
    return MapMessage(
        frame=message.header.frame_id,
        origin=matrix_of(info.origin),
        cell_m=info.resolution,
        size=(info.height, info.width),
        per_cent=np.array(message.data, dtype=np.int8),
    )
