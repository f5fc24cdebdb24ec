"""The time of a leg, from rest to rest, as a robot's motion profile has it: for planner and judge alike.

The core has the same formula for legs in `problem.hpp`. Without acceleration, yaw rate or climb rate in the mission, or
with `rules.timing: constant`, a leg takes its length by the robot's speed.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from itertools import pairwise
from typing import Any

import numpy as np

from muster.mission.model import Mission, Point, Robot, Rules
from muster.motion.kinematics.registry import kinematics_named, limits_of

_RIGHT_ANGLE = math.pi / 2
_STRAIGHT = 0.05  # rad: a robot does not slow down for a turn by less
_PIECES, _PIECES_SLIDING = 3, 2
"""Of a way with bends: what stopping at all its bends, and passing gentle ones, comes to on average. Measured against
the kinematic world, see `muster study flown`."""


@dataclass(frozen=True)
class LegTimes:
    """What the time of a leg depends on.

    Parameters
    ----------
    acceleration_mps2, climb_mps
        inf: no limit.
    turn_s
        of the turn by a right angle with which a leg begins, where the robot drives only where it looks: what the true
        turns come to on average.
    over_map
        whether a leg that is longer than the straight line between its ends has bends. In travel tables it has none.
    along_lanes
        whether the robot travels along lanes, so that speeds and bends of its ways are known.
    """

    speed_mps: float
    acceleration_mps2: float = math.inf
    climb_mps: float = math.inf
    turn_s: float = 0.0
    over_map: bool = False
    along_lanes: bool = False

    @classmethod
    def of(cls, robot: Robot, rules: Rules, *, over_map: bool, along_lanes: bool = False) -> LegTimes:
        climb = robot.climb_mps if robot.kind == "air" else None
        stated = (robot.acceleration_mps2, robot.yaw_rate_radps, climb)
        if rules.timing == "constant" or stated == (None, None, None):
            return cls(robot.speed_mps, along_lanes=along_lanes)
        limits = limits_of(robot)
        turns = kinematics_named(robot.kinematics).faces_its_way
        return cls(
            robot.speed_mps,
            limits.acceleration_mps2,
            math.inf if climb is None else climb,
            _RIGHT_ANGLE / limits.yaw_rate_radps if turns else 0.0,
            over_map=over_map,
            along_lanes=along_lanes,
        )

    @classmethod
    def in_mission(cls, robot: Robot, mission: Mission) -> LegTimes:
        """By the mission's own rules and travel."""
        along_lanes = mission.driven_lanes is not None and robot.kind == "ground"
        return cls.of(robot, mission.rules, over_map=mission.travel_off_lanes == "map", along_lanes=along_lanes)

    @cached_property
    def is_constant(self) -> bool:
        """Whether the time is proportional to the length."""
        unlimited = self.acceleration_mps2 == math.inf and self.climb_mps == math.inf
        return unlimited and self.turn_s == 0.0 and not self.over_map and not self.along_lanes

    def seconds(self, metres: Any, rise_m: Any = 0.0, apart_m: Any = math.inf) -> Any:
        """The time of legs; shapes as NumPy's.

        The speed rises to its limit and falls to rest again; on short legs it never gets there. Up and down the robot
        keeps to its path and its climb rate. A leg over a map that is longer than the straight line turns by the least
        angle that this takes, and stops between pieces of equal length: two where the robot can move sideways, else
        three.

        Parameters
        ----------
        metres
            their lengths.
        rise_m, apart_m
            how far apart their ends are: in height, and by a straight line.
        """
        metres = np.asarray(metres, dtype=np.float64)
        if self.is_constant:
            return metres / self.speed_mps
        turned = self._bends(metres, apart_m)
        pieces = np.where(turned > _STRAIGHT, _PIECES if self.turn_s > 0 else _PIECES_SLIDING, 1)
        seconds = pieces * self._ramped(metres / pieces, rise_m / pieces)
        return np.where(metres > 0, seconds + self.turn_s * (1 + turned / _RIGHT_ANGLE), metres)

    def leg_seconds(self, metres: float, rise_m: float, apart_m: float) -> float:
        """The time of one leg, as `seconds` has it."""
        return metres / self.speed_mps if self.is_constant else float(self.seconds(metres, rise_m, apart_m))

    def rest_seconds(self, metres: float, rise_m: float = 0.0, apart_m: float = math.inf) -> float:
        """The time of the rest of a leg for a robot under way: it need not turn nor gather speed any more."""
        return self.under_way(float(self.seconds(metres, rise_m, apart_m)), metres)

    def under_way(self, whole_s: float, metres: float) -> float:
        """Return what a leg of so many metres, which takes a time from rest to rest, takes a robot under way."""
        if self.is_constant or metres <= 0:
            return whole_s
        to_speed = (2.0 - math.sqrt(2.0)) * math.sqrt(metres / self.acceleration_mps2)
        return max(0.0, whole_s - self.turn_s - min(self.stop_s / 2, to_speed))

    @property
    def stop_s(self) -> float:
        """What a stop on the way costs: of a bend by a right angle or more."""
        return self.speed_mps / self.acceleration_mps2

    def bend_s(self, angle_rad: float) -> float:
        """What a bend on the way along lanes costs, as traffic reckons it: slowing down as it must, and turning."""
        share = angle_rad / _RIGHT_ANGLE
        return share * self.turn_s + min(1.0, share) * self.stop_s

    def lane_seconds(self, metres: Any, driven_s: Any) -> Any:
        """The time of legs along lanes; shapes as NumPy's.

        Parameters
        ----------
        metres
            their lengths.
        driven_s
            what they take at the speeds of robot and lanes, bends included; inf where there is no way.
        """
        with np.errstate(invalid="ignore"):  # there may be no way
            ramps = self._ramped(metres, 0.0) - metres / self.speed_mps
        return np.where((metres > 0) & np.isfinite(metres), driven_s + ramps + self.turn_s, driven_s)

    def way_seconds(self, places: Sequence[Point], speeds_mps: Sequence[float]) -> float:
        """Return the time of a way along lanes through places, with the greatest speed on each of its pieces."""
        legs = [(a, b, v) for (a, b), v in zip(pairwise(places), speeds_mps, strict=True) if a != b]
        driven_s = sum(math.dist(a, b) / min(v, self.speed_mps) for a, b, v in legs)
        bends_s = sum(self.bend_s(_turn(a, b, c)) for (a, b, _), (_, c, _) in pairwise(legs))
        return float(self.lane_seconds(sum(math.dist(a, b) for a, b, _ in legs), driven_s + bends_s))

    def least_seconds(self, metres: float, rise_m: float = 0.0) -> float:
        """The least time of a leg: without any turn."""
        return metres / self.speed_mps if self.is_constant else float(self._ramped(metres, rise_m))

    def work_seconds(self, points: Sequence[Point], metres: Sequence[float]) -> float:
        """The time of work that drives: a leg from each point to the next, of so many metres, inf where there is none.

        The robot stops at each of them, and turns there where it drives only where it looks; towards the second by a
        right angle, as at the beginning of any leg.
        """
        if self.is_constant:
            return sum(metres) / self.speed_mps
        legs = [(a, b, m) for (a, b), m in zip(pairwise(points), metres, strict=True) if m > 0]
        driven = sum(float(self.seconds(m, _rise_m(a, b), math.dist(a, b))) - self.turn_s for a, b, m in legs)
        turned = sum(_turn(a, b, c) for (a, b, _), (_, c, _) in pairwise(legs))
        return driven + self.turn_s * (bool(legs) + turned / _RIGHT_ANGLE)

    def _bends(self, metres: Any, apart_m: Any) -> Any:
        """By what angle legs turn on their way, at least, radians."""
        if not self.over_map:
            return np.zeros_like(metres)
        with np.errstate(divide="ignore", invalid="ignore"):
            return 2 * np.arccos(np.clip(np.where(metres > 0, apart_m / metres, 1.0), 0.0, 1.0))

    def _ramped(self, metres: Any, rise_m: Any) -> Any:
        """Straight on, from rest to rest."""
        metres, rise_m = np.asarray(metres, dtype=np.float64), np.asarray(rise_m, dtype=np.float64)
        with np.errstate(divide="ignore", invalid="ignore"):
            climbing = np.where(rise_m > 0, self.climb_mps * metres / rise_m, math.inf)
            speed = np.minimum(self.speed_mps, climbing)
            reaches = metres * self.acceleration_mps2 >= speed * speed
            driven = metres / speed + speed / self.acceleration_mps2
        return np.where(reaches, driven, 2.0 * np.sqrt(metres / self.acceleration_mps2))


def _rise_m(start: Point, end: Point) -> float:
    return abs(end[2] - start[2]) if len(start) > 2 else 0.0


def _turn(before: Point, at: Point, after: Point) -> float:
    """By what angle a robot turns at a point between two others, radians, as seen from above."""
    (ax, ay), (bx, by) = (
        tuple(q - p for p, q in zip(a[:2], b[:2], strict=True)) for a, b in ((before, at), (at, after))
    )
    return abs(math.atan2(ax * by - ay * bx, ax * bx + ay * by))
