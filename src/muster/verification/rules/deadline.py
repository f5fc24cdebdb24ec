"""Work ends by the task's deadline."""

from __future__ import annotations

from muster.mission.model import Mission
from muster.verification.rules.limit_rule import LimitRule


class Deadline(LimitRule):
    """Work ends by the task's deadline."""

    kind = "deadline"

    def is_in(self, mission: Mission) -> bool:
        return any(task.deadline_s is not None for task in mission.tasks)
