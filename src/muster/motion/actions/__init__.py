"""The actions of tasks: one action a file, registered by its name in mission files."""

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
