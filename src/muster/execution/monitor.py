"""What the monitor notices of a robot: that it is silent, does not get on, or will use more than it can."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

from muster.execution.hand import Activity, Hand
from muster.mission.errors import ParameterError
from muster.mission.model import Robot
from muster.motion.port import Place

_ROUNDING = 1e-6  # relative and absolute; by how much usage may be above capacity
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


def is_silent(hand: Hand, now: float, limits: Limits) -> bool:
    """Whether telemetry is missed."""
    return now - hand.heard_s > limits.silent_after_s


def is_stuck(hand: Hand, now: float, limits: Limits) -> bool:
    """Whether a robot that should get on does not: its way grows no shorter, or its work takes far too long."""
    if hand.activity is Activity.WORKING:
        return now > hand.begun_s + 2 * hand.work_s + limits.stuck_after_s
    if hand.activity not in (Activity.DRIVING, Activity.RETURNING):
        return False
    left = hand.way_left_m
    if left < hand.nearest_m - _LEAST_SHARE * hand.robot.speed_mps * limits.stuck_after_s:
        hand.nearest_m, hand.nearest_s = left, now
    arrives = left < _LEAST_SHARE * hand.robot.speed_mps * limits.stuck_after_s
    return now - hand.nearest_s > limits.stuck_after_s * (2 if arrives else 1)


def stands_in_the_way(broken: Hand, robot: Robot, points: Sequence[Place]) -> bool:
    """Whether a robot that is out stands so near one of these points that another cannot get there."""
    reach = broken.robot.radius_m + robot.radius_m
    return any(math.dist(broken.position, point) < reach for point in points)


def exceeds(used: float, capacity: float | None) -> bool:
    """Whether a usage is more than a robot can."""
    return capacity is not None and used > capacity * (1 + _ROUNDING) + _ROUNDING
