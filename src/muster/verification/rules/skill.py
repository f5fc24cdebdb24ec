"""The robot has every skill that the task requires."""

from __future__ import annotations

from muster.mission.model import Mission, Robot, Task
from muster.verification.rules.pair_rule import PairRule


class Skill(PairRule):
    """`requires_j` is a subset of `skills_i`."""

    kind = "skill"

    def refusal(self, mission: Mission, robot: Robot, task: Task) -> str | None:
        lacking = [skill for skill in task.requires if skill not in robot.skills]
        return f"the robot lacks {', '.join(lacking)}" if lacking else None
