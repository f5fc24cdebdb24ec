"""From the lanes of a mission to a network: their nodes, points in between where several robots fit, and their ways."""

from __future__ import annotations

import math
from collections import defaultdict
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from itertools import pairwise
from typing import NamedTuple

import numpy as np

from muster import core
from muster.mission.lanes import Lane, Lanes
from muster.mission.values.arrays import Floats
from muster.motion.free_space import GridSpace, PolygonSpace
from muster.motion.paths import PathFinder, lane_joints
from muster.motion.paths.lane_joints import ON_LANE_M, ClosedLane, Joint, Joints
from muster.motion.port import planar
from muster.traffic.roadmaps import lane_sections
from muster.traffic.roadmaps.exact_ways import Network
from muster.traffic.roadmaps.lane_sections import Section, sections

_WHOLE = 1e-9
"""Of a lane's length: as many robots fit as do, whatever float64 says."""
_CLEAR = 1 + 1e-6
"""Who stops beside another lane keeps clear of it whatever float64 says."""
_SAME_M = 1e-9
"""A place that is nearer to a node is this node."""


class LaneNetwork(NamedTuple):
    """A directed network of lanes, the greatest speed (m,) on its edges, and the sections of lanes with a capacity."""

    made: Network
    speed_mps: Floats
    sections: tuple[Section, ...]


def closed_lanes(lanes: Lanes, radius_m: float, finder: PathFinder | None) -> list[ClosedLane]:
    """The lanes that robots of a radius cannot drive; without a finder there are no obstacles."""
    return lane_joints.closed_lanes(lanes, radius_m, None if finder is None else finder.clear)


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
        (k, 2) metres: each that is on no lane is joined to the nearest point of a lane to which a straight way leads.
    space
        what is free for these robots; None where there is no map.
    """
    finder = None if space is None else PathFinder(space)
    closed = {lane.number for lane in closed_lanes(lanes, radius_m, finder)}
    drivable = [number for number in range(len(lanes.edges)) if number not in closed]
    joints = Joints.of(lanes, drivable, None if finder is None else finder.clear)
    own = _Places.of(lanes, joints, places)
    beside = _Beside.of(lanes, drivable, apart_m)
    points, edges = own.points, list[tuple[int, int]]()
    parts: list[Section] = []
    clearance: list[float] = []
    speeds: list[float] = []
    spacing_m = max(apart_m, sum(_length_m(lanes, lane) for lane in lanes.edges) / most_points)
    for number, ends, (first, last) in zip(drivable, joints.ends, joints.nodes.tolist(), strict=True):
        lane, inner = lanes.edges[number], own.inner.get(number, [])
        stretch = _Stretch.of(lanes, lane, beside)
        for share in stretch.shares(lane.capacity, spacing_m, [share for share, _ in inner]):
            inner.append((share, len(points)))
            points.append(ends[0] + share * (ends[1] - ends[0]))
        stops = [first, *(point for _, point in sorted(inner)), last]
        if lane.capacity is not None:
            shares = [share for share, _ in sorted(inner)]
            parts += sections(ends[0], ends[1], shares, lane.capacity, both_ways=lane.both_ways)
        ways = list(pairwise(stops)) + (list(pairwise(stops[::-1])) if lane.both_ways else [])
        edges += ways
        clearance += [_clearance(lane, radius_m, known=space is None)] * len(ways)
        speeds += [lane.speed_mps or math.inf] * len(ways)
    stubs = [way for stub in own.stubs for way in (stub, stub[::-1])]
    pairs = np.reshape(np.array(edges + stubs, dtype=np.int64), (-1, 2))
    known = np.append(clearance, np.zeros(len(stubs)))
    made = Network(
        np.array(points), np.ones(len(points), dtype=np.bool_), pairs, known, np.array(own.numbers, dtype=np.int64)
    )
    return LaneNetwork(made, np.append(speeds, np.full(len(stubs), np.inf)), tuple(parts))


@dataclass(frozen=True)
class _Places:
    """The points of lanes so far, nodes first, and how places are joined to them.

    Parameters
    ----------
    inner
        by lane the points between its ends, each with the share of its length at which it is.
    stubs
        between places beside lanes and where these are joined.
    numbers
        the point of each place; -1: it is joined to no lane.
    """

    points: list[Floats]
    inner: dict[int, list[tuple[float, int]]]
    stubs: list[tuple[int, int]]
    numbers: list[int]

    @classmethod
    def of(cls, lanes: Lanes, joints: Joints, places: Floats) -> _Places:
        nodes = [np.array(place[:2], dtype=np.float64) for place in lanes.nodes.values()]
        made = cls(nodes, {}, [], [-1] * len(places))
        joined = [joints.joint(place) for place in places]
        for on_lane in (True, False):  # places on lanes are points of these, so that others are joined to them
            for k, joint in enumerate(joined):
                if joint is not None and (joint.node < 0 and joint.away_m <= ON_LANE_M) == on_lane:
                    made._join(k, places[k], joint, lanes)
        return made

    def _join(self, place: int, at: Floats, joint: Joint, lanes: Lanes) -> None:
        if joint.node >= 0 and joint.away_m < _SAME_M:
            self.numbers[place] = joint.node
            return
        on_lane = joint.node < 0 and joint.away_m <= ON_LANE_M
        joined = joint.node if joint.node >= 0 else self._point_on(at if on_lane else joint.at, joint, lanes)
        self.numbers[place] = joined
        if not on_lane:
            self.numbers[place] = len(self.points)
            self.points.append(at)
            self.stubs.append((self.numbers[place], joined))

    def _point_on(self, at: Floats, joint: Joint, lanes: Lanes) -> int:
        """The point of lanes at which a place is joined, which may be there already."""
        shares = [(lane, metres / _length_m(lanes, lanes.edges[lane])) for lane, metres in joint.on]
        for lane, _ in shares:
            for _, point in self.inner.get(lane, ()):
                if np.linalg.norm(self.points[point] - at) <= ON_LANE_M and joint.away_m > ON_LANE_M:
                    return point
        for lane, share in shares:
            self.inner.setdefault(lane, []).append((share, len(self.points)))
        self.points.append(at)
        return len(self.points) - 1


def speeds_along(pieces: Floats, lanes: Floats, speeds_mps: Floats) -> Floats:
    """The greatest speed (k,) on straight pieces (k, 2, 2): the least of the lanes (m, 2, 2) on which they lie."""
    import shapely

    if not len(pieces) or not len(lanes):
        return np.full(len(pieces), np.inf)
    lines = shapely.linestrings(lanes)
    ends = np.array(shapely.points(pieces))[:, :, np.newaxis]
    away_m: Floats = shapely.distance(ends, lines).max(axis=1)
    return np.asarray(np.where(away_m <= lane_sections.ON_LANE_M, speeds_mps, np.inf).min(axis=1))


def _length_m(lanes: Lanes, lane: Lane) -> float:
    return math.dist(lanes.nodes[lane.start][:2], lanes.nodes[lane.end][:2])


@dataclass(frozen=True)
class _Beside:
    """By node what each lane at it takes of the others there: see `taken_m`."""

    lanes: Lanes
    at_node: Mapping[str, Sequence[Lane]]
    apart_m: float

    @classmethod
    def of(cls, lanes: Lanes, drivable: Sequence[int], apart_m: float) -> _Beside:
        at_node = defaultdict[str, list[Lane]](list)
        for number in drivable:
            for node in (lanes.edges[number].start, lanes.edges[number].end):
                at_node[node].append(lanes.edges[number])
        return cls(lanes, at_node, apart_m)

    def taken_m(self, lane: Lane, node: str) -> float:
        """How much farther than `apart_m` from one of its nodes a lane is clear of all other lanes there."""
        at, own = np.array(self.lanes.nodes[node][:2]), {lane.start, lane.end}
        (far,) = own - {node}
        along = (np.array(self.lanes.nodes[far][:2]) - at) / _length_m(self.lanes, lane)
        taken_m = 0.0
        for other in self.at_node[node]:
            ends = {other.start, other.end}
            if ends != own:
                (beyond,) = ends - {node}
                way = np.array(self.lanes.nodes[beyond][:2]) - at
                taken_m = max(taken_m, _clear_from_m(along, way, self.apart_m) - self.apart_m)
        return taken_m


@dataclass(frozen=True)
class _Stretch:
    """The part of a lane that robots share evenly; metres from where the lane begins."""

    begin_m: float
    end_m: float
    lane_m: float

    @classmethod
    def of(cls, lanes: Lanes, lane: Lane, beside: _Beside) -> _Stretch:
        """All of the lane, but for what the other lanes at its nodes take of it."""
        long_m = _length_m(lanes, lane)
        taken = [beside.taken_m(lane, node) for node in (lane.start, lane.end)]
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
