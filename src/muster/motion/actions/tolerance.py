"""How far from a task's place its work still counts: where a robot only takes itself to be there, it is not done."""

from __future__ import annotations

from muster.mission.model import Action, Robot, Task
from muster.motion.actions.action import Impossible
from muster.motion.actions.area_coverage import swath_of
from muster.motion.actions.footprint import footprint_of
from muster.motion.actions.raster_search import scan_width

LEAST_M = 0.1
"""Of a robot that is smaller than this."""
_AT_THE_PLACE = frozenset({"go-to-goal", "delivery", "sensor-activation"})


def tolerance_m(task: Task, robot: Robot) -> float:
    """Return how far from its place a robot may do a task, metres: `within_m` of the task, else by its action.

    What is observed has to be in the picture: half the width of it. Of lanes, half of what a lane covers. Elsewhere the
    robot's body has to be over the place.
    """
    if task.within_m is not None:
        return task.within_m
    width_m = None if task.action is None else _covered_m(task, task.action, robot)
    return max(LEAST_M, robot.radius_m) if width_m is None else width_m / 2


def _covered_m(task: Task, action: Action, robot: Robot) -> float | None:
    """How wide what a robot sees or does at once is, metres; None where an action has no width."""
    if action.name == "stationary-observation":
        return action.width_m
    if action.name == "raster-search":
        if action.spacing_m is not None or robot.camera is None or action.height_m is None:
            return action.spacing_m
        seen = footprint_of(robot.camera, action.height_m)
        return None if isinstance(seen, Impossible) else scan_width(task, seen)
    if action.name == "coverage":
        swath = swath_of(action, robot)
        return None if isinstance(swath, Impossible) else swath.width_m
    return None


def ends_at_its_place(task: Task) -> bool:
    """Whether a robot ends a task at its place or exit, and not where its camera or lanes have it."""
    return task.action is None or task.action.name in _AT_THE_PLACE
