"""A way round robots that are out, for one that nobody steers."""

from __future__ import annotations

import math
from collections.abc import Collection, Iterator, Sequence
from itertools import pairwise

from muster.execution.monitor import distance_to_piece
from muster.execution.task_motion import Way, along, path_length
from muster.mission.model import Robot
from muster.motion.port import Place

_TIMES_APART = (1.2, 1.5, 2.0)
"""How far from the middle of the one to get round the way may turn, in distances at which the two touch."""
_DIRECTIONS = 12
_SPARE_M = 0.05

Standing = tuple[Place, float]
"""Where a robot stands, and its radius, m."""


def way_round(
    way: Way, robot: Robot, start: Place, goal: Place, about: Standing, others: Collection[Standing]
) -> Sequence[Place] | None:
    """The shortest way that turns once near a robot that stands there, and keeps clear of this and others; or None."""

    def is_clear(places: Sequence[Place]) -> bool:
        return all(_passes(robot, start, piece, other) for piece in pairwise(places) for other in (about, *others))

    ways = ([*first, *second] for first, second in _ways(way, robot, start, goal, about))
    clear = [places for places in ways if is_clear([start, *places])]
    return min(clear, key=lambda places: path_length(start, along(places)), default=None)


def _ways(
    way: Way, robot: Robot, start: Place, goal: Place, about: Standing
) -> Iterator[tuple[Sequence[Place], Sequence[Place]]]:
    (x, y, _), radius_m = about
    for times in _TIMES_APART:
        for k in range(_DIRECTIONS):
            angle, away_m = 2 * math.pi * k / _DIRECTIONS, times * (radius_m + robot.radius_m + _SPARE_M)
            turn = (x + away_m * math.cos(angle), y + away_m * math.sin(angle), start[2])
            first, second = way(robot, start, turn), way(robot, turn, goal)
            if first is not None and second is not None:
                yield first, second


def _passes(robot: Robot, start: Place, piece: tuple[Place, Place], other: Standing) -> bool:
    """Whether a straight piece keeps clear of who stands somewhere, or comes no nearer than the robot is already."""
    place, radius_m = other
    apart_m = min(robot.radius_m + radius_m + _SPARE_M, math.dist(start, place))
    return distance_to_piece(place, *piece) >= apart_m - 1e-9
