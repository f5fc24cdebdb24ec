"""The actions by their names in mission files, including those of installed packages."""

from __future__ import annotations

from typing import cast

from muster.mission.action_keys import ACTION_GROUP, ACTION_KEYS, keys_of
from muster.mission.errors import ParameterError
from muster.mission.model import Robot, Task
from muster.mission.system.plugins import Registry
from muster.motion.actions.action import Impossible, TaskAction, TaskMotion
from muster.motion.actions.go_to_goal import GoToGoal

_GO = GoToGoal()


def _checked(name: str, found: object) -> TaskAction:
    action = found() if isinstance(found, type) else found
    keys_of(name, action)
    if not callable(getattr(action, "plan", None)):
        raise ParameterError(f"it is a {type(action).__name__} without plan; expected an action: name, keys and plan")
    return cast("TaskAction", action)


ACTIONS: Registry[TaskAction] = Registry(
    "action",
    ACTION_GROUP,
    _checked,
)


def register(action: TaskAction) -> None:
    """Make an action known in this process: missions that are read or built from then on may name it.

    A package registers an action for every process by an entry point of the group `muster.actions`.

    Raises
    ------
    ParameterError
        if the name is taken, or a key is neither one of `model.Action` nor one of its own.
    """
    ACTION_KEYS.add(action.name, action.keys)
    ACTIONS.add(action.name, action)


def plan(task: Task, robot: Robot) -> TaskMotion | Impossible:
    """How a robot does a task, or why it cannot; a task without an action is one to go to."""
    return (_GO if task.action is None else ACTIONS[task.action.name]).plan(task, robot)
