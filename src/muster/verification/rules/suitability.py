"""The robot's type is suitable for the task's type."""

from __future__ import annotations

from muster.mission.model import Mission, Robot, Task
from muster.verification.rules.pair_rule import PairRule


class Suitability(PairRule):
    """The score is at least `min_suitability`, where a table is given: [tcf-thesis] (3.15)."""

    kind = "suitability"

    def refusal(self, mission: Mission, robot: Robot, task: Task) -> str | None:
        if mission.suitability is None:
            return None
        assert robot.type is not None  # where there is a table, every robot and task has a type
        assert task.type is not None
        score, least = mission.suitability[robot.type].get(task.type, 0.0), mission.rules.min_suitability
        if score >= least:
            return None
        return f"{robot.type} scores {score:g} for {task.type}, at least {least:g} is needed"
