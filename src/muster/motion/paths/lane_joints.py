"""Where places are joined to given lanes: at the nearest point of a lane, by a straight stub, there and back.

Planner and traffic take the same points, so that what is planned is what is driven. The judge finds its own.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import dataclass, field
from functools import cached_property
from itertools import pairwise
from typing import NamedTuple

import numpy as np

from muster.mission.lanes import Lane, Lanes
from muster.mission.values.arrays import Bools, Floats, Indices

SAME_M = 1e-6
"""Lanes are as near to a place as the nearest where they differ by no more; then the first of the mission is taken."""
ON_LANE_M = 1e-3
"""A place that is no farther from a lane is on it, and one that is no farther from an end of it is at the node."""

_LANES, _STEPS = 100, 20
"""So many lanes are looked at where the way to the nearest point of all is not free, and so many metres each way of the
nearest point of each."""
_MOST_JOINTS = 10_000  # that are kept: robots under way are somewhere else each time
_PARALLEL = 1e-6  # rad: lanes that differ by no more lie along each other

Sees = Callable[[Floats], bool]
"""Whether the straight way between two points (2, 2) of the map frame is free for a robot."""


class ClosedLane(NamedTuple):
    """A lane that a robot of some radius cannot drive: its number, from 0, and why."""

    number: int
    reason: str


class Joint(NamedTuple):
    """Where a place is joined to lanes.

    Parameters
    ----------
    at
        (2,) metres in the map frame.
    away_m
        how far the place is from there.
    on
        the lanes between whose ends it is, by number, each with the metres from where the lane begins: the nearest, and
        those that lie along it. A lane that crosses it is left only at a node.
    node
        the number of the node that it is; -1: none.
    """

    at: Floats
    away_m: float
    on: tuple[tuple[int, float], ...]
    node: int


def closed_lanes(lanes: Lanes, radius_m: float, sees: Sees | None) -> list[ClosedLane]:
    """Return the lanes that robots of a radius cannot drive; `sees` is None where there are no obstacles."""
    found = []
    for number, lane in enumerate(lanes.edges):
        if lane.width_m is not None and lane.width_m < 2 * radius_m:
            found.append(ClosedLane(number, f"{lane.width_m:g} m wide, diameter {2 * radius_m:g} m"))
        elif sees is not None and not sees(ends_of(lanes, lane)):
            found.append(ClosedLane(number, f"too near to an obstacle for radius {radius_m:g} m"))
    return found


def ends_of(lanes: Lanes, lane: Lane) -> Floats:
    """Return the ends (2, 2) of a lane."""
    return np.array([lanes.nodes[lane.start][:2], lanes.nodes[lane.end][:2]], dtype=np.float64)


@dataclass(frozen=True, eq=False)
class Joints:
    """Joins places to some of the lanes of a mission.

    Parameters
    ----------
    places
        (n, 2) metres: all nodes of the mission.
    numbers
        (m,) of these lanes, ascending.
    nodes
        (m, 2) the numbers of the nodes at which they begin and end.
    both_ways
        (m,) whether robots drive them backwards, too.
    sees
        as of `closed_lanes`.
    """

    places: Floats
    numbers: Indices
    nodes: Indices
    both_ways: Bools
    sees: Sees | None
    _known: dict[tuple[float, ...], Joint | None] = field(default_factory=dict, init=False, repr=False)

    @classmethod
    def of(cls, lanes: Lanes, numbers: Iterable[int], sees: Sees | None) -> Joints:
        number_of = {name: k for k, name in enumerate(lanes.nodes)}
        some = np.array(sorted(numbers), dtype=np.int64)
        edges = [lanes.edges[k] for k in some.tolist()]
        nodes = np.array([(number_of[lane.start], number_of[lane.end]) for lane in edges], dtype=np.int64)
        places = np.array([place[:2] for place in lanes.nodes.values()], dtype=np.float64)
        both_ways = np.array([lane.both_ways for lane in edges], dtype=np.bool_)
        return cls(places.reshape(-1, 2), some, nodes.reshape(-1, 2), both_ways, sees)

    def joint(self, place: Floats) -> Joint | None:
        """Return where a place (2,) is joined: at the nearest point of a lane to which the straight way is free."""
        name = tuple(place.tolist())
        if name not in self._known:
            if len(self._known) >= _MOST_JOINTS:
                self._known.clear()
            self._known[name] = self._found(place)
        return self._known[name]

    def _found(self, place: Floats) -> Joint | None:
        if not len(self.numbers) or (self.sees is not None and not self.sees(np.stack([place, place]))):
            return None
        starts, along, metres = self._lines
        nearest_m = np.clip(np.einsum("ij,ij->i", place - starts, along), 0.0, metres)
        away_m = np.linalg.norm(place - starts - nearest_m[:, np.newaxis] * along, axis=1)
        first = int(np.argmin(np.rint(away_m / SAME_M)))
        found: tuple[int, float] | None = (first, float(nearest_m[first]))
        if not self._leads(place, first, float(nearest_m[first])):
            found = next((one for one in self._further(place, nearest_m, away_m) if self._leads(place, *one)), None)
        return None if found is None else self._joint(place, *found)

    def _joint(self, place: Floats, lane: int, at_m: float) -> Joint:
        starts, along, metres = self._lines
        for end, to_end_m in enumerate((at_m, metres[lane] - at_m)):
            if to_end_m <= ON_LANE_M:
                at = self.ends[lane, end]
                return Joint(at, float(np.linalg.norm(place - at)), (), int(self.nodes[lane, end]))
        at = starts[lane] + at_m * along[lane]
        own_m = np.einsum("ij,ij->i", at - starts, along)
        off_m = np.linalg.norm(at - starts - np.clip(own_m, 0.0, metres)[:, np.newaxis] * along, axis=1)
        aside = np.abs(along[:, 0] * along[lane, 1] - along[:, 1] * along[lane, 0])
        same = np.flatnonzero((off_m <= SAME_M) & (aside <= _PARALLEL))
        on = tuple((int(self.numbers[k]), float(own_m[k])) for k in same.tolist())
        return Joint(at, float(np.linalg.norm(place - at)), on, -1)

    def _further(self, place: Floats, nearest_m: Floats, away_m: Floats) -> Iterator[tuple[int, float]]:
        """Points of the nearest lanes, near ones first: the nearest of each, those whole metres from it, its ends."""
        starts, along, metres = self._lines
        lanes = np.argsort(np.rint(away_m / SAME_M), kind="stable")[:_LANES]
        steps = np.concatenate([[-math.inf], np.arange(-_STEPS, _STEPS + 1), [math.inf]])
        at_m = np.clip(nearest_m[lanes, np.newaxis] + steps, 0.0, metres[lanes, np.newaxis])
        points = starts[lanes, np.newaxis] + at_m[..., np.newaxis] * along[lanes, np.newaxis]
        far = np.rint(np.linalg.norm(place - points, axis=2) / SAME_M)
        which = np.broadcast_to(self.numbers[lanes, np.newaxis], far.shape)
        for k in np.lexsort((at_m.ravel(), which.ravel(), far.ravel())).tolist():
            row, column = divmod(k, len(steps))
            yield int(lanes[row]), float(at_m[row, column])

    def _leads(self, place: Floats, lane: int, at_m: float) -> bool:
        """Whether the straight way from a place to a point of a lane is free."""
        starts, along, _ = self._lines
        return self.sees is None or self.sees(np.stack([place, starts[lane] + at_m * along[lane]]))

    @cached_property
    def ends(self) -> Floats:
        """The ends (m, 2, 2) of the lanes, metres."""
        return self.places[self.nodes].reshape(-1, 2, 2)

    @cached_property
    def pieces(self) -> tuple[Indices, Indices]:
        """The lanes as arcs (k, 2) from node to node, in both directions where they have these, and (k,) their rows."""
        rows = np.repeat(np.arange(len(self.numbers)), np.where(self.both_ways, 2, 1))
        arcs = self.nodes[rows]
        back = np.flatnonzero(np.diff(rows, prepend=-1) == 0)
        arcs[back] = arcs[back, ::-1]
        return arcs, rows

    @cached_property
    def _lines(self) -> tuple[Floats, Floats, Floats]:
        """Where the lanes begin and their directions, (m, 2), and their lengths (m,), metres."""
        along = self.ends[:, 1] - self.ends[:, 0]
        metres = np.linalg.norm(along, axis=1)
        return self.ends[:, 0], along / metres[:, np.newaxis], metres


class JoinedLanes(NamedTuple):
    """Lanes with the places that are joined to them, as a directed graph.

    Parameters
    ----------
    points
        (n, 2) metres; the first are the nodes of the lanes.
    arcs, lanes
        (m, 2) numbers of points, from and to; (m,) the number of the lane on which each is, -1 for a stub.
    places
        (k,) the point of each place; -1: it is joined to no lane.
    """

    points: Floats
    arcs: Indices
    lanes: Indices
    places: Indices


def joined(joints: Joints, places: Floats) -> JoinedLanes:
    """Return the lanes of some joints with places (k, 2), each another."""
    nodes, points = len(joints.places), list[Floats]()
    inner: dict[int, list[tuple[float, int]]] = {}
    stubs: list[tuple[int, int]] = []
    numbers = np.full(len(places), -1, dtype=np.int64)
    for k, place in enumerate(places):
        joint = joints.joint(place)
        if joint is None:
            continue
        at = joint.node if joint.node >= 0 else _inner(inner, joint)
        if at < 0:
            at = nodes + len(points)
            points.append(joint.at)
            for lane, at_m in joint.on:
                inner.setdefault(lane, []).append((at_m, at))
        numbers[k] = at
        if joint.away_m > ON_LANE_M:
            numbers[k] = nodes + len(points)
            points.append(place)
            stubs.append((int(numbers[k]), at))
    arcs, on = _arcs(joints, inner)
    both = [pair for a, b in stubs for pair in ((a, b), (b, a))]
    return JoinedLanes(
        np.concatenate([joints.places, np.array(points, dtype=np.float64).reshape(-1, 2)]),
        np.concatenate([arcs, np.array(both, dtype=np.int64).reshape(-1, 2)]),
        np.append(on, np.full(len(both), -1)),
        numbers,
    )


def _inner(inner: dict[int, list[tuple[float, int]]], joint: Joint) -> int:
    """The point of another place that is joined to a lane where this one is; -1: there is none."""
    lane, at_m = joint.on[0]
    return next((point for other_m, point in inner.get(lane, ()) if abs(other_m - at_m) <= SAME_M), -1)


def _arcs(joints: Joints, inner: dict[int, list[tuple[float, int]]]) -> tuple[Indices, Indices]:
    """The pieces of lanes between their nodes and inner points, in both directions where lanes have these."""
    whole, rows = joints.pieces
    arcs, on, at = list[Indices](), list[Indices](), 0
    for number in sorted(inner):
        row = int(np.searchsorted(joints.numbers, number))
        start, end = joints.nodes[row].tolist()
        stops: Sequence[int] = [start, *(point for _, point in sorted(inner[number])), end]
        pieces = list(pairwise(stops)) + (list(pairwise(stops[::-1])) if joints.both_ways[row] else [])
        first, last = (int(np.searchsorted(rows, row, side)) for side in ("left", "right"))
        arcs += [whole[at:first], np.array(pieces, dtype=np.int64)]
        on += [joints.numbers[rows[at:first]], np.full(len(pieces), number)]
        at = last
    return np.concatenate([*arcs, whole[at:]]), np.concatenate([*on, joints.numbers[rows[at:]]])
