"""A roadmap with the places of travellers, and its planner."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property, partial
from itertools import islice
from typing import NamedTuple

import numpy as np

from muster import core
from muster.motion.grid import Floats
from muster.motion.kinematics.registry import kinematics_named, limits_of
from muster.traffic.journeys.travellers import Move, Point, Traveller
from muster.traffic.roadmaps.edge_conflicts import Known, Near, WithConflicts, annotated, conflicts
from muster.traffic.roadmaps.lane_sections import ON_LANE_M
from muster.traffic.roadmaps.roadmap import Indices, Roadmap
from muster.traffic.roadmaps.robot_spaces import RobotSpaces

_SAME_M = 1e-6
_ENTRIES = 6
"""Points of the roadmap to which a place beside it is joined, at most."""
_BLOCKED_M = (0.0, 0.1, 0.3)
"""Metres at a place beside it that may be blocked, where else no point is seen: robots err in where they are."""


class Standing(NamedTuple):
    """A place of a robot, and the layer of the roadmap on which that is."""

    at: Point
    layer: int


@dataclass(frozen=True)
class Network:
    """A roadmap, the numbers of its points by place and layer, and its planner.

    Parameters
    ----------
    ends
        the points of each edge.
    """

    roadmap: Roadmap
    number: Mapping[Standing, int]
    intervals: core.SafeIntervals
    ends: list[tuple[int, int]]

    @classmethod
    def of(cls, roadmap: Roadmap) -> Network:
        standing = zip(roadmap.points.tolist(), roadmap.layer.tolist(), strict=True)
        number = {Standing((x, y), layer): k for k, ((x, y), layer) in enumerate(standing)}
        intervals = core.SafeIntervals(annotated(roadmap), roadmap.holding.tolist(), roadmap.margin_m)
        return cls(roadmap, number, intervals, roadmap.edges.tolist())

    def standing(self, who: Traveller, at: Point) -> Standing:
        """A place as that of a robot."""
        return Standing(at, self.roadmap.layer_for(who.robot.radius_m))

    def point(self, who: Traveller, at: Point) -> int:
        """The number of the point of a robot's place."""
        return self.number[self.standing(who, at)]

    @cached_property
    def edges_by_layer(self) -> list[int]:
        """How many edges each layer has."""
        layers = len(self.roadmap.radii_m)
        found: list[int] = np.bincount(self.roadmap.edge_layer, minlength=layers).tolist()
        return found

    def knows(self, who: Traveller) -> bool:
        """Whether the places of a robot have points."""
        return all(self.standing(who, at) in self.number for at in (who.start, *(stop.at for stop in who.stops)))

    def move(self, traveller: int, edge: int, stop: int) -> Move:
        """A move along an edge."""
        x, y = self.roadmap.points[self.roadmap.edges[edge, 1]]
        return Move(traveller, (float(x), float(y)), stop, float(self.roadmap.speed_mps[edge]))

    def metres(self, who: Traveller) -> float:
        """The length of the shortest way to a robot's first stop; below 0 without one."""
        if not who.stops:
            return -1.0
        return self.intervals.metres_to(self.point(who, who.stops[0].at))[self.point(who, who.start)]

    def told(self, who: Traveller) -> core.Traveller:
        """A traveller as the core knows it."""
        limits, faces = limits_of(who.robot), kinematics_named(who.robot.kinematics).faces_its_way
        return core.Traveller(
            start=self.point(who, who.start),
            stops=[(self.point(who, stop.at), stop.hold_s) for stop in who.stops],
            radius=who.robot.radius_m,
            speed=limits.speed_mps,
            heading=who.heading_rad,
            yaw_rate=limits.yaw_rate_radps if faces else math.inf,
            acceleration=limits.acceleration_mps2,
            ready=who.ready_s,
            fixed=who.fixed,
            stays=who.stays,
        )


def moves_at_once(
    roadmap: WithConflicts, starts: Sequence[int], goals: Sequence[int], *, radius_m: float, margin_m: float, seed: int
) -> tuple[list[tuple[int, int]], bool]:
    """Return moves (robot, edge) that bring robots of one radius to their goals at 1 m/s, and whether all come there.

    All go at once and make way for each other; their ways are not improved.
    """
    intervals = core.SafeIntervals(annotated(roadmap), [True] * len(roadmap.points), margin_m)
    travellers = [
        core.Traveller(
            start=start,
            stops=[(goal, 0.0)],
            radius=radius_m,
            speed=1.0,
            heading=0.0,
            yaw_rate=math.inf,
            acceleration=math.inf,
            ready=0.0,
            fixed=False,
            stays=False,
        )
        for start, goal in zip(starts, goals, strict=True)
    ]
    order = list(range(len(travellers)))
    moves, ends = core.SharedWays(intervals, travellers, order=order, ways=0, seed=seed, at_once=True).paths()
    return [(robot, edge) for _, robot, edge, _ in moves], math.inf not in ends


def with_places(roadmap: Roadmap, spaces: RobotSpaces, places: Iterable[Standing]) -> Roadmap:
    """The roadmap with a point for each place that is none yet, joined to others of its layer.

    One on a given lane, but for its ends, divides it. Any other is joined to the nearest points from which it is seen.
    """
    known = {Standing((x, y), k) for (x, y), k in zip(roadmap.points.tolist(), roadmap.layer.tolist(), strict=True)}
    fresh = [place for place in dict.fromkeys(places) if place not in known]
    if not fresh:
        return roadmap
    nodes, lanes = roadmap.points[: len(roadmap.names)], roadmap.edges if roadmap.names else roadmap.edges[:0]
    points = np.concatenate([roadmap.points, [place.at for place in fresh]])
    layer = np.append(roadmap.layer, [place.layer for place in fresh])
    edges = [roadmap.edges]
    for k in range(len(roadmap.points), len(roadmap.points) + len(fresh)):
        radius_m, own = float(roadmap.radii_m[layer[k]]), np.flatnonzero(layer[:k] == layer[k])
        at_node = len(nodes) > 0 and np.hypot(*(nodes - points[k]).T).min() <= radius_m
        pieces = lanes[:0] if at_node else _dividing(points, lanes[layer[lanes[:, 0]] == layer[k]], k)
        if len(pieces):
            lanes = np.concatenate([lanes, pieces])
        else:
            seen = own[_seen(partial(spaces.clear, radius_m=radius_m), points[own], points[k])]
            pieces = np.array([pair for j in seen for pair in ((k, j), (j, k))], dtype=np.int64).reshape(-1, 2)
        edges.append(pieces)
    joined = np.concatenate(edges)
    more = len(joined) - len(roadmap.edges)
    speeds = np.append(roadmap.speed_mps, roadmap.speeds_along(points[joined[len(roadmap.edges) :]]))
    order = np.lexsort(joined.T[::-1])
    joined = joined[order]
    was_there, number = order < len(roadmap.edges), np.argsort(order)
    near = Near(number[roadmap.near_edge], roadmap.reach_point, roadmap.reach_m)
    before = Known(near, was_there, len(roadmap.points))
    start, point, metres = conflicts(points, joined, roadmap.reaches_m, roadmap.sections, layer, before)
    return replace(
        roadmap,
        base=roadmap,
        points=points,
        layer=layer,
        narrow=np.append(roadmap.narrow, np.ones(len(fresh), dtype=np.bool_)),
        edges=joined,
        clearance_m=np.append(roadmap.clearance_m, np.zeros(more))[order],
        reach_start=start,
        reach_point=point,
        reach_m=metres,
        speed_mps=speeds[order],
    )


def _dividing(points: Floats, lanes: Indices, k: int) -> Indices:
    """The pieces (n, 2) into which a point divides the edges (m, 2) on which it is."""
    at, (start, end) = points[k], lanes.T
    along, off = points[end] - points[start], at - points[start]
    squared = np.einsum("ij,ij->i", along, along)
    share = np.einsum("ij,ij->i", off, along) / squared
    away_m = np.hypot(*(off - share[:, np.newaxis] * along).T)
    on = (away_m <= ON_LANE_M) & (share > 0) & (share < 1)
    here = np.full(np.count_nonzero(on), k)
    pieces = np.concatenate([np.stack([start[on], here], axis=1), np.stack([here, end[on]], axis=1)])
    return np.unique(pieces, axis=0)


def _seen(clear: Callable[[Floats], bool], points: Floats, at: Floats) -> list[int]:
    """The nearest of the points from which a place is seen, but for metres in which a robot may err, by number."""
    apart = np.linalg.norm(points - at, axis=1)
    nearest = np.argsort(apart)[: 4 * _ENTRIES]
    for blocked_m in _BLOCKED_M:
        share = np.minimum(1.0, blocked_m / np.maximum(apart, _SAME_M))[:, None]
        begin = at + share * (points - at)
        seen = list(islice((j for j in nearest.tolist() if clear(np.stack([begin[j], points[j]]))), _ENTRIES))
        if seen:
            return seen
    return []
