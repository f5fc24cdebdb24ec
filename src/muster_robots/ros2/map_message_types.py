"""The message of nav_msgs in which robots on ROS 2 tell their maps, as `message_types` describes the others."""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar

from muster_robots.ros2.description import Float32, Message, SignedBytes, UInt32
from muster_robots.ros2.message_types import Header, Pose, Time


@dataclass(frozen=True)
class MapMetaData(Message):
    NAME: ClassVar = "nav_msgs/MapMetaData"
    map_load_time: Time = Time()
    resolution: Float32 = 0.0
    width: UInt32 = 0
    height: UInt32 = 0
    origin: Pose = Pose()


@dataclass(frozen=True)
class OccupancyGrid(Message):
    NAME: ClassVar = "nav_msgs/OccupancyGrid"
    header: Header = Header()
    info: MapMetaData = MapMetaData()
    data: SignedBytes = b""
