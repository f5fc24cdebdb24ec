"""The standard messages of ROS that Muster uses, each described once for ROS 1 and ROS 2.

Names, fields and their order are those of std_msgs, builtin_interfaces, geometry_msgs, nav_msgs, tf2_msgs and
visualization_msgs (ROS Noetic; ROS 2 Humble and later). Units and frames by REP-103 and REP-105: metres, radians, m/s,
seconds; x forward or east, z up; a twist is in the frame of the body that moves.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Annotated, ClassVar

from muster_robots.ros2.description import (
    ROS1,
    ROS2,
    Bytes,
    Flag,
    Float32,
    Float64,
    Int32,
    Length,
    Message,
    Only,
    Text,
    UInt32,
)

Covariance = Annotated[tuple[float, ...], "float64", Length(36)]
_UNKNOWN = (0.0,) * 36


@dataclass(frozen=True)
class Time(Message):
    NAME: ClassVar = "builtin_interfaces/Time"
    sec: Int32 = 0
    nanosec: UInt32 = 0

    @classmethod
    def of(cls, seconds: float) -> Time:
        return cls(*divmod(round(seconds * 1e9), 10**9))

    @property
    def seconds(self) -> float:
        return self.sec + self.nanosec * 1e-9


@dataclass(frozen=True)
class Duration(Message):
    NAME: ClassVar = "builtin_interfaces/Duration"
    sec: Int32 = 0
    nanosec: UInt32 = 0


@dataclass(frozen=True)
class Header(Message):
    """`seq` is set by the publisher in ROS 1."""

    NAME: ClassVar = "std_msgs/Header"
    seq: Annotated[UInt32, Only(ROS1)] = 0
    stamp: Time = Time()
    frame_id: Text = ""


@dataclass(frozen=True)
class String(Message):
    NAME: ClassVar = "std_msgs/String"
    data: Text = ""


@dataclass(frozen=True)
class ColorRGBA(Message):
    NAME: ClassVar = "std_msgs/ColorRGBA"
    r: Float32 = 0.0
    g: Float32 = 0.0
    b: Float32 = 0.0
    a: Float32 = 0.0


@dataclass(frozen=True)
class Point(Message):
    NAME: ClassVar = "geometry_msgs/Point"
    x: Float64 = 0.0
    y: Float64 = 0.0
    z: Float64 = 0.0


@dataclass(frozen=True)
class Vector3(Message):
    NAME: ClassVar = "geometry_msgs/Vector3"
    x: Float64 = 0.0
    y: Float64 = 0.0
    z: Float64 = 0.0


@dataclass(frozen=True)
class Quaternion(Message):
    NAME: ClassVar = "geometry_msgs/Quaternion"
    x: Float64 = 0.0
    y: Float64 = 0.0
    z: Float64 = 0.0
    w: Float64 = 1.0


@dataclass(frozen=True)
class Pose(Message):
    NAME: ClassVar = "geometry_msgs/Pose"
    position: Point = Point()
    orientation: Quaternion = Quaternion()


@dataclass(frozen=True)
class PoseStamped(Message):
    NAME: ClassVar = "geometry_msgs/PoseStamped"
    header: Header = Header()
    pose: Pose = Pose()


@dataclass(frozen=True)
class PoseWithCovariance(Message):
    NAME: ClassVar = "geometry_msgs/PoseWithCovariance"
    pose: Pose = Pose()
    covariance: Covariance = _UNKNOWN


@dataclass(frozen=True)
class PoseWithCovarianceStamped(Message):
    NAME: ClassVar = "geometry_msgs/PoseWithCovarianceStamped"
    header: Header = Header()
    pose: PoseWithCovariance = PoseWithCovariance()


@dataclass(frozen=True)
class Twist(Message):
    NAME: ClassVar = "geometry_msgs/Twist"
    linear: Vector3 = Vector3()
    angular: Vector3 = Vector3()


@dataclass(frozen=True)
class TwistStamped(Message):
    NAME: ClassVar = "geometry_msgs/TwistStamped"
    header: Header = Header()
    twist: Twist = Twist()


@dataclass(frozen=True)
class TwistWithCovariance(Message):
    NAME: ClassVar = "geometry_msgs/TwistWithCovariance"
    twist: Twist = Twist()
    covariance: Covariance = _UNKNOWN


@dataclass(frozen=True)
class Transform(Message):
    NAME: ClassVar = "geometry_msgs/Transform"
    translation: Vector3 = Vector3()
    rotation: Quaternion = Quaternion()


@dataclass(frozen=True)
class TransformStamped(Message):
    NAME: ClassVar = "geometry_msgs/TransformStamped"
    header: Header = Header()
    child_frame_id: Text = ""
    transform: Transform = Transform()


@dataclass(frozen=True)
class Odometry(Message):
    NAME: ClassVar = "nav_msgs/Odometry"
    header: Header = Header()
    child_frame_id: Text = ""
    pose: PoseWithCovariance = PoseWithCovariance()
    twist: TwistWithCovariance = TwistWithCovariance()


@dataclass(frozen=True)
class Path(Message):
    NAME: ClassVar = "nav_msgs/Path"
    header: Header = Header()
    poses: tuple[PoseStamped, ...] = ()


@dataclass(frozen=True)
class TFMessage(Message):
    NAME: ClassVar = "tf2_msgs/TFMessage"
    transforms: tuple[TransformStamped, ...] = ()


@dataclass(frozen=True)
class CompressedImage(Message):
    NAME: ClassVar = "sensor_msgs/CompressedImage"
    header: Header = Header()
    format: Text = ""
    data: Bytes = b""


@dataclass(frozen=True)
class UVCoordinate(Message):
    NAME: ClassVar = "visualization_msgs/UVCoordinate"
    u: Float32 = 0.0
    v: Float32 = 0.0


@dataclass(frozen=True)
class MeshFile(Message):
    NAME: ClassVar = "visualization_msgs/MeshFile"
    filename: Text = ""
    data: Bytes = b""


_SHAPES = (
    *("ARROW", "CUBE", "SPHERE", "CYLINDER", "LINE_STRIP", "LINE_LIST", "CUBE_LIST", "SPHERE_LIST", "POINTS"),
    *("TEXT_VIEW_FACING", "MESH_RESOURCE", "TRIANGLE_LIST"),
)


@dataclass(frozen=True)
class Marker(Message):
    NAME: ClassVar = "visualization_msgs/Marker"
    header: Header = Header()
    ns: Text = ""
    id: Int32 = 0
    type: Int32 = 0
    action: Int32 = 0
    pose: Pose = Pose()
    scale: Vector3 = Vector3()
    color: ColorRGBA = ColorRGBA()
    lifetime: Duration = Duration()
    frame_locked: Flag = False
    points: tuple[Point, ...] = ()
    colors: tuple[ColorRGBA, ...] = ()
    texture_resource: Annotated[Text, Only(ROS2)] = ""
    texture: Annotated[CompressedImage, Only(ROS2)] = field(default_factory=CompressedImage)
    uv_coordinates: Annotated[tuple[UVCoordinate, ...], Only(ROS2)] = ()
    text: Text = ""
    mesh_resource: Text = ""
    mesh_file: Annotated[MeshFile, Only(ROS2)] = field(default_factory=MeshFile)
    mesh_use_embedded_materials: Flag = False


@dataclass(frozen=True)
class MarkerArray(Message):
    NAME: ClassVar = "visualization_msgs/MarkerArray"
    markers: tuple[Marker, ...] = ()


SHAPES = {name: k for k, name in enumerate(_SHAPES)}
"""What a marker's `type` may be."""

MESSAGES: dict[str, type[Message]] = {
    message.NAME: message
    for message in (
        *(Time, Duration, Header, String, ColorRGBA, Point, Vector3, Quaternion, Pose, PoseStamped, PoseWithCovariance),
        *(PoseWithCovarianceStamped, Twist, TwistStamped, TwistWithCovariance, Transform, TransformStamped, Odometry),
        *(Path, TFMessage, CompressedImage, UVCoordinate, MeshFile, Marker, MarkerArray),
    )
}
"""By name, `package/Type`."""
