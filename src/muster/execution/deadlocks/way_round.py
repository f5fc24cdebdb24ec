"""Ways round robots that stand, and out of the way of others, for robots that nobody steers."""

from __future__ import annotations

import math
from collections.abc import Collection, Iterator, Sequence
from itertools import pairwise, product

from muster.execution.robots.monitor import distance_to_piece
from muster.execution.robots.task_motion import Way, path_length, places_of
from muster.mission.model import Robot
from muster.motion.port import Place, Waypoint

_TIMES_APART = (1.2, 1.5, 2.0)
"""How far from the middle of the one to get round the way may turn, in distances at which the two touch."""
_TIMES_ASIDE = (0.5, 1.0, 1.5, 2.0, 3.0)
"""The same of how far from where it is a robot may make room."""
_TURNS = 12
_SPARE_M = 0.05

Standing = tuple[Place, float]
"""Where a robot stands, and its radius, m."""


def way_round(
    way: Way, robot: Robot, start: Place, goal: Place, about: Standing, others: Collection[Standing]
) -> Sequence[Waypoint] | None:
    """The shortest way that turns near a robot that stands there, and keeps clear of this and others; or None."""
    from scipy.sparse import csr_matrix
    from scipy.sparse.csgraph import dijkstra

    turns = {number: _turn(robot, start, about, number) for number in product(range(len(_TIMES_APART)), range(_TURNS))}
    places = [start, *turns.values(), goal]
    pieces = {}
    for a, b in _joined(list(turns)):
        piece = way(robot, places[a], places[b])
        if piece is not None and _is_clear(robot, start, [places[a], *places_of(piece)], (about, *others)):
            pieces[a, b] = piece
    if not pieces:
        return None
    lengths = [path_length(places[a], piece) for (a, _), piece in pieces.items()]
    graph = csr_matrix((lengths, tuple(zip(*pieces, strict=True))), shape=(len(places), len(places)))
    _, before = dijkstra(graph, indices=0, return_predecessors=True)
    at, found = len(places) - 1, list[Waypoint]()
    while before[at] >= 0:
        found, at = [*pieces[before[at], at], *found], before[at]
    return found or None


def way_aside(
    way: Way, robot: Robot, start: Place, needed: Sequence[Place], radius_m: float, others: Collection[Standing]
) -> Sequence[Waypoint] | None:
    """The way to a near place beside a way that another, of a radius, needs; clear of others who stand; or None."""
    apart_m = robot.radius_m + radius_m + _SPARE_M
    for times, direction in product(_TIMES_ASIDE, range(_TURNS)):
        place = _beside(start, times * apart_m, direction)
        aside_m = min(distance_to_piece(place, *piece) for piece in pairwise(needed))
        found = way(robot, start, place) if aside_m >= apart_m else None
        if found is not None and _is_clear(robot, start, [start, *places_of(found)], others):
            return found
    return None


def _turn(robot: Robot, start: Place, about: Standing, number: tuple[int, int]) -> Place:
    """A place beside the one to get round."""
    (x, y, _), radius_m = about
    ring, direction = number
    return _beside((x, y, start[2]), _TIMES_APART[ring] * (radius_m + robot.radius_m + _SPARE_M), direction)


def _beside(place: Place, away_m: float, direction: int) -> Place:
    angle = 2 * math.pi * direction / _TURNS
    return (place[0] + away_m * math.cos(angle), place[1] + away_m * math.sin(angle), place[2])


def _joined(turns: Sequence[tuple[int, int]]) -> Iterator[tuple[int, int]]:
    """Which places a way may join, by number: the start, 0, with all turns, these with their neighbours and the end."""
    for a, (ring, direction) in enumerate(turns, 1):
        yield 0, a
        yield a, len(turns) + 1
        for b, (other, to) in enumerate(turns, 1):
            steps = (to - direction) % _TURNS
            if (ring == other and steps in (1, _TURNS - 1)) or (steps == 0 and abs(ring - other) == 1):
                yield a, b


def _is_clear(robot: Robot, start: Place, places: Sequence[Place], standing: Collection[Standing]) -> bool:
    return all(_passes(robot, start, piece, other) for piece in pairwise(places) for other in standing)


def _passes(robot: Robot, start: Place, piece: tuple[Place, Place], other: Standing) -> bool:
    """Whether a straight piece keeps clear of who stands somewhere, or comes no nearer than the robot is already."""
    place, radius_m = other
    apart_m = min(robot.radius_m + radius_m + _SPARE_M, math.dist(start, place))
    return distance_to_piece(place, *piece) >= apart_m - 1e-9
