"""The maps of robots on ROS 2, as `robot_maps` takes them: read when they are asked for, in the thread that asks."""

from __future__ import annotations

import logging

import numpy as np

from muster.perception.robot_grids import RobotGrid
from muster_robots.robot_maps import MapMessage, RobotMaps
from muster_robots.ros2.map_frame import Ros2MapFrame
from muster_robots.ros2.map_message_types import OccupancyGrid
from muster_robots.ros2.middleware import Middleware, Reader
from muster_robots.ros2.sensor_conversion import pose_matrix

_log = logging.getLogger(__name__)


class Ros2Maps(RobotMaps):
    """Hears `<robot>/map` of the robots that it is told of.

    Each topic is read twice, as nobody hears both a map that was published before and a publisher that keeps none.
    """

    def __init__(self, middleware: Middleware, frames: Ros2MapFrame) -> None:
        super().__init__(frames, _log.warning)
        self._middleware = middleware
        self._readers: dict[str, list[Reader[OccupancyGrid]]] = {}

    def listen(self, robot: str, topics: str) -> None:
        """Hear the maps of a robot whose topics are in a namespace, such as `/r_0`."""
        topic = self.expect(robot, topics)
        self._readers[robot] = [
            self._middleware.reader(topic, OccupancyGrid, latched=latched) for latched in (True, False)
        ]

    def new(self) -> dict[str, RobotGrid]:
        """See `RobotMaps`."""
        self._read()
        return super().new()

    def missing(self, robot: str) -> str:
        """See `RobotMaps`."""
        self._read()
        return super().missing(robot)

    def _read(self) -> None:
        for robot, readers in self._readers.items():
            come = [message for reader in readers for message in reader.take()[-1:]]
            if come:
                self.take(robot, message_of(max(come, key=lambda one: one.header.stamp.seconds)))


def message_of(message: OccupancyGrid) -> MapMessage:
    """Return a message as `RobotMaps` takes it."""
    info = message.info
    return MapMessage(
        frame=message.header.frame_id,
        origin=pose_matrix(info.origin),
        cell_m=info.resolution,
        size=(info.height, info.width),
        per_cent=np.frombuffer(message.data, dtype=np.int8),
    )
