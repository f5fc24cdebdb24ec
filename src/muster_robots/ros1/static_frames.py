"""The frames of a mission's robots that do not change, for /tf_static: cameras, and where odometry begins."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, Literal

from muster.mission.model import Mission
from muster.perception.camera import mount_of_mission
from muster_robots.ros1.message_conversion import stamped_transform
from muster_robots.tied_frames import OWN, start_frame, start_pose

Odometry = Literal["map", "start"]
"""Of which frame a robot's odometry is: one that tf ties to the map, or `<robot>/odom`, which begins at its start."""


def static_frames(
    mission: Mission, topics: Callable[[str], str], *, frame: str, odometry: Odometry = "map"
) -> list[Any]:
    """Transforms for /tf_static.

    `muster/<robot>` to `muster/<robot>/camera` (x to the right of the picture, y down, z ahead) of each robot with a
    camera. With odometry from the start the map to `<robot>/odom`, which is the initialisation frame of [tcf-thesis]
    (4.2)-(4.4): the robot's pose in the mission.

    Parameters
    ----------
    topics
        the namespace of a robot's topics.
    frame
        of the mission, in tf's words.
    """
    cameras = [
        stamped_transform(f"{OWN}{robot.id}", f"{OWN}{robot.id}/camera", mount_of_mission(robot.camera))
        for robot in mission.robots
        if robot.camera is not None
    ]
    if odometry == "map":
        return cameras
    return cameras + [
        stamped_transform(frame, start_frame(topics(robot.id)), start_pose(robot)) for robot in mission.robots
    ]
