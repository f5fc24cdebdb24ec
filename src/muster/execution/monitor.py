"""The monitor's findings about a robot: it is silent, it makes no progress, or it will use more than its capacity.

A robot that others hold up who are at work does not count as stuck, however long they take.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

from muster.execution.robot_state import MOVING, Activity, RobotState
from muster.mission.errors import ParameterError
from muster.mission.model import Robot
from muster.motion.kinematics.registry import limits_of
from muster.motion.port import Place

_ROUNDING = 1e-6  # relative and absolute; by how much usage may be above capacity
_ASIDE_M = 0.05  # by which a robot said to be before another may be aside
_LEAST_SHARE = 0.05  # of its speed, with which a robot gets on


@dataclass(frozen=True, kw_only=True)
class Limits:
    """How long what may last.

    Parameters
    ----------
    silent_after_s
        a robot that has said nothing new for longer counts as silent.
    stuck_after_s
        a robot that gets on by less than a twentieth of its speed for so long is sent again, and the next time out.
    look_every_s
        how often robots are looked at; at most as often as the executor ticks.
    """

    silent_after_s: float = 5.0
    stuck_after_s: float = 30.0
    look_every_s: float = 0.5

    def __post_init__(self) -> None:
        for name in ("silent_after_s", "stuck_after_s", "look_every_s"):
            if not getattr(self, name) > 0:
                raise ParameterError(f"{name}: {getattr(self, name)}; expected seconds above 0")


def is_silent(state: RobotState, now: float, limits: Limits) -> bool:
    """Whether telemetry is missed."""
    return now - state.last_heard_s > limits.silent_after_s


def is_stuck(state: RobotState, now: float, limits: Limits) -> bool:
    """Whether a robot makes no progress: its path grows no shorter, or its work takes far too long."""
    if state.activity is Activity.WORKING:
        return now > state.nearest_s + 2 * state.work_s + limits.stuck_after_s
    if state.activity not in (Activity.DRIVING, Activity.RETURNING):
        return False
    if state.telemetry is not None and state.telemetry.waits_for is not None:
        state.nearest_s = now
    left = state.way_left_m
    if left < state.nearest_m - _LEAST_SHARE * state.robot.speed_mps * limits.stuck_after_s:
        state.nearest_m, state.nearest_s = left, now
    arrives = left < _LEAST_SHARE * state.robot.speed_mps * limits.stuck_after_s
    return now - state.nearest_s > limits.stuck_after_s * (2 if arrives else 1)


def seems_late(state: RobotState, now: float, limits: Limits) -> bool:
    """Whether a robot may soon count as stuck."""
    works_s = state.work_s if state.activity is Activity.WORKING else 0.0
    return state.activity in MOVING and now > state.nearest_s + works_s + limits.stuck_after_s / 2


def held_up(crew: Sequence[RobotState]) -> list[RobotState]:
    """Robots under way that are blocked by a robot at work, or by one that is blocked itself.

    Of two that stand close to their way points at work, the one that is nearer to its own holds the other up.
    """
    under_way = [state for state in crew if state.activity in MOVING and state.points_left and state.robot.radius_m > 0]
    stand = [state for state in under_way if _stands_at_work(state)]
    held: list[RobotState] = []
    for one in stand:  # grows
        reached = [state for state in under_way if state not in held and state is not one and _is_before(one, state)]
        reached = [state for state in reached if state not in stand or _off(state) > _off(one)]
        stand += [state for state in reached if state not in stand]
        held += reached
    return held


def _stands_at_work(state: RobotState) -> bool:
    still = state.telemetry is not None and not any(state.telemetry.velocity)
    return state.activity is Activity.WORKING and still and _off(state) <= state.robot.radius_m


def _off(state: RobotState) -> float:
    return math.dist(state.position, state.points_left[0])


def _is_before(other: RobotState, state: RobotState) -> bool:
    """Whether a robot cannot get to its next way point without touching another where that is now."""
    reach = state.robot.radius_m + other.robot.radius_m + _ASIDE_M
    return distance_to_piece(other.position, state.position, state.points_left[0]) < reach


def distance_to_piece(point: Place, start: Place, end: Place) -> float:
    """Metres from a point to the straight piece between two others."""
    along = [b - a for a, b in zip(start, end, strict=True)]
    squared = sum(c * c for c in along)
    share = sum((p - a) * c for p, a, c in zip(point, start, along, strict=True)) / squared if squared > 0 else 0.0
    share = min(1.0, max(0.0, share))
    return math.dist(point, [a + share * c for a, c in zip(start, along, strict=True)])


def stands_in_the_way(broken: RobotState, robot: Robot, points: Sequence[Place]) -> bool:
    """Whether a robot that is out stands so near one of these points that another cannot get there.

    It stands where it was last heard, or as far on as it took to brake.
    """
    reach = broken.robot.radius_m + robot.radius_m
    last, velocity = broken.position, broken.telemetry.velocity if broken.telemetry is not None else (0.0, 0.0, 0.0)
    speed, most = math.hypot(*velocity), limits_of(broken.robot).acceleration_mps2
    stood = tuple(c + v * speed / (2 * most) for c, v in zip(last, velocity, strict=True))
    return any(distance_to_piece(point, last, (stood[0], stood[1], stood[2])) < reach for point in points)


def exceeds(used: float, capacity: float | None) -> bool:
    """Whether a usage exceeds a capacity."""
    return capacity is not None and used > capacity * (1 + _ROUNDING) + _ROUNDING
