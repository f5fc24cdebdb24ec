"""Moves of robots over a roadmap: the planner behind `ReservedTraffic`."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, field, replace

import numpy as np

from muster import core
from muster.motion.grid import Floats
from muster.motion.kinematics.registry import kinematics_named, limits_of
from muster.traffic.edge_conflicts import conflicts
from muster.traffic.reserved import Move, Point, Traveller
from muster.traffic.roadmap import Roadmap

_SAME_M = 1e-6
_TRIES = 8
"""Orders of robots that are tried."""
_ENTRIES = 6
"""Points of the roadmap to which a place beside it is joined, at most."""


@dataclass
class RoadmapPlan:
    """Plans moves of travellers over a roadmap, by safe intervals.

    Parameters
    ----------
    roadmap
        has points for starts and goals; a place that is none gets one.
    clear
        whether the straight way between two places, (2, 2) metres, is free for the widest robot.
    seed
        of the orders that are tried.
    """

    roadmap: Roadmap
    clear: Callable[[Floats], bool]
    seed: int = 0
    _lanes: core.SharedLanes | None = None
    _points: dict[Point, int] = field(default_factory=dict)

    def __call__(self, travellers: Sequence[Traveller]) -> Iterator[Move]:
        """Moves in an order in which they are free, as far as paths are found."""
        places = [place for who in travellers for place in (who.start, who.goal) if place is not None]
        roadmap = with_places(self.roadmap, self.clear, places)
        lanes = lanes_of(roadmap)
        number = {tuple(point): k for k, point in enumerate(roadmap.points.tolist())}
        moves, _ends = core.paths_by_safe_intervals(
            lanes=lanes,
            rests=roadmap.holding.tolist(),
            travellers=[_told(who, lanes, number) for who in travellers],
            margin=roadmap.margin_m,
            tries=_TRIES,
            seed=self.seed,
        )
        for _, traveller, edge in moves:
            x, y = roadmap.points[roadmap.edges[edge, 1]]
            yield Move(traveller, (float(x), float(y)))


def lanes_of(roadmap: Roadmap) -> core.SharedLanes:
    """A roadmap as the core has it."""
    return core.SharedLanes(
        places=np.ascontiguousarray(roadmap.points),
        ends=roadmap.edges.astype(np.int32),
        lengths=roadmap.lengths_m,
        clearances=roadmap.clearance_m + roadmap.radius_m,
        reach_first=roadmap.reach_start.astype(np.int32),
        reach_points=roadmap.reach_point.astype(np.int32),
        reach_gaps=roadmap.reach_m,
    )


def with_places(roadmap: Roadmap, clear: Callable[[Floats], bool], places: Sequence[Point]) -> Roadmap:
    """The roadmap with a point for each place that is none of its points, joined to the nearest from which it is seen."""
    known = {tuple(point) for point in roadmap.points.tolist()}
    fresh = np.array([place for place in dict.fromkeys(places) if place not in known], dtype=np.float64).reshape(-1, 2)
    if not len(fresh):
        return roadmap
    points = np.concatenate([roadmap.points, fresh])
    edges = [roadmap.edges]
    for k in range(len(roadmap.points), len(points)):
        apart = np.linalg.norm(points[:k] - points[k], axis=1)
        nearest = np.argsort(apart)[: 4 * _ENTRIES]
        seen = [j for j in nearest.tolist() if clear(points[[k, j]])][:_ENTRIES]
        edges.append(np.array([pair for j in seen for pair in ((k, j), (j, k))], dtype=np.int64).reshape(-1, 2))
    joined = np.concatenate(edges)
    more = len(joined) - len(roadmap.edges)
    start, point, metres = conflicts(points, joined, roadmap.reach)
    return replace(
        roadmap,
        points=points,
        edges=joined,
        clearance_m=np.append(roadmap.clearance_m, np.zeros(more)),
        reach_start=start,
        reach_point=point,
        reach_m=metres,
        capacity=np.append(roadmap.capacity, np.zeros(more, dtype=np.int64)),
        speed_mps=np.append(roadmap.speed_mps, np.full(more, np.inf)),
    )


def _told(who: Traveller, lanes: core.SharedLanes, number: dict[tuple[float, ...], int]) -> core.Traveller:
    limits, faces = limits_of(who.robot), kinematics_named(who.robot.kinematics).faces_its_way
    return core.Traveller(
        lanes=lanes,
        start=number[who.start],
        stops=[] if who.goal is None else [(number[who.goal], who.hold_s)],
        radius=who.robot.radius_m,
        speed=limits.speed_mps,
        heading=who.heading_rad,
        yaw_rate=limits.yaw_rate_radps if faces else math.inf,
        acceleration=limits.acceleration_mps2,
        ready=who.ready_s,
        fixed=who.fixed,
        stays=who.stays,
    )
