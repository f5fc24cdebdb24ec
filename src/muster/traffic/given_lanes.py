"""From the lanes of a mission to a network: their nodes, points in between where several robots fit, and their ways."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass
from itertools import pairwise

import numpy as np
import numpy.typing as npt

from muster.mission.lanes import Lane, Lanes
from muster.motion.free_space import GridSpace, PolygonSpace
from muster.motion.paths import PathFinder
from muster.traffic.exact_ways import Network, with_place

Floats = npt.NDArray[np.float64]

_WHOLE = 1e-9
"""Of a lane's length: as many robots fit as do, whatever float64 says."""


@dataclass(frozen=True)
class ClosedLane:
    """A lane that a robot of some radius cannot drive: its number, from 0, and why."""

    number: int
    reason: str


def closed_lanes(lanes: Lanes, radius_m: float, finder: PathFinder | None) -> list[ClosedLane]:
    """The lanes that robots of a radius cannot drive; without a finder there are no obstacles."""
    found = []
    for number, lane in enumerate(lanes.edges):
        ends = np.array([lanes.nodes[lane.start], lanes.nodes[lane.end]])
        if lane.width_m is not None and lane.width_m < 2 * radius_m:
            found.append(ClosedLane(number, f"{lane.width_m:g} m wide, diameter {2 * radius_m:g} m"))
        elif finder is not None and not finder.clear(ends):
            found.append(ClosedLane(number, f"too near to an obstacle for radius {radius_m:g} m"))
    return found


def lane_network(
    lanes: Lanes,
    radius_m: float,
    apart_m: float,
    places: Floats,
    space: GridSpace | PolygonSpace | None,
    *,
    most_points: int,
) -> tuple[Network, Floats]:
    """The directed network of the lanes that robots of a radius can drive, and the greatest speed (m,) on its edges.

    A lane for several robots has points at which they may stop one behind the other: as many less one as may be on it.

    Parameters
    ----------
    apart_m
        two robots whose centres are so far apart do not touch.
    most_points
        on all lanes together, about: longer lanes have points further apart.
    places
        (k, 2) metres: each is joined to the nearest point that it can be driven to straight.
    space
        what is free for these robots; None where there is no map.
    """
    from scipy.spatial import cKDTree

    finder = None if space is None else PathFinder(space)
    closed = {lane.number for lane in closed_lanes(lanes, radius_m, finder)}
    numbers = {name: k for k, name in enumerate(lanes.nodes)}
    points = [np.array(place[:2], dtype=np.float64) for place in lanes.nodes.values()]
    edges: list[tuple[int, int]] = []
    clearance: list[float] = []
    speeds: list[float] = []
    apart_m = max(apart_m, sum(_length_m(lanes, lane) for lane in lanes.edges) / most_points)
    for number, lane in enumerate(lanes.edges):
        if number in closed:
            continue
        inner = list(_between(points[numbers[lane.start]], points[numbers[lane.end]], lane.capacity, apart_m))
        stops = [numbers[lane.start], *range(len(points), len(points) + len(inner)), numbers[lane.end]]
        points += inner
        ways = list(pairwise(stops)) + (list(pairwise(stops[::-1])) if lane.both_ways else [])
        edges += ways
        clearance += [_clearance(lane, radius_m, known=space is None)] * len(ways)
        speeds += [lane.speed_mps or math.inf] * len(ways)
    none = np.full(len(places), -1, dtype=np.int64)
    pairs = np.reshape(np.array(edges, dtype=np.int64), (-1, 2))
    made = Network(np.array(points), np.ones(len(points), dtype=np.bool_), pairs, np.array(clearance), none)
    nodes = cKDTree(made.points)
    for place, at in enumerate(places):
        made = with_place(made, place, at, finder, nodes, both_ways=True)
    speeds += [math.inf] * (len(made.edges) - len(speeds))
    return made, np.array(speeds)


def _length_m(lanes: Lanes, lane: Lane) -> float:
    return math.dist(lanes.nodes[lane.start][:2], lanes.nodes[lane.end][:2])


def _between(start: Floats, end: Floats, capacity: int | None, apart_m: float) -> Iterator[Floats]:
    """The points between the ends of a lane, evenly apart."""
    fitting = max(1, math.floor(float(np.linalg.norm(end - start)) / apart_m * (1 + _WHOLE)))
    pieces = fitting if capacity is None else min(capacity, fitting)
    for k in range(1, pieces):
        yield start + k / pieces * (end - start)


def _clearance(lane: Lane, radius_m: float, *, known: bool) -> float:
    """What the width leaves to spare; over a map nothing but that it is free."""
    if not known:
        return 0.0
    return math.inf if lane.width_m is None else lane.width_m / 2 - radius_m
