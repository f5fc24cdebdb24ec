"""Robots described on the parameter server and tasks given in JSON, with the keys of mission files."""

from __future__ import annotations

import json

from muster.mission.model import Robot, Task
from muster_robots.descriptions import read_as, robot_from_description
from muster_robots.ros1.ros import rospy


def robot_from_parameters(topics: str, robot: Robot) -> Robot:
    """A robot with its parameter `muster`: keys of a robot in a mission file, such as speed_mps.

    Raises
    ------
    MissionError
        if something there is wrong.
    """
    name = f"{topics}/muster"
    return robot_from_description(rospy.get_param(name, {}), robot, name)


def task_of(text: str) -> Task:
    """A task in JSON, with a task's keys of a mission file.

    Raises
    ------
    MissionError
        if it is none.
    """
    try:
        data = json.loads(text)
    except ValueError:
        data = text
    return read_as(Task, data, "add_task")
