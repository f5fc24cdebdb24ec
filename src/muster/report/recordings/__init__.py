"""Recordings of ROS: a record exported to ROS files, and recordings by others used as reference trajectories."""

from muster.report.recordings.poses import PoseRecording, PoseTrack, is_recording, read_poses
from muster.report.recordings.reference import Deviation, Reference, deviations
from muster.report.recordings.ros_files import write_ros1, write_ros2

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
