"""Recordings of ROS: a record exported to ROS files, and recordings by others used as reference trajectories."""

from muster_robots.recordings.poses import PoseRecording, PoseTrack, is_recording, read_poses
from muster_robots.recordings.reference import Deviation, Reference, deviations
from muster_robots.recordings.ros_files import write_ros1, write_ros2

__all__ = [
    "Deviation",
    "PoseRecording",
    "PoseTrack",
    "Reference",
    "deviations",
    "is_recording",
    "read_poses",
    "write_ros1",
    "write_ros2",
]
