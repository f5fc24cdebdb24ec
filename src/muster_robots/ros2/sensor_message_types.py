"""The messages of sensor_msgs that Muster uses on ROS 2, as `message_types` describes the others.

Fields have the names of ROS 2: those of CameraInfo are capital letters in ROS 1.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Annotated, ClassVar

from muster_robots.ros2.description import Bytes, Flag, Float32, Length, Message, Text, UInt8, UInt32
from muster_robots.ros2.message_types import Header

Floats32 = Annotated[tuple[float, ...], "float32", Length(0)]
_IDENTITY = (1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0)


@dataclass(frozen=True)
class Image(Message):
    NAME: ClassVar = "sensor_msgs/Image"
    header: Header = Header()
    height: UInt32 = 0
    width: UInt32 = 0
    encoding: Text = ""
    is_bigendian: UInt8 = 0
    step: UInt32 = 0
    data: Bytes = b""


@dataclass(frozen=True)
class RegionOfInterest(Message):
    NAME: ClassVar = "sensor_msgs/RegionOfInterest"
    x_offset: UInt32 = 0
    y_offset: UInt32 = 0
    height: UInt32 = 0
    width: UInt32 = 0
    do_rectify: Flag = False


@dataclass(frozen=True)
class CameraInfo(Message):
    NAME: ClassVar = "sensor_msgs/CameraInfo"
    header: Header = Header()
    height: UInt32 = 0
    width: UInt32 = 0
    distortion_model: Text = ""
    d: Annotated[tuple[float, ...], "float64", Length(0)] = ()
    k: Annotated[tuple[float, ...], "float64", Length(9)] = (0.0,) * 9
    r: Annotated[tuple[float, ...], "float64", Length(9)] = _IDENTITY
    p: Annotated[tuple[float, ...], "float64", Length(12)] = (0.0,) * 12
    binning_x: UInt32 = 0
    binning_y: UInt32 = 0
    roi: RegionOfInterest = RegionOfInterest()


@dataclass(frozen=True)
class LaserScan(Message):
    NAME: ClassVar = "sensor_msgs/LaserScan"
    header: Header = Header()
    angle_min: Float32 = 0.0
    angle_max: Float32 = 0.0
    angle_increment: Float32 = 0.0
    time_increment: Float32 = 0.0
    scan_time: Float32 = 0.0
    range_min: Float32 = 0.0
    range_max: Float32 = 0.0
    ranges: Floats32 = ()
    intensities: Floats32 = ()
