"""What a robot says of itself on the parameter server, and what is asked for in JSON: as in a mission file."""

from __future__ import annotations

import json
from typing import Any

from muster.bridges.ros1.ros import rospy
from muster.mission.errors import MissionError
from muster.mission.kinds import Fault, Record
from muster.mission.model import Robot, Task, findings
from muster.mission.source import Source
from muster.mission.yaml_writer import plain


def described(topics: str, robot: Robot) -> Robot:
    """A robot with what its parameter `muster` says: keys of a robot in a mission file, such as speed_mps.

    Raises
    ------
    MissionError
        if something there is wrong.
    """
    name = f"{topics}/muster"
    said: Any = rospy.get_param(name, {})
    known = plain(robot) | (said if isinstance(said, dict) else {"muster": said}) | {"id": robot.id}
    found: Robot = _read(known, Record(Robot, "a robot"), name)
    return found


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
    found: Task = _read(data, Record(Task, "a task"), "add_task")
    return found


def _read(data: object, record: Any, name: str) -> Any:
    faults: list[Fault] = []
    found = record.read(data, (), faults)
    if faults:
        raise MissionError(findings(faults, Source(name)))
    return found
