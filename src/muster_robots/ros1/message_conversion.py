"""Converts messages of ROS to Muster's values and back. Both use metres, radians and east-north-up (REP-103)."""

from __future__ import annotations

import json
import math
from typing import Any

import numpy as np

from muster.motion.frames import Floats, angles, quaternion_of, quaternion_rotation, transform
from muster.motion.port import Place
from muster_robots.ros1.ros import PoseStamped, String, TransformStamped, Twist, rospy
from muster_robots.steering import Velocity


def matrix_of(pose: Any) -> Floats | None:
    """A geometry_msgs/Pose as a transform (4, 4); None if it is none: not finite, or a quaternion of length 0."""
    place = (pose.position.x, pose.position.y, pose.position.z)
    return _matrix(place, pose.orientation)


def matrix_of_transform(message: Any) -> Floats | None:
    """The same of a geometry_msgs/Transform."""
    place = (message.translation.x, message.translation.y, message.translation.z)
    return _matrix(place, message.rotation)


def place_and_heading(matrix: Floats) -> tuple[Place, float]:
    """Metres, and radians from east."""
    x, y, z = matrix[:3, 3]
    return (float(x), float(y), float(z)), float(angles(matrix[:3, :3])[2])


def pose_stamped(frame: str, place: Place, heading: float) -> Any:
    """A level pose, stamped now."""
    message = PoseStamped()
    message.header.frame_id, message.header.stamp = frame, rospy.Time.now()
    fill_pose(message.pose, place, heading)
    return message


def fill_pose(pose: Any, place: Place, heading: float) -> None:
    """Make a geometry_msgs/Pose this level one."""
    pose.position.x, pose.position.y, pose.position.z = place
    _turn(pose.orientation, heading)


def twist_of(velocity: Velocity) -> Any:
    """A body's velocity as geometry_msgs/Twist."""
    message = Twist()
    message.linear.x, message.linear.y, message.linear.z, message.angular.z = velocity
    return message


def velocity_of(twist: Any) -> Velocity:
    """The inverse of `twist_of`."""
    return float(twist.linear.x), float(twist.linear.y), float(twist.linear.z), float(twist.angular.z)


def tf_of(parent: str, child: str, place: Place, heading: float) -> Any:
    """A level geometry_msgs/TransformStamped, stamped now."""
    one = TransformStamped()
    one.header.frame_id, one.header.stamp, one.child_frame_id = parent, rospy.Time.now(), child
    one.transform.translation.x, one.transform.translation.y, one.transform.translation.z = place
    _turn(one.transform.rotation, heading)
    return one


def stamped_transform(parent: str, child: str, matrix: Floats) -> Any:
    """A geometry_msgs/TransformStamped of a transform (4, 4), stamped now."""
    one = TransformStamped()
    one.header.frame_id, one.header.stamp, one.child_frame_id = parent, rospy.Time.now(), child
    move, turn = one.transform.translation, one.transform.rotation
    move.x, move.y, move.z = map(float, matrix[:3, 3])
    turn.x, turn.y, turn.z, turn.w = map(float, quaternion_of(matrix[:3, :3]))
    return one


def text_of(data: Any) -> Any:
    """Plain data as JSON in a std_msgs/String."""
    return String(json.dumps(data, ensure_ascii=False))


def _turn(quaternion: Any, heading: float) -> None:
    """Make a geometry_msgs/Quaternion, all zeros, that of a heading."""
    quaternion.z, quaternion.w = math.sin(heading / 2), math.cos(heading / 2)


def _matrix(place: tuple[float, float, float], q: Any) -> Floats | None:
    quaternion = np.array([q.x, q.y, q.z, q.w], dtype=np.float64)
    if not (np.isfinite(place).all() and np.isfinite(quaternion).all() and np.linalg.norm(quaternion) > 1e-6):
        return None
    return transform(place, quaternion_rotation(quaternion))
