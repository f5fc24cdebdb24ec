"""Activate a sensor at the task's position and wait until it has measured (`duration_s`)."""

from __future__ import annotations

from dataclasses import dataclass

from muster.mission.action_keys import SENSOR_ACTIVATION, ActionKeys
from muster.mission.model import Robot, Task
from muster.motion.actions.action import TaskMotion, staying


@dataclass(frozen=True)
class SensorActivation:
    """Takes `duration_s / efficiency` seconds; it costs what the mission types in."""

    name: str = "sensor-activation"
    keys: ActionKeys = SENSOR_ACTIVATION

    def plan(self, task: Task, robot: Robot) -> TaskMotion:
        return staying(task, robot)
