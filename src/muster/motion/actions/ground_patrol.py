"""Drive a square around the task's position: [tcf-thesis] section 4.2, end."""

from __future__ import annotations

from dataclasses import dataclass

from muster.mission.action_keys import GROUND_PATROL, ActionKeys
from muster.mission.model import Robot, Task
from muster.motion.actions.action import TaskMotion, along, given


@dataclass(frozen=True)
class GroundPatrol:
    """From the south-west corner north, east, south and back: 4 L."""

    name: str = "ground-patrol"
    keys: ActionKeys = GROUND_PATROL

    def plan(self, task: Task, robot: Robot) -> TaskMotion:
        (side,), (x, y, *z) = given(task, "side_m"), task.position
        half = side / 2
        corners = ((-half, -half), (-half, half), (half, half), (half, -half), (-half, -half))
        return along(task, robot, [(x + east, y + north, *z) for east, north in corners])
