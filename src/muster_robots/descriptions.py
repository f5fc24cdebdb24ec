"""Robots and tasks described outside of mission files, with the keys of mission files."""

from __future__ import annotations

from typing import Any, TypeVar

from muster.mission.errors import MissionError
from muster.mission.model import Robot, Task
from muster.mission.records import Record, findings
from muster.mission.source import Source
from muster.mission.value_types import Fault
from muster.mission.yaml_writer import plain

R = TypeVar("R", Robot, Task)


def robot_from_description(said: object, robot: Robot, where: str) -> Robot:
    """A robot with its own description: keys of a robot in a mission file, such as speed_mps; its id stays.

    Parameters
    ----------
    where
        it said so, for errors.

    Raises
    ------
    MissionError
        if something there is wrong.
    """
    known = plain(robot) | (said if isinstance(said, dict) else {"muster": said}) | {"id": robot.id}
    return read_as(Robot, known, where)


def read_as(kind: type[R], data: object, where: str) -> R:
    """A robot or a task, from plain data with its keys of a mission file.

    Raises
    ------
    MissionError
        if it is none.
    """
    faults: list[Fault] = []
    record: Any = Record(kind, f"a {kind.__name__.lower()}")
    found: R = record.read(data, (), faults)
    if faults:
        raise MissionError(findings(faults, Source(where)))
    return found
