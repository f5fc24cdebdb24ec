"""Converts messages of sensor_msgs and poses on ROS 2 to Muster's values and back."""

from __future__ import annotations

import time

import numpy as np

from muster.motion.frames import Floats, quaternion_rotation, transform
from muster.perception.camera import Intrinsics
from muster.perception.cameras import images
from muster.perception.cameras.camera_messages import image_of, intrinsics_of, matrix_of
from muster.perception.scan_obstacles import scan_of
from muster_robots.ros2.message_types import Header, Pose, Time
from muster_robots.ros2.sensor_message_types import CameraInfo, Image, LaserScan


def stamp_of(header: Header) -> float:
    """Seconds at which it was true; now, where a message carries no stamp."""
    return header.stamp.seconds or time.time()


def pose_matrix(pose: Pose) -> Floats | None:
    """A pose as a transform (4, 4); None if it is none: not finite, or a quaternion of length 0."""
    at, q = pose.position, pose.orientation
    place, turn = np.array([at.x, at.y, at.z]), np.array([q.x, q.y, q.z, q.w])
    if not (np.isfinite(place).all() and np.isfinite(turn).all() and np.linalg.norm(turn) > 1e-6):
        return None
    return transform(place, quaternion_rotation(turn))


def image_from(message: Image) -> images.Image:
    """The image of a message.

    Raises
    ------
    ParameterError
        if it is none, or of an encoding that is not known here.
    """
    return image_of(message.encoding, message.height, message.width, message.step, message.data)


def image_message(image: images.Image, frame: str, stamp_s: float) -> Image:
    """A message of an image: grey or RGB."""
    height, width = image.shape[:2]
    encoding, channels = ("mono8", 1) if image.ndim == 2 else ("rgb8", 3)
    header = Header(stamp=Time.of(stamp_s), frame_id=frame)
    return Image(header, height, width, encoding, 0, width * channels, image.tobytes())


def intrinsics_from(message: CameraInfo) -> Intrinsics:
    """The intrinsics of a message.

    Raises
    ------
    ParameterError
        if there are none, or the lens has distortion.
    """
    return intrinsics_of(message.width, message.height, message.k, message.d)


def camera_info_of(intrinsics: Intrinsics, frame: str, stamp_s: float) -> CameraInfo:
    """The message of rectified images."""
    k = matrix_of(intrinsics)
    return CameraInfo(
        header=Header(stamp=Time.of(stamp_s), frame_id=frame),
        height=intrinsics.height,
        width=intrinsics.width,
        distortion_model="plumb_bob",
        d=(0.0,) * 5,
        k=tuple(k),
        p=(*k[0:3], 0.0, *k[3:6], 0.0, *k[6:9], 0.0),
    )


def scan_from(message: LaserScan) -> tuple[Floats, Floats]:
    """Ranges and bearings (n,) of a scan.

    Raises
    ------
    ParameterError
        if it is none.
    """
    reach_m = message.range_min, message.range_max
    return scan_of(message.ranges, message.angle_min, message.angle_increment, reach_m)
