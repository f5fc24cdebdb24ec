"""Take a load up at `pickup` and bring it to the task's position."""

from __future__ import annotations

from dataclasses import dataclass, replace

from muster.mission.action_keys import DELIVERY, ActionKeys
from muster.mission.model import Robot, Task
from muster.motion.actions.action import TaskMotion, along


@dataclass(frozen=True)
class Delivery:
    """Enters at the pickup and leaves from the position; the way between the two is the cost."""

    name: str = "delivery"
    keys: ActionKeys = DELIVERY

    def plan(self, task: Task, robot: Robot) -> TaskMotion:
        assert task.action is not None
        assert task.action.pickup is not None
        return replace(along(task, robot, [task.action.pickup, task.position]), is_travel=True)
