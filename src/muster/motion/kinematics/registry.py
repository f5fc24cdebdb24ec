"""The kinds of kinematics by the names that missions have for them."""

from __future__ import annotations

import math
from collections.abc import Mapping
from types import MappingProxyType

from muster.mission.model import Robot
from muster.mission.values.keywords import require_one_of
from muster.motion.kinematics.differential_drive import DifferentialDrive
from muster.motion.kinematics.hexacopter import Hexacopter
from muster.motion.kinematics.holonomic import Holonomic
from muster.motion.kinematics.kinematics import Kinematics
from muster.motion.kinematics.quadcopter import Quadcopter
from muster.motion.limits import Limits

USUAL_YAW_RATE_RADPS = math.pi / 2

_IMPLEMENTATIONS: tuple[Kinematics, ...] = (Holonomic(), DifferentialDrive(), Quadcopter(), Hexacopter())

KINEMATICS: Mapping[str, Kinematics] = MappingProxyType({k.name: k for k in _IMPLEMENTATIONS})


def kinematics_named(name: str) -> Kinematics:
    """The kinematics of that name.

    Raises
    ------
    ParameterError
        if there is none.
    """
    require_one_of("kinematics", name, KINEMATICS)
    return KINEMATICS[name]


FREE_RADIUS_M = 0.1
"""The turning radius of a robot that nothing limits."""


def turning_radius_of(robot: Robot) -> float:
    """The least radius that a robot can drive at full speed, metres; 0.1 where nothing limits it."""
    faces = kinematics_named(robot.kinematics).faces_its_way
    return limits_of(robot).turning_radius_m(faces_its_way=faces) or FREE_RADIUS_M


def limits_of(robot: Robot) -> Limits:
    """A robot's limits; what its mission does not say: a quarter turn a second, and any acceleration."""
    return Limits(
        speed_mps=robot.speed_mps,
        yaw_rate_radps=USUAL_YAW_RATE_RADPS if robot.yaw_rate_radps is None else robot.yaw_rate_radps,
        climb_mps=robot.climb_mps,
        acceleration_mps2=math.inf if robot.acceleration_mps2 is None else robot.acceleration_mps2,
    )
