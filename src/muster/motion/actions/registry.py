"""The actions by the names that missions have for them."""

from __future__ import annotations

from dataclasses import fields

from muster.mission.action_keys import ACTION_KEYS
from muster.mission.errors import ParameterError
from muster.mission.model import Action, Robot, Task
from muster.motion.actions.action import Doing, Impossible, TaskAction
from muster.motion.actions.delivery import Delivery
from muster.motion.actions.go_to_goal import GoToGoal
from muster.motion.actions.ground_patrol import GroundPatrol
from muster.motion.actions.raster_search import RasterSearch
from muster.motion.actions.sensor_activation import SensorActivation
from muster.motion.actions.stationary_observation import StationaryObservation

_GO = GoToGoal()
_IMPLEMENTATIONS: tuple[TaskAction, ...] = (
    _GO,
    StationaryObservation(),
    RasterSearch(),
    GroundPatrol(),
    Delivery(),
    SensorActivation(),
)

ACTIONS: dict[str, TaskAction] = {action.name: action for action in _IMPLEMENTATIONS}


def register(action: TaskAction) -> None:
    """Make an action known: missions that are read or built from then on may name it.

    Raises
    ------
    ParameterError
        if the name is taken, or a key is none that an action may have.
    """
    if action.name in ACTION_KEYS:
        raise ParameterError(f"action: {action.name}; expected a name that no action has yet")
    known = {field.name for field in fields(Action)} - {"name"}
    for key in (*action.keys.needed, *action.keys.optional):
        if key not in known:
            raise ParameterError(f"action {action.name}: key {key}; expected keys of {', '.join(sorted(known))}")
    ACTION_KEYS[action.name] = action.keys
    ACTIONS[action.name] = action


def plan(task: Task, robot: Robot) -> Doing | Impossible:
    """How a robot does a task, or why it cannot; a task without an action is one to go to."""
    return (_GO if task.action is None else ACTIONS[task.action.name]).plan(task, robot)
