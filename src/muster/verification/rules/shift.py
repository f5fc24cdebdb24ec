"""A robot's route, the way to its end included, ends while the robot is available."""

from __future__ import annotations

from muster.mission.model import Mission
from muster.verification.rules.limit_rule import LimitRule


class Shift(LimitRule):
    """A robot's route, the way to its end included, ends while the robot is available."""

    kind = "shift"

    def is_in(self, mission: Mission) -> bool:
        return any(robot.available_until_s is not None for robot in mission.robots)
