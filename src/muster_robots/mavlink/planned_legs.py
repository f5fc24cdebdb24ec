"""The way points of planned tasks, leg by leg, and the tasks that the limits of an autopilot refuse before take-off."""

from __future__ import annotations

import logging
from collections.abc import Callable, Iterator, Sequence

from muster.mission.errors import ParameterError
from muster.mission.model import Mission, Robot, Task
from muster.mission.plan import Plan
from muster.motion import actions
from muster.motion.actions import Impossible
from muster.motion.port import Place, Waypoint
from muster_robots.mavlink.drone import Drone
from muster_robots.mavlink.faults import Kind
from muster_robots.mavlink.fence_detours import MapCheck, within_limits

Way = Callable[[Robot, Place, Place], Sequence[Waypoint] | None]
"""What a robot passes from one place to another, the last included; None where there is no way."""


_log = logging.getLogger(__name__)


def show_fence(drone: Drone, *, may_refuse: bool) -> None:
    """Warn of an autopilot that tells nothing of its fence.

    Parameters
    ----------
    may_refuse : bool
        Whether a fence that is on and was not read to its end ends the run; else all tasks are refused for its drone.

    Raises
    ------
    ParameterError
        for such a fence, if `may_refuse`.
    """
    name, limits = drone.robot.id, drone.limits
    if limits.note and not limits.unread:
        _log.warning("%s: no polygons and circles of its autopilot's fence are checked: %s", name, limits.note)
    if limits.unread and may_refuse:
        raise ParameterError(f"{name}: {limits.unread}; expected all of it before a flight, or the fence off")


def order_of(task: Task, robot: Robot, here: Place, way: Way) -> Sequence[Waypoint] | str:
    """Return the way points of a task, and of the way to each; or why there are none, in words.

    Parameters
    ----------
    here : Place
        Where the way begins, in the map frame.
    way : callable
        What a robot passes from one place to another.
    """
    doing = actions.plan(task, robot)
    if isinstance(doing, Impossible):
        return doing.reason
    waypoints: list[Waypoint] = []
    for waypoint in doing.waypoints:
        there = way(robot, here, waypoint.position)
        if there is None:
            return "there is no way for it"
        waypoints += [*there[:-1], waypoint]
        here = waypoint.position
    return waypoints


def planned_refusals(
    drone: Drone, mission: Mission, plan: Plan, way: Way, check: MapCheck
) -> Iterator[tuple[str, str, str]]:
    """For each task whose places, or whose planned way, the limits of an autopilot refuse: robot, task, and why.

    A planned way begins where the drone is, and leads on from the last task that is not refused. Areas of the
    autopilot's fence are passed by detours that `check` allows. A straight return that would cross an area is logged:
    which way the autopilot takes home, and at which height, its own parameters say.
    """
    robot = drone.robot
    refused: dict[str, str] = {}
    for task in mission.tasks:
        doing = actions.plan(task, robot)
        flown = [] if isinstance(doing, Impossible) else drone.flown(doing.waypoints)
        if why := drone.refusal([waypoint.position for waypoint in flown]):
            refused[task.id] = why
    tasks = {task.id: task for task in mission.tasks}
    here = drone.telemetry.place or drone.telemetry.start
    for name in [name for route in plan.routes if route.robot == robot.id for name in route.tasks]:
        order = order_of(tasks[name], robot, here, way) if name in tasks and name not in refused else ""
        if isinstance(order, str) or not order:
            continue
        kept = within_limits(drone, drone.flown(order), here, check)
        if isinstance(kept, str):
            refused[name] = kept
            continue
        if len(kept) > len(order):
            _log.warning(
                "%s: the way to task %s is flown round its autopilot's fence, longer than planned", robot.id, name
            )
        here = kept[-1].position
    home = drone.home or drone.telemetry.start
    if refused_home := drone.limits.fence.refusal([home], here):
        _log.warning("%s: its return home after its last task: %s", robot.id, refused_home)
    yield from ((robot.id, task, f"{Kind.OUTSIDE_FENCE.words}: {why}") for task, why in refused.items())
