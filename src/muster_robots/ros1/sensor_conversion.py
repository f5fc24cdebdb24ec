"""Converts messages of sensor_msgs to Muster's values and back."""

from __future__ import annotations

from typing import Any

from muster.motion.frames import Floats
from muster.perception.camera import Intrinsics
from muster.perception.cameras import images
from muster.perception.cameras.camera_messages import image_of, intrinsics_of, matrix_of
from muster.perception.scan_obstacles import scan_of
from muster_robots.ros1.ros import rospy
from muster_robots.ros1.sensor_messages import CameraInfo, Image


def stamp_of(message: Any) -> float:
    """Seconds of ROS at which it was true; now, where a message carries no stamp."""
    seconds = float(message.header.stamp.to_sec())
    return seconds if seconds > 0 else float(rospy.get_time())


def image_from(message: Any) -> images.Image:
    """The image of a sensor_msgs/Image.

    Raises
    ------
    ParameterError
        if it is none, or of an encoding that is not known here.
    """
    return image_of(message.encoding, message.height, message.width, message.step, bytes(message.data))


def image_message(image: images.Image, frame: str, stamp: Any) -> Any:
    """A sensor_msgs/Image: grey or RGB."""
    message = Image()
    message.header.frame_id, message.header.stamp = frame, stamp
    message.height, message.width = image.shape[:2]
    message.encoding = "mono8" if image.ndim == 2 else "rgb8"
    message.step = message.width * (1 if image.ndim == 2 else 3)
    message.data = image.tobytes()
    return message


def intrinsics_from(message: Any) -> Intrinsics:
    """The intrinsics of a sensor_msgs/CameraInfo.

    Raises
    ------
    ParameterError
        if there are none, or the lens has distortion.
    """
    return intrinsics_of(message.width, message.height, message.K, message.D)


def camera_info_of(intrinsics: Intrinsics) -> Any:
    """A sensor_msgs/CameraInfo of rectified images."""
    message = CameraInfo()
    message.width, message.height = intrinsics.width, intrinsics.height
    message.distortion_model, message.D = "plumb_bob", [0.0] * 5
    message.K = matrix_of(intrinsics)
    message.R = [1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0]
    k = message.K
    message.P = [*k[0:3], 0.0, *k[3:6], 0.0, *k[6:9], 0.0]
    return message


def scan_from(message: Any) -> tuple[Floats, Floats]:
    """Ranges and bearings (n,) of a sensor_msgs/LaserScan.

    Raises
    ------
    ParameterError
        if it is none.
    """
    return scan_of(message.ranges, message.angle_min, message.angle_increment, (message.range_min, message.range_max))
