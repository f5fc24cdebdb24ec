"""The time of a leg, from rest to rest, as a robot's motion profile has it: for planner and judge alike.

The core has the same formula in `problem.hpp`. Without acceleration, yaw rate or climb rate in the mission, or with
`rules.timing: constant`, a leg takes its length by the robot's speed.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

import numpy as np

from muster.mission.model import Robot, Rules
from muster.motion.kinematics.registry import kinematics_named, limits_of


@dataclass(frozen=True)
class LegTimes:
    """What the time of a leg depends on.

    Parameters
    ----------
    acceleration_mps2, climb_mps
        inf: no limit.
    turn_s
        of the turn by a right angle with which a leg begins, where the robot drives only where it looks: what the true
        turns come to on average.
    """

    speed_mps: float
    acceleration_mps2: float = math.inf
    climb_mps: float = math.inf
    turn_s: float = 0.0

    @classmethod
    def of(cls, robot: Robot, rules: Rules) -> LegTimes:
        climb = robot.climb_mps if robot.kind == "air" else None
        stated = (robot.acceleration_mps2, robot.yaw_rate_radps, climb)
        if rules.timing == "constant" or stated == (None, None, None):
            return cls(robot.speed_mps)
        limits = limits_of(robot)
        turns = kinematics_named(robot.kinematics).faces_its_way
        return cls(
            robot.speed_mps,
            limits.acceleration_mps2,
            math.inf if climb is None else climb,
            math.pi / 2 / limits.yaw_rate_radps if turns else 0.0,
        )

    @property
    def is_constant(self) -> bool:
        """Whether the time is proportional to the length."""
        return self == LegTimes(self.speed_mps)

    def seconds(self, metres: Any, rise_m: Any = 0.0) -> Any:
        """The time of legs of so many metres, whose ends are so many metres apart in height; shapes as NumPy's.

        The speed rises to its limit and falls to rest again; on short legs it never gets there. Up and down the robot
        keeps to its path and its climb rate.
        """
        metres = np.asarray(metres, dtype=np.float64)
        if self.is_constant:
            return metres / self.speed_mps
        with np.errstate(divide="ignore", invalid="ignore"):
            climbing = np.where(np.asarray(rise_m) > 0, self.climb_mps * metres / rise_m, math.inf)
            speed = np.minimum(self.speed_mps, climbing)
            reaches = metres * self.acceleration_mps2 >= speed * speed
            driven = metres / speed + speed / self.acceleration_mps2
        seconds = np.where(reaches, driven, 2.0 * np.sqrt(metres / self.acceleration_mps2))
        return np.where(metres > 0, seconds + self.turn_s, metres)
