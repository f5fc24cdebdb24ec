"""Go to the task's position: [tcf-thesis] section 4.2. It costs the task's stated `actuation_cost`, 0 by default."""

from __future__ import annotations

from dataclasses import dataclass

from muster.mission.action_keys import GO_TO_GOAL, ActionKeys
from muster.mission.model import Robot, Task
from muster.motion.actions.action import TaskMotion, staying


@dataclass(frozen=True)
class GoToGoal:
    """Also what a task without an action is."""

    name: str = "go-to-goal"
    keys: ActionKeys = GO_TO_GOAL

    def plan(self, task: Task, robot: Robot) -> TaskMotion:
        return staying(task, robot)
