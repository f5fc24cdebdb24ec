"""Work begins within one of the task's time windows."""

from __future__ import annotations

from muster.mission.model import Mission
from muster.verification.rules.limit_rule import LimitRule


class Window(LimitRule):
    """Work begins within one of the task's time windows."""

    kind = "window"

    def is_in(self, mission: Mission) -> bool:
        return any(task.window_s for task in mission.tasks)
