"""What each kind of task makes a robot do: one action a file, known by the name that missions have for it."""

from muster.mission.action_keys import ActionKeys
from muster.motion.actions.action import Impossible, TaskAction, TaskMotion, along, duration_of, given, raised, staying
from muster.motion.actions.registry import ACTIONS, plan, register

__all__ = [
    "ACTIONS",
    "ActionKeys",
    "Impossible",
    "TaskAction",
    "TaskMotion",
    "along",
    "duration_of",
    "given",
    "plan",
    "raised",
    "register",
    "staying",
]
