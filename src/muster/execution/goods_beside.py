"""Where goods are fetched that lie in the body of a robot that failed: the nearest free place beside it."""

from __future__ import annotations

import math
from collections.abc import Collection, Sequence

from muster.execution.robots.robot_state import RobotState
from muster.execution.robots.task_motion import Way, path_length
from muster.mission.model import Task
from muster.motion.kinematics.registry import limits_of
from muster.motion.port import Place

_SPARE_M = 0.1
"""What is kept from the body beyond touching: more than ways round it keep."""
_RINGS_M = (0.0, 0.25, 0.5, 1.0, 2.0)
_TURNS = 24


def fetching_place(broken: RobotState, task: Task, crew: Collection[RobotState], way: Way) -> Place:
    """Return where goods of a failed robot can be fetched: where it stands, if nobody's body is in the way there.

    Else it is the place that is nearest to the body, and among these to a robot that can fetch the goods, of those that
    such a robot can reach and stand at beside all robots that are out.

    Parameters
    ----------
    broken
        the robot that failed.
    task
        which took the goods on board.
    crew
        all robots.
    way
        the ways that robots go.
    """
    here = broken.position
    able = [state for state in crew if not state.out and _may_fetch(state, task)]
    widest_m = max((state.robot.radius_m for state in able), default=0.0)
    if not able or broken.robot.radius_m + widest_m <= 0:
        return here
    apart_m = broken.robot.radius_m + widest_m + _SPARE_M
    bodies = [(place, state.robot.radius_m + widest_m) for state in crew if state.out for place in _stands(state)]
    for ring_m in _RINGS_M:
        places = [_beside(here, apart_m + ring_m, turn) for turn in range(_TURNS)]
        # On the far side of how far it took to brake no place of the first ring may be free.
        free = [p for p in places if all(math.dist(p, body) >= reach_m + _SPARE_M / 2 for body, reach_m in bodies)]
        lengths = {place: min(_way_m(state, place, way) for state in able) for place in free}
        nearest = min(free, key=lengths.__getitem__, default=here)
        if free and math.isfinite(lengths[nearest]):
            return nearest
    return here


def _may_fetch(state: RobotState, task: Task) -> bool:
    locked = task.only_robots is not None and state.robot.id not in task.only_robots
    return not locked and set(task.requires) <= set(state.robot.skills)


def _stands(state: RobotState) -> Sequence[Place]:
    """Where a robot that is out was last heard, and as far on as it takes to brake."""
    velocity = (0.0, 0.0, 0.0) if state.telemetry is None else state.telemetry.velocity
    speed, most = math.hypot(*velocity), limits_of(state.robot).acceleration_mps2
    x, y, z = (c + v * speed / (2 * most) for c, v in zip(state.position, velocity, strict=True))
    return state.position, (x, y, z)


def _way_m(state: RobotState, place: Place, way: Way) -> float:
    """The length of a robot's way to a place; inf where there is none."""
    found = way(state.robot, state.position, place)
    return math.inf if found is None else path_length(state.position, found)


def _beside(place: Place, away_m: float, turn: int) -> Place:
    angle = 2 * math.pi * turn / _TURNS
    return place[0] + away_m * math.cos(angle), place[1] + away_m * math.sin(angle), place[2]
