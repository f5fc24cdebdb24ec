"""From the lanes of a mission to a network: their nodes, points in between where several robots fit, and their ways."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise
from typing import NamedTuple

import numpy as np

from muster import core
from muster.mission.lanes import Lane, Lanes
from muster.mission.values.arrays import Floats
from muster.motion.free_space import GridSpace, PolygonSpace
from muster.motion.paths import PathFinder
from muster.traffic.exact_ways import Network, with_place
from muster.traffic.lane_sections import ON_LANE_M, Section, sections
from muster.traffic.part import planar

_WHOLE = 1e-9
"""Of a lane's length: as many robots fit as do, whatever float64 says."""
_CLEAR = 1 + 1e-6
"""Who stops beside another lane keeps clear of it whatever float64 says."""
_JUST_ON_M = 1e-3
"""A place that is no farther from it is a point of the lane: all who drive there come by it."""


@dataclass(frozen=True)
class ClosedLane:
    """A lane that a robot of some radius cannot drive: its number, from 0, and why."""

    number: int
    reason: str


class LaneNetwork(NamedTuple):
    """A directed network of lanes, the greatest speed (m,) on its edges, and the sections of lanes with a capacity."""

    made: Network
    speed_mps: Floats
    sections: tuple[Section, ...]


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


def limited_lanes(lanes: Lanes) -> list[core.LimitedLane]:
    """The lanes on which only so many robots may be."""
    return [
        core.LimitedLane(
            planar(lanes.nodes[lane.start]), planar(lanes.nodes[lane.end]), most=lane.capacity, both_ways=lane.both_ways
        )
        for lane in lanes.edges
        if lane.capacity is not None
    ]


def lane_network(
    lanes: Lanes,
    radius_m: float,
    apart_m: float,
    places: Floats,
    space: GridSpace | PolygonSpace | None,
    *,
    most_points: int,
) -> LaneNetwork:
    """The directed network of the lanes that robots of a radius can drive.

    A lane for several robots has points at which they may stop one behind the other: as many less one as may be on it.
    Who stops there is out of the way of all who drive another lane to or from its nodes: one that waits for somebody
    in a sharp corner would else stand in the way by which that one is to leave, and one-way it cannot go back. Places
    on a lane are such points wherever they are.

    Parameters
    ----------
    apart_m
        two robots whose centres are so far apart do not touch.
    most_points
        on all lanes together, about: longer lanes have points further apart.
    places
        (k, 2) metres: each that is on no lane is joined to the nearest point that it can be driven to straight.
    space
        what is free for these robots; None where there is no map.
    """
    from scipy.spatial import cKDTree

    finder = None if space is None else PathFinder(space)
    closed = {lane.number for lane in closed_lanes(lanes, radius_m, finder)}
    numbers = {name: k for k, name in enumerate(lanes.nodes)}
    points = [np.array(place[:2], dtype=np.float64) for place in lanes.nodes.values()]
    edges: list[tuple[int, int]] = []
    parts: list[Section] = []
    clearance: list[float] = []
    speeds: list[float] = []
    spacing_m = max(apart_m, sum(_length_m(lanes, lane) for lane in lanes.edges) / most_points)
    drivable = [lane for number, lane in enumerate(lanes.edges) if number not in closed]
    own: dict[int, int] = {}  # of places on lanes, their points
    for lane in drivable:
        start, end = points[numbers[lane.start]], points[numbers[lane.end]]
        inner: list[tuple[float, int]] = []
        for place, share in _places_on(start, end, places):
            if place not in own:
                own[place] = len(points)
                points.append(places[place])
            inner.append((share, own[place]))
        stretch = _Stretch.of(lanes, lane, drivable, apart_m)
        for share in stretch.shares(lane.capacity, spacing_m, [share for share, _ in inner]):
            inner.append((share, len(points)))
            points.append(start + share * (end - start))
        stops = [numbers[lane.start], *(point for _, point in sorted(inner)), numbers[lane.end]]
        if lane.capacity is not None:
            shares = [share for share, _ in sorted(inner)]
            parts += sections(start, end, shares, lane.capacity, both_ways=lane.both_ways)
        ways = list(pairwise(stops)) + (list(pairwise(stops[::-1])) if lane.both_ways else [])
        edges += ways
        clearance += [_clearance(lane, radius_m, known=space is None)] * len(ways)
        speeds += [lane.speed_mps or math.inf] * len(ways)
    none = np.full(len(places), -1, dtype=np.int64)
    pairs = np.reshape(np.array(edges, dtype=np.int64), (-1, 2))
    made = Network(np.array(points), np.ones(len(points), dtype=np.bool_), pairs, np.array(clearance), none)
    nodes = cKDTree(made.points)
    for place, at in enumerate(places):
        if place in own:
            made = made.with_place(place, own[place])
            continue
        made = with_place(made, place, at, finder, nodes, both_ways=True)
    on_lanes, joined = np.split(made.points[made.edges], [len(edges)])
    return LaneNetwork(made, np.append(speeds, speeds_along(joined, on_lanes, np.array(speeds))), tuple(parts))


def speeds_along(pieces: Floats, lanes: Floats, speeds_mps: Floats) -> Floats:
    """The greatest speed (k,) on straight pieces (k, 2, 2): the least of the lanes (m, 2, 2) on which they lie."""
    import shapely

    if not len(pieces) or not len(lanes):
        return np.full(len(pieces), np.inf)
    lines = shapely.linestrings(lanes)
    ends = np.array(shapely.points(pieces))[:, :, np.newaxis]
    away_m: Floats = shapely.distance(ends, lines).max(axis=1)
    return np.asarray(np.where(away_m <= ON_LANE_M, speeds_mps, np.inf).min(axis=1))


def _length_m(lanes: Lanes, lane: Lane) -> float:
    return math.dist(lanes.nodes[lane.start][:2], lanes.nodes[lane.end][:2])


def _places_on(start: Floats, end: Floats, places: Floats) -> list[tuple[int, float]]:
    """The places (k, 2) between the ends of a lane, by number, and at which share of its length they are."""
    along = end - start
    squared = float(along @ along)
    shares = (places - start) @ along / squared
    off_m = np.linalg.norm(places - start - shares[:, np.newaxis] * along, axis=1)
    between = np.flatnonzero((off_m <= _JUST_ON_M) & (shares > _WHOLE) & (shares < 1 - _WHOLE))
    return [(int(place), float(shares[place])) for place in between]


@dataclass(frozen=True)
class _Stretch:
    """The part of a lane that robots share evenly; metres from where the lane begins."""

    begin_m: float
    end_m: float
    lane_m: float

    @classmethod
    def of(cls, lanes: Lanes, lane: Lane, others: Sequence[Lane], apart_m: float) -> _Stretch:
        """All of the lane, but for what the other lanes at its nodes take of it."""
        long_m = _length_m(lanes, lane)
        taken = [_taken_m(lanes, lane, node, others, apart_m) for node in (lane.start, lane.end)]
        return cls(taken[0], long_m - taken[1], long_m)

    def shares(self, capacity: int | None, apart_m: float, taken: Sequence[float]) -> list[float]:
        """Where, as shares of the lane, robots may stop: evenly apart, without the next to each that is taken.

        So no more robots stop on a lane with places than on one without.
        """
        long_m = self.end_m - self.begin_m
        fitting = max(1, math.floor(long_m / apart_m * (1 + _WHOLE)))
        pieces = fitting if capacity is None else min(capacity, fitting)
        shares = [(self.begin_m + k / pieces * long_m) / self.lane_m for k in range(1, pieces)]
        for at in taken:
            if shares:
                shares.remove(min(shares, key=lambda share: abs(share - at)))
        return shares


def _taken_m(lanes: Lanes, lane: Lane, node: str, others: Sequence[Lane], apart_m: float) -> float:
    """How much farther than `apart_m` from one of its nodes a lane is clear of all other lanes there."""
    at, own = np.array(lanes.nodes[node][:2]), {lane.start, lane.end}
    (far,) = own - {node}
    along = (np.array(lanes.nodes[far][:2]) - at) / _length_m(lanes, lane)
    taken_m = 0.0
    for other in others:
        ends = {other.start, other.end}
        if node in ends and ends != own:
            (beyond,) = ends - {node}
            way = np.array(lanes.nodes[beyond][:2]) - at
            taken_m = max(taken_m, _clear_from_m(along, way, apart_m) - apart_m)
    return taken_m


def _clear_from_m(along: Floats, way: Floats, apart_m: float) -> float:
    """How far along a direction (2,), from the beginning of a straight way (2,), all is `apart_m` from that way."""
    way_m = float(np.linalg.norm(way))
    forward = float(along @ way) / way_m
    if forward <= _WHOLE:
        return apart_m
    aside = abs(float(along[0] * way[1] - along[1] * way[0])) / way_m
    clear_m = apart_m * _CLEAR
    if clear_m * forward <= way_m * aside:
        return clear_m / aside
    # It is clear only beyond the end of the way.
    return way_m * forward + math.sqrt(clear_m**2 - (way_m * aside) ** 2)


def _clearance(lane: Lane, radius_m: float, *, known: bool) -> float:
    """What the width leaves to spare; over a map nothing but that it is free."""
    if not known:
        return 0.0
    return math.inf if lane.width_m is None else lane.width_m / 2 - radius_m
