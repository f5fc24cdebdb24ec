"""The robot can do the task's action, which may need a camera that looks down."""

from __future__ import annotations

from muster.mission.model import Mission, Robot, Task
from muster.motion.actions import Impossible
from muster.verification.rules.pair_rule import PairRule
from muster.verification.travel import doing_at


class Action(PairRule):
    """An action has way points for the robot. It cannot be ignored: there is nothing that the robot could do."""

    kind = "skill"
    ignorable = False

    def refusal(self, mission: Mission, robot: Robot, task: Task) -> str | None:
        doing = doing_at(robot, task)
        return doing.reason if isinstance(doing, Impossible) else None
