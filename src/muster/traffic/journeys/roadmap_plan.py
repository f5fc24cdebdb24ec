"""Moves of robots over a roadmap: the planner behind `ReservedTraffic`."""

from __future__ import annotations

import math
from collections.abc import Callable, Collection, Iterator, Sequence
from dataclasses import dataclass, field, replace
from threading import Lock
from typing import NamedTuple

import numpy as np

from muster import core
from muster.motion.grid import Floats
from muster.traffic.journeys.joint_journeys import JointJourneys
from muster.traffic.journeys.roadmap_network import Network, Standing, with_places
from muster.traffic.journeys.travellers import PlannedMoves, Point, Traveller
from muster.traffic.roadmaps.doors import NO_DOORS, RoadmapDoors
from muster.traffic.roadmaps.roadmap import Bools, Roadmap
from muster.traffic.roadmaps.robot_spaces import Disc, RobotSpaces

_FIRST_WAYS, _WAYS = 640, 160
"""Ways that are sought to improve the first plan, and each that goes on from it, but one for each robot at least."""
_MOST_BY_INTERVALS = 5_000_000
"""Travellers times edges up to which ways are sought one after the other; beyond, all make way for each other: that
takes much less time to plan, and more to drive."""
_CORNERS = 8
"""Of the way round a robot that never leaves."""
_SPARE_M = 0.01


class Budget(NamedTuple):
    """How long ways are improved; first ways are sought in any case.

    Parameters
    ----------
    expansions : int or None
        Of all searches, which are the same on every machine; None: any.
    seconds : float
        On the clock of the machine.
    """

    expansions: int | None = None
    seconds: float = math.inf


UNLIMITED = Budget()


@dataclass
class RoadmapPlan:
    """Plans moves of travellers over a roadmap, in one thread at a time; others may ask it what is open and reached.

    Parameters
    ----------
    roadmap
        has points for starts and goals; a place that is none gets one.
    spaces
        the free space of each robot.
    seed
        of the orders that are tried.
    doors
        of the mission, which close and open.
    for_more
        makes the roadmap for robots of further radii, which may join; without it there are none.
    budget
        of each plan but the first, before which no robot goes anywhere.
    """

    roadmap: Roadmap
    spaces: RobotSpaces = RobotSpaces()
    seed: int = 0
    doors: RoadmapDoors = NO_DOORS
    for_more: Callable[[Sequence[float]], Roadmap] | None = None
    budget: Budget = UNLIMITED
    _closed: frozenset[str] = field(init=False)
    _priorities: list[str] = field(default_factory=list)
    _known: tuple[Roadmap, frozenset[str], Network] | None = None  # for a roadmap and its closed doors
    _opened_for: tuple[Roadmap, frozenset[str], Roadmap] | None = None
    _admitting: Lock = field(default_factory=Lock)
    _more_m: list[float] = field(default_factory=list)  # radii of robots that have joined

    def __post_init__(self) -> None:
        self._closed = self.doors.closed

    def close(self, doors: Collection[str]) -> None:
        """From now on these doors are closed, and the others open."""
        self._closed = frozenset(doors)

    def is_open(self, piece: Floats, radius_m: float) -> bool:
        """See `Planner`."""
        return bool(self.doors.open_ways(piece[np.newaxis], self._closed, radius_m)[0])

    def __call__(self, travellers: Sequence[Traveller]) -> PlannedMoves:
        """See `Planner`."""
        on = self._network_for(travellers)
        ways = _WAYS if self._priorities else _FIRST_WAYS
        shared = self._shared(on, travellers, ways)
        moves, ends = shared.paths()
        if math.inf in ends and any(len(who.stops) > 1 for who in travellers):
            shared = self._shared(on, [_to_first_stop(who) for who in travellers], ways)
            moves, ends = shared.paths()
        self._priorities = [travellers[k].robot.id for k in shared.order]
        return PlannedMoves(
            moves=[on.move(traveller, edge, stop) for _, traveller, edge, stop in moves],
            complete=math.inf not in ends,
            cut_off=frozenset(k for k, end in enumerate(ends) if math.isnan(end)),
        )

    def journeys(self, travellers: Sequence[Traveller], *, ways: int, places: Sequence[Point] = ()) -> JointJourneys:
        """How each gets through all its stops among the others; so many ways are sought to improve the first ones.

        `places` are others where they may have to go later.
        """
        on = self._network_for(travellers, [(who, place) for who in travellers for place in places])
        return JointJourneys(on, travellers, self._shared(on, travellers, ways))

    def reaches(self, travellers: Sequence[Traveller], number: int, places: Sequence[Point]) -> list[bool]:
        """See `Planner`."""
        from scipy.sparse import csr_matrix
        from scipy.sparse.csgraph import breadth_first_order

        who = travellers[number]
        on = self._network_for(travellers, [(who, place) for place in places])
        free = on.roadmap.edges[self._past_fixed(on, travellers, who.robot.radius_m)]
        size = len(on.roadmap.points)
        graph = csr_matrix((np.ones(len(free)), tuple(free.T)), shape=(size, size))
        reached = set(breadth_first_order(graph, on.point(who, who.start), return_predecessors=False).tolist())
        return [on.point(who, place) in reached or not self._no_way(travellers, who, place) for place in places]

    def _no_way(self, travellers: Sequence[Traveller], who: Traveller, place: Point) -> bool:
        """Whether it is proven that a robot which finds no way on the roadmap has none; of lanes the roadmap is all."""
        if self.roadmap.names:
            return True
        radius_m, margin_m = who.robot.radius_m, self.roadmap.margin_m
        discs = [
            Disc(other.start, radius_m + other.robot.radius_m + margin_m)
            for other in travellers
            if other.fixed and other.robot.id != who.robot.id
        ]
        return self.spaces.separates(who.start, place, radius_m, closed=self._closed, discs=discs)

    def _past_fixed(self, on: Network, travellers: Sequence[Traveller], radius_m: float) -> Bools:
        """Which edges keep a robot away from those who never leave, but where it only moves away from one."""
        apart_m = np.zeros(len(on.roadmap.points))
        for other in travellers:
            if other.fixed:
                at = on.point(other, other.start)
                apart_m[at] = max(apart_m[at], radius_m + other.robot.radius_m + on.roadmap.margin_m)
        edges = np.repeat(np.arange(len(on.roadmap.edges)), np.diff(on.roadmap.reach_start))
        near = on.roadmap.reach_m < apart_m[on.roadmap.reach_point]
        return np.asarray(np.bincount(edges[near], minlength=len(on.roadmap.edges)) == 0)

    def _network_for(self, travellers: Sequence[Traveller], more: Sequence[tuple[Traveller, Point]] = ()) -> Network:
        """The roadmap with their places, and some more, as it was for the last plan where that has them."""
        self._admit(travellers)
        layer = {who.robot.radius_m: self.roadmap.layer_for(who.robot.radius_m) for who in travellers}
        own = [(who, place) for who in travellers for place in (who.start, *(stop.at for stop in who.stops))]
        places = [Standing(place, layer[who.robot.radius_m]) for who, place in (*more, *own)]
        places += [
            place for who in travellers if who.fixed for k in set(layer.values()) for place in self._around(who, k)
        ]
        base, closed, known = self.roadmap, self._closed, self._known
        if known is not None and known[:2] == (base, closed) and known[2].number.keys() >= set(places):
            return known[2]
        roadmap = with_places(base, self.spaces, places)
        if closed:
            roadmap = self._opened(roadmap, self._open_base(base))
        made = Network.of(roadmap)
        self._known = base, closed, made
        return made

    def _open_base(self, base: Roadmap) -> Roadmap:
        """The roadmap without the edges through closed doors, as it was for the last plan where doors are as then."""
        if self._opened_for is None or self._opened_for[:2] != (base, self._closed):
            self._opened_for = base, self._closed, self._opened(base, None)
        return self._opened_for[2]

    def _opened(self, roadmap: Roadmap, base: Roadmap | None) -> Roadmap:
        radii_m = roadmap.radii_m[roadmap.edge_layer]
        return roadmap.keeping(self.doors.open_ways(roadmap.points[roadmap.edges], self._closed, radii_m), base)

    def _admit(self, travellers: Sequence[Traveller]) -> None:
        """Make layers for robots of other sizes than there were."""
        with self._admitting:
            known = {*self.roadmap.radii_m.tolist(), *self._more_m}
            fresh = {who.robot.radius_m for who in travellers} - known
            if fresh and self.for_more is not None:
                self._more_m += sorted(fresh)
                self.roadmap = self.for_more(self._more_m)

    def _around(self, who: Traveller, layer: int) -> Iterator[Standing]:
        """Places by which others, of a layer, get round a robot that never leaves, where there is room."""
        other_m = float(self.roadmap.radii_m[layer])
        radius_m = (who.robot.radius_m + other_m + self.roadmap.margin_m) / math.cos(math.pi / _CORNERS) + _SPARE_M
        for k in range(_CORNERS):
            angle = 2 * math.pi * k / _CORNERS
            place = (who.start[0] + radius_m * math.cos(angle), who.start[1] + radius_m * math.sin(angle))
            if self.spaces.clear(np.array([place, place]), other_m):
                yield Standing(place, layer)

    def _shared(self, on: Network, travellers: Sequence[Traveller], ways: int) -> core.SharedWays:
        """Ways of all: in the order of the last plan, and who was not in it after the others, from far away first."""
        ranks = {name: k for k, name in enumerate(self._priorities)}
        metres = [on.metres(who) for who in travellers]
        first = sorted(range(len(travellers)), key=lambda k: (ranks.get(travellers[k].robot.id, math.inf), -metres[k]))
        told = [on.told(who) for who in travellers]
        each = max(1, ways // max(1, len(told)))
        edges = on.edges_by_layer
        many = sum(edges[on.standing(who, who.start).layer] for who in travellers) > _MOST_BY_INTERVALS
        more = 0 if many else each * len(told)
        budget = self.budget if self._priorities else UNLIMITED
        most = {} if budget.expansions is None else {"most_expansions": budget.expansions}
        return core.SharedWays(
            on.intervals,
            told,
            order=first,
            ways=more,
            seed=self.seed,
            at_once=many,
            most_seconds=budget.seconds,
            **most,
        )


def _to_first_stop(who: Traveller) -> Traveller:
    return replace(who, stops=who.stops[:1], stays=who.stays and len(who.stops) < 2)
