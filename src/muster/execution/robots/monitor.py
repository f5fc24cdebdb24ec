"""The monitor's findings about a robot: it is silent, it makes no progress, or it will use more than its capacity.

A robot that waits in traffic does not count as stuck, however long that takes (`traffic_waits`).
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import asdict, dataclass

from muster.execution.robots.robot_state import Activity, RobotState
from muster.mission.errors import ParameterError
from muster.mission.model import Robot
from muster.motion.kinematics.registry import limits_of
from muster.motion.port import Place

_ROUNDING = 1e-6  # relative and absolute; by how much usage may be above capacity
_MOVED_M = 0.2  # by which one that was stuck has to be elsewhere, at least
_LEAST_SHARE = 0.05  # of its speed, with which a robot gets on


@dataclass(frozen=True, kw_only=True)
class Limits:
    """How long what may last.

    Parameters
    ----------
    silent_after_s
        a robot that has said nothing new for longer counts as silent.
    stuck_after_s
        a robot that gets on by less than a twentieth of its speed for so long, while nobody is in its way, is sent
        again, and the next time out.
    aside_after_s, aside_s
        of robots that hold each other up for so long one after the other stands aside for a while.
    jam_after_s
        a jam that lasts longer is told; when it has lasted twice as long, one of its robots gives up its task.
    look_every_s
        how often robots are looked at; at most as often as the executor ticks.
    absent_for_s
        where tasks are left that nobody else does, the mission waits for so long for a robot that is silent or
        suspended; 0: it does not wait.
    """

    silent_after_s: float = 5.0
    stuck_after_s: float = 30.0
    aside_after_s: float = 5.0
    aside_s: float = 5.0
    jam_after_s: float = 30.0
    look_every_s: float = 0.5
    absent_for_s: float = 0.0

    def __post_init__(self) -> None:
        for name, seconds in asdict(self).items():
            if not (seconds > 0 or (name == "absent_for_s" and seconds == 0)):
                raise ParameterError(f"{name}: {seconds}; expected seconds above 0")


def is_silent(state: RobotState, now: float, limits: Limits) -> bool:
    """Whether telemetry is missed."""
    return now - state.last_heard_s > limits.silent_after_s


def is_stuck(state: RobotState, now: float, limits: Limits) -> bool:
    """Whether a robot makes no progress: its path grows no shorter, or its work takes far too long."""
    if state.activity is Activity.WORKING:
        return now > state.nearest_s + 2 * state.work_s + limits.stuck_after_s
    if state.activity is Activity.SERVED:
        return now > state.nearest_s + 2 * state.service_s + limits.stuck_after_s
    if state.activity not in (Activity.DRIVING, Activity.RETURNING, Activity.TO_STATION):
        return False
    left = state.way_left_m
    least_m = _LEAST_SHARE * state.robot.speed_mps * limits.stuck_after_s
    if left < state.nearest_m - least_m or _led_about(state):
        state.nearest_m, state.nearest_s, state.nearest_at = left, now, state.position
    arrives = left < least_m and not (state.steered or state.makes_room)
    return now - state.nearest_s > limits.stuck_after_s * (2 if arrives else 1)


def _led_about(state: RobotState) -> bool:
    """Whether traffic has led a robot elsewhere, be it out of the way of others: it drives, so it is not stuck."""
    return state.steered and math.dist(state.position, state.nearest_at) > _MOVED_M


def moves_again(state: RobotState) -> bool:
    """Whether a robot that was put out is elsewhere by now, farther than it took to brake."""
    if state.out_at is None:
        return False
    braking_m = limits_of(state.robot).braking_m(state.robot.speed_mps)
    return math.dist(state.position, state.out_at) > braking_m + max(_MOVED_M, state.robot.radius_m)


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
