"""Room to stand: whether somebody can put a robot at a place."""

from __future__ import annotations

import math
from collections.abc import Iterable

from muster.execution.replanning.travel import Travel
from muster.execution.robots.task_motion import place
from muster.mission.errors import ParameterError
from muster.mission.model import Robot
from muster.mission.value_types import shown
from muster.motion.port import Place

Bodies = Iterable[tuple[Robot, Place]]
"""Robots that may be in the way, and where they are."""


def require_free(field: str, robot: Robot, at: tuple[float, ...], others: Bodies, travel: Travel) -> None:
    """Raise ParameterError unless walls, closed areas and other robots leave a robot room to stand at a place.

    Parameters
    ----------
    field : str
        What is refused, by the key of the event.
    robot : Robot
        The robot that is put there.
    at : tuple of float
        Coordinates in the map frame, metres.
    others : iterable of (Robot, Place)
        The other robots that are there, and their places.
    travel : Travel
        Knows walls and closed areas.
    """
    dimensions = len(robot.position)
    if len(at) != dimensions:
        raise ParameterError(f"{field}: {shown(list(at))}; expected {dimensions} coordinates")
    if not travel.stands(robot, place(at)):
        raise ParameterError(f"{field}: {shown(list(at))}; expected a place where {robot.id} is free")
    require_clear(field, robot, place(at), others)


def require_clear(field: str, robot: Robot, at: Place, others: Bodies) -> None:
    """Raise ParameterError where another robot is within reach of a place; parameters as those of `require_free`."""
    dimensions = len(robot.position)
    for other, there in others:
        if other.id != robot.id and math.dist(there, at) < robot.radius_m + other.radius_m:
            expected = f"a place clear of {other.id}, which is at {shown(list(there[:dimensions]))}"
            raise ParameterError(f"{field}: {shown(list(at[:dimensions]))}; expected {expected}")
