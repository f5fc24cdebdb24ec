"""Moves of robots over a roadmap: the planner behind `ReservedTraffic`."""

from __future__ import annotations

import math
from collections.abc import Callable, Collection, Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from typing import NamedTuple

import numpy as np

from muster import core
from muster.motion.grid import Floats
from muster.motion.kinematics.registry import kinematics_named, limits_of
from muster.traffic.doors import NO_DOORS, RoadmapDoors
from muster.traffic.edge_conflicts import conflicts
from muster.traffic.lane_sections import ON_LANE_M
from muster.traffic.roadmap import Bools, Indices, Roadmap
from muster.traffic.single_moves import MovePlanner, Parameters
from muster.traffic.travellers import Move, Point, Traveller

_SAME_M = 1e-6
_THERE_M = 1e-3
_WAYS = 160
"""Ways that are sought to improve a plan, but one for each robot at least."""
_MOST_BY_INTERVALS = 5_000_000
"""Travellers times edges up to which whole ways are planned; beyond, all are planned step by step: that takes much
less time to plan, and more to drive."""
_HORIZON = 10
"""Moves of each robot that are planned where some find no path by themselves."""
_ENTRIES = 6
"""Points of the roadmap to which a place beside it is joined, at most."""
_CORNERS = 8
"""Of the way round a robot that never leaves."""
_SPARE_M = 0.01
_BLOCKED_M = (0.0, 0.1, 0.3)
"""Metres at a place beside it that may be blocked, where else no point is seen: robots err in where they are."""


class TimedMove(NamedTuple):
    """When a robot sets out from one point to another, by number, and the number of the stop to which that leads."""

    start_s: float
    point: int
    to: int
    stop: int


class Journey(NamedTuple):
    """When a robot has stayed at its last stop, and its moves; inf where no path is found, NaN where none can be."""

    end_s: float
    moves: tuple[TimedMove, ...]


@dataclass
class RoadmapPlan:
    """Plans moves of travellers over a roadmap: by safe intervals, or by priority inheritance where some find no path.

    Parameters
    ----------
    roadmap
        has points for starts and goals; a place that is none gets one.
    clear
        whether the straight way between two places, (2, 2) metres, is free for the widest robot.
    seed
        of the orders that are tried.
    doors
        of the mission, which close and open.
    cut_off
        see `Planner`; where many travel on a large roadmap this is not found out: any of them may be.
    stepwise
        see `Planner`.
    """

    roadmap: Roadmap
    clear: Callable[[Floats], bool]
    seed: int = 0
    doors: RoadmapDoors = NO_DOORS
    cut_off: frozenset[int] = frozenset()
    stepwise: bool = False
    _closed: frozenset[str] = field(init=False)
    _priorities: list[str] = field(default_factory=list)
    _goals: dict[str, tuple[Point | None, int]] = field(default_factory=dict)  # and in how many plans by steps
    _known: _Network | None = None

    def __post_init__(self) -> None:
        self._closed = self.doors.closed

    def close(self, doors: Collection[str]) -> None:
        """From now on these doors are closed, and the others open."""
        self._closed, self._known = frozenset(doors), None

    def is_open(self, piece: Floats) -> bool:
        """Whether a straight way (2, 2) leads through no closed door."""
        return bool(self.doors.open_ways(piece[np.newaxis], self._closed)[0])

    def __call__(self, travellers: Sequence[Traveller]) -> list[Move]:
        """Moves in an order in which they are free, as far as paths are found."""
        moves = self.whole(travellers)
        self.stepwise = moves is None
        return self._by_inheritance(travellers) if moves is None else moves

    def whole(self, travellers: Sequence[Traveller]) -> list[Move] | None:
        """See `Planner`."""
        on = self._network_for(travellers)
        self.cut_off = frozenset(range(len(travellers)))
        if len(travellers) * len(on.roadmap.edges) > _MOST_BY_INTERVALS:
            return None
        moves, ends, order = self._searched(on, travellers)
        if math.inf in ends and any(len(who.stops) > 1 for who in travellers):
            moves, ends, order = self._searched(on, [_to_first_stop(who) for who in travellers])
        self._priorities = [travellers[k].robot.id for k in order]
        self.cut_off = frozenset(k for k, end in enumerate(ends) if math.isnan(end))
        if math.inf in ends:
            return None
        self.stepwise = False
        return [on.move(traveller, edge, stop) for _, traveller, edge, stop in moves]

    def journeys(self, travellers: Sequence[Traveller], *, ways: int) -> list[Journey]:
        """How each gets through all its stops among the others.

        Parameters
        ----------
        ways
            that are sought to improve the plan.
        """
        on = self._network_for(travellers)
        moves, ends, _ = self._searched(on, travellers, ways)
        edges = on.roadmap.edges.tolist()
        own: list[list[TimedMove]] = [[] for _ in travellers]
        for start_s, traveller, edge, stop in moves:
            point, to = edges[edge]
            own[traveller].append(TimedMove(start_s, point, to, stop))
        return [Journey(end_s, tuple(moves)) for end_s, moves in zip(ends, own, strict=True)]

    def reaches(self, travellers: Sequence[Traveller], number: int, places: Sequence[Point]) -> list[bool]:
        """See `Planner`."""
        from scipy.sparse import csr_matrix
        from scipy.sparse.csgraph import breadth_first_order

        on, who = self._network_for(travellers, places), travellers[number]
        free = on.roadmap.edges[self._past_fixed(on, travellers, who.robot.radius_m)]
        size = len(on.roadmap.points)
        graph = csr_matrix((np.ones(len(free)), tuple(free.T)), shape=(size, size))
        reached = set(breadth_first_order(graph, on.number[who.start], return_predecessors=False).tolist())
        return [on.number[place] in reached for place in places]

    def _past_fixed(self, on: _Network, travellers: Sequence[Traveller], radius_m: float) -> Bools:
        """Which edges keep a robot away from those who never leave, but where it only moves away from one."""
        apart_m = np.zeros(len(on.roadmap.points))
        for other in travellers:
            if other.fixed:
                at = on.number[other.start]
                apart_m[at] = max(apart_m[at], radius_m + other.robot.radius_m + on.roadmap.margin_m)
        edges = np.repeat(np.arange(len(on.roadmap.edges)), np.diff(on.roadmap.reach_start))
        near = on.roadmap.reach_m < apart_m[on.roadmap.reach_point]
        return np.asarray(np.bincount(edges[near], minlength=len(on.roadmap.edges)) == 0)

    def _network_for(self, travellers: Sequence[Traveller], more: Sequence[Point] = ()) -> _Network:
        """The roadmap with their places, and some more, as it was for the last plan where that has them."""
        places = [*more, *(place for who in travellers for place in (who.start, *(stop.at for stop in who.stops)))]
        places += [place for who in travellers if who.fixed for place in self._around(who)]
        if self._known is None or not self._known.number.keys() >= set(places):
            roadmap = with_places(self.roadmap, self.clear, places)
            if self._closed:
                roadmap = roadmap.keeping(self.doors.open_ways(roadmap.points[roadmap.edges], self._closed))
            self._known = _Network.of(roadmap)
        return self._known

    def _around(self, who: Traveller) -> Iterator[Point]:
        """Places by which others as wide get round a robot that never leaves, where there is room."""
        radius_m = (2 * who.robot.radius_m + self.roadmap.margin_m) / math.cos(math.pi / _CORNERS) + _SPARE_M
        for k in range(_CORNERS):
            angle = 2 * math.pi * k / _CORNERS
            place = (who.start[0] + radius_m * math.cos(angle), who.start[1] + radius_m * math.sin(angle))
            if self.clear(np.array([place, place])):
                yield place

    def _searched(
        self, on: _Network, travellers: Sequence[Traveller], ways: int = _WAYS
    ) -> tuple[list[tuple[float, int, int, int]], list[float], list[int]]:
        """Moves, ends and the order of travellers: see `core.SafeIntervals.best_of`."""
        ranks = {name: k for k, name in enumerate(self._priorities)}
        metres = [on.metres(who) for who in travellers]
        first = sorted(range(len(travellers)), key=lambda k: (ranks.get(travellers[k].robot.id, math.inf), -metres[k]))
        told = [_told(who, on.number) for who in travellers]
        return on.intervals.best_of(told, order=first, tries=max(1, ways // max(1, len(told))), seed=self.seed)

    def _by_inheritance(self, travellers: Sequence[Traveller]) -> list[Move]:
        """To first stops, as far as the horizon."""
        on = self._network_for(travellers)
        first = {on.number[who.start]: k for k, who in reversed(list(enumerate(travellers)))}
        numbers = sorted(first.values())  # without those who are only thought to be where another is
        there = [travellers[k] for k in numbers]
        goals = [on.number[who.stops[0].at] if who.stops else None for who in there]
        found = on.planner.planned(
            [on.number[who.start] for who in there],
            goals,
            [who.robot.radius_m for who in there],
            margin_m=on.roadmap.margin_m,
            priorities=[self._waited(who) for who in there],
            pinned=[who.fixed or who.ready_s > 0 or _is_there(who) for who in there],
            seed=self.seed,
            params=Parameters(horizon=_HORIZON * len(there)),
        )
        done, moves = set[int](), list[Move]()
        for k, edge in found.moves:
            moves.append(on.move(numbers[k], edge, int(k in done)))
            if on.roadmap.edges[edge, 1] == goals[k] and not _rests(there[k]):
                done.add(k)  # it stops there to do what it has to; where it goes then it makes way
        return moves

    def _waited(self, who: Traveller) -> float:
        """Rounds for which a robot has had its goal, about: who came first goes on to come first."""
        goal = who.stops[0].at if who.stops else None
        before, plans = self._goals.get(who.robot.id, (None, 0))
        plans = plans + 1 if goal == before else 0
        self._goals[who.robot.id] = goal, plans
        return float(_HORIZON * plans)


@dataclass(frozen=True)
class _Network:
    """A roadmap, the numbers of its points by place, and its two planners."""

    roadmap: Roadmap
    number: Mapping[Point, int]
    planner: MovePlanner
    intervals: core.SafeIntervals

    @classmethod
    def of(cls, roadmap: Roadmap) -> _Network:
        number = {(x, y): k for k, (x, y) in enumerate(roadmap.points.tolist())}
        planner = MovePlanner(roadmap)
        rests = roadmap.holding.tolist()
        return cls(roadmap, number, planner, core.SafeIntervals(planner.shared, rests, roadmap.margin_m))

    def move(self, traveller: int, edge: int, stop: int) -> Move:
        """A move along an edge."""
        x, y = self.roadmap.points[self.roadmap.edges[edge, 1]]
        return Move(traveller, (float(x), float(y)), stop, float(self.roadmap.speed_mps[edge]))

    def metres(self, who: Traveller) -> float:
        """The length of the shortest way to a robot's first stop; below 0 without one."""
        if not who.stops:
            return -1.0
        return self.intervals.metres_to(self.number[who.stops[0].at])[self.number[who.start]]


def with_places(roadmap: Roadmap, clear: Callable[[Floats], bool], places: Sequence[Point]) -> Roadmap:
    """The roadmap with a point for each place that is none yet.

    One on a given lane, but for its ends, divides it. Any other is joined to the nearest points from which it is seen.
    """
    known = {tuple(point) for point in roadmap.points.tolist()}
    fresh = np.array([place for place in dict.fromkeys(places) if place not in known], dtype=np.float64).reshape(-1, 2)
    if not len(fresh):
        return roadmap
    points = np.concatenate([roadmap.points, fresh])
    nodes = roadmap.points[: len(roadmap.names)]
    lanes, edges = (roadmap.edges if roadmap.names else roadmap.edges[:0]), [roadmap.edges]
    for k in range(len(roadmap.points), len(points)):
        at_node = len(nodes) > 0 and np.hypot(*(nodes - points[k]).T).min() <= roadmap.radius_m
        pieces = lanes[:0] if at_node else _dividing(points, lanes, k)
        if len(pieces):
            lanes = np.concatenate([lanes, pieces])
        else:
            seen = _seen(clear, points, k)
            pieces = np.array([pair for j in seen for pair in ((k, j), (j, k))], dtype=np.int64).reshape(-1, 2)
        edges.append(pieces)
    joined = np.concatenate(edges)
    speeds = np.append(roadmap.speed_mps, roadmap.speeds_along(points[joined[len(roadmap.edges) :]]))
    order = np.lexsort(joined.T[::-1])
    joined, more = joined[order], len(joined) - len(roadmap.edges)
    start, point, metres = conflicts(points, joined, roadmap.reach, roadmap.sections)
    return replace(
        roadmap,
        points=points,
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


def _seen(clear: Callable[[Floats], bool], points: Floats, k: int) -> list[int]:
    """The nearest of the points before one to which the way is free, but for metres in which a robot may err."""
    apart = np.linalg.norm(points[:k] - points[k], axis=1)
    nearest = np.argsort(apart)[: 4 * _ENTRIES]
    for blocked_m in _BLOCKED_M:
        share = np.minimum(1.0, blocked_m / np.maximum(apart, _SAME_M))[:, None]
        begin = points[k] + share * (points[:k] - points[k])
        seen = [j for j in nearest.tolist() if clear(np.stack([begin[j], points[j]]))]
        if seen:
            return seen[:_ENTRIES]
    return []


def _is_there(who: Traveller) -> bool:
    """Whether a robot stands where it is to do something next: it does that first."""
    return bool(who.stops) and not _rests(who) and math.dist(who.start, who.stops[0].at) <= _THERE_M


def _rests(who: Traveller) -> bool:
    """Whether a robot has nothing more to do than to stay somewhere."""
    return who.stays and len(who.stops) == 1 and who.stops[0].hold_s == 0.0


def _to_first_stop(who: Traveller) -> Traveller:
    return replace(who, stops=who.stops[:1], stays=who.stays and len(who.stops) < 2)


def _told(who: Traveller, number: Mapping[Point, int]) -> core.Traveller:
    limits, faces = limits_of(who.robot), kinematics_named(who.robot.kinematics).faces_its_way
    return core.Traveller(
        start=number[who.start],
        stops=[(number[stop.at], stop.hold_s) for stop in who.stops],
        radius=who.robot.radius_m,
        speed=limits.speed_mps,
        heading=who.heading_rad,
        yaw_rate=limits.yaw_rate_radps if faces else math.inf,
        acceleration=limits.acceleration_mps2,
        ready=who.ready_s,
        fixed=who.fixed,
        stays=who.stays,
    )
