"""Proof that two robots cannot get where they must: they would have to swap where there is room for one.

All joint positions of the two on the roadmap are searched. Other robots are left out, since they only take room. What
is not found so cannot be on this roadmap: the moves of two robots in a plan for all are a path through their joint
positions.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from typing import Any, TypeVar

import numpy as np

from muster.mission.values.arrays import Bools, Indices
from muster.traffic.roadmaps.roadmap import Roadmap

T = TypeVar("T")

_MOST_MOVES = 4_000_000
"""Joint moves that are searched at most; where there may be more, nothing is said."""
_FEW_MOVES = 1_000_000
"""Joint moves that are searched wherever they are."""


@dataclass(frozen=True)
class Swap:
    """Two robots, by number, that must swap where there is room for one; how many joint positions they reach."""

    robots: tuple[int, int]
    positions: int


@dataclass(frozen=True, eq=False)
class Crossings:
    """Which robots get past each other on a roadmap.

    Parameters
    ----------
    roadmap
        what they share.
    starts, radii_m
        the point of each robot on its layer, -1 for none, and its radius.
    """

    roadmap: Roadmap
    starts: Sequence[int]
    radii_m: Sequence[float]
    _made: dict[object, Any] = field(default_factory=dict, init=False, repr=False)

    def reaches(self, start: int, goal: int) -> bool:
        """Whether a robot that is alone gets from one point to another, by number; -1 is a place without a point."""
        return min(start, goal) >= 0 and bool(self._alone(start)[goal])

    def blocking(self, robot: int, goals: Sequence[int]) -> Swap | None:
        """Another robot past which a robot does not get to each of some points that it reaches alone."""
        wanted = [goal for goal in goals if self.reaches(self.starts[robot], goal)]
        for other in range(len(self.starts)) if wanted else ():
            found = self._together(robot, other) if other != robot else None
            if found is not None and not found.at_first(wanted):
                return Swap((robot, other), found.count)
        return None

    def ends_apart(self, one: int, other: int, ends: tuple[int, int]) -> Swap | None:
        """Two robots that are never at their ends, points by number, both; each of them gets there alone."""
        alone = self.reaches(self.starts[one], ends[0]) and self.reaches(self.starts[other], ends[1])
        found = self._together(one, other) if alone else None
        return None if found is None or found.at_both(ends) else Swap((one, other), found.count)

    def _alone(self, start: int) -> Bools:
        """(n,): the points that a robot reaches from a point."""
        return self._once(("alone", start), lambda: _reached_alone(self.roadmap, start))

    def _together(self, one: int, other: int) -> _Reached | None:
        """The joint positions that two robots reach; None where nothing is to be searched."""
        return self._once(("together", one, other), lambda: self._searched(one, other))

    def _searched(self, one: int, other: int) -> _Reached | None:
        if min(self.starts[one], self.starts[other]) < 0:
            return None
        parts = int(self._part[self.starts[one]]), int(self._part[self.starts[other]])
        gap = self.radii_m[one] + self.radii_m[other] + self.roadmap.margin_m
        joint = self._once(("joint", parts, gap), lambda: self._joint(parts, gap))
        if joint is None:
            return None
        return _Reached(joint.points, joint.reached(self.starts[one], self.starts[other]))

    def _joint(self, parts: tuple[int, int], gap_m: float) -> JointPositions | None:
        """The joint positions on two parts of the roadmap, unless they are large and open, or there are too many.

        None where nobody on one part is in the way of another on the other one, too: they are rooms apart.
        """
        points = np.flatnonzero(self._part == parts[0]), np.flatnonzero(self._part == parts[1])
        moves = most_moves(self.roadmap, *points)
        if moves > _MOST_MOVES or (moves > _FEW_MOVES and _is_open(self.roadmap, *points)):
            return None
        if parts[0] != parts[1] and not _meet(self.roadmap, *points, gap_m):
            return None
        return JointPositions.of(self.roadmap, *points, gap_m)

    @property
    def _part(self) -> Indices:
        """(n,): the connected part of the roadmap, directions aside, in which a point is."""
        return self._once("part", lambda: _parts(self.roadmap))

    def _once(self, key: object, make: Callable[[], T]) -> T:
        """What was made under this key, or is made now."""
        if key not in self._made:
            self._made[key] = make()
        made: T = self._made[key]
        return made


@dataclass(frozen=True, eq=False)
class _Reached:
    """Joint positions (k, l) on points, (k,) and (l,), that two robots reach."""

    points: tuple[Indices, Indices]
    joint: Bools

    @property
    def count(self) -> int:
        return int(self.joint.sum())

    def at_first(self, goals: Sequence[int]) -> bool:
        """Whether the first robot reaches each of some points."""
        return bool(self.joint[np.searchsorted(self.points[0], goals)].any(axis=1).all())

    def at_both(self, ends: tuple[int, int]) -> bool:
        a, b = (np.searchsorted(points, end) for points, end in zip(self.points, ends, strict=True))
        return bool(self.joint[a, b])


def _graph(roadmap: Roadmap) -> Any:
    from scipy.sparse import csr_array

    n = len(roadmap.points)
    return csr_array((np.ones(len(roadmap.edges), dtype=np.int8), roadmap.edges.T), shape=(n, n))


def _parts(roadmap: Roadmap) -> Indices:
    from scipy.sparse.csgraph import connected_components

    return np.asarray(connected_components(_graph(roadmap), directed=False)[1])


def _reached_alone(roadmap: Roadmap, start: int) -> Bools:
    from scipy.sparse.csgraph import breadth_first_order

    found = np.zeros(len(roadmap.points), dtype=np.bool_)
    found[breadth_first_order(_graph(roadmap), start, return_predecessors=False)] = True
    return found


def _is_open(roadmap: Roadmap, one: Indices, other: Indices) -> bool:
    """Whether all edges of two parts lead both ways, and robots get past each other at most of their points.

    Any two robots change places there, and a search would take long to say so.
    """
    inside = roadmap.edges[np.isin(roadmap.edges[:, 0], np.union1d(one, other))]
    n = len(roadmap.points)
    both_ways = np.isin(inside[:, 0] * n + inside[:, 1], inside[:, 1] * n + inside[:, 0]).all()
    passed = (roadmap.passed[roadmap.layer[by[0]], points].mean() for points, by in ((one, other), (other, one)))
    return bool(both_ways and min(passed) > 0.5)


def _meet(roadmap: Roadmap, one: Indices, other: Indices, gap_m: float) -> bool:
    """Whether a robot on one part comes near to one on another."""
    first, second = (np.isin(np.arange(len(roadmap.points)), points) for points in (one, other))
    start = np.repeat(roadmap.edges[:, 0], np.diff(roadmap.reach_start))
    near = roadmap.reach_m < gap_m
    there = (first[start] & second[roadmap.reach_point]) | (second[start] & first[roadmap.reach_point])
    return bool((near & there).any())


@dataclass(frozen=True, eq=False)
class JointPositions:
    """The moves between joint positions (a, b) of two robots on (k,) and (l,) points, number a * l + b.

    Parameters
    ----------
    points
        of the parts of both.
    moves
        (k * l, k * l) sparse.
    """

    points: tuple[Indices, Indices]
    moves: Any

    @classmethod
    def of(cls, roadmap: Roadmap, one: Indices, other: Indices, gap_m: float) -> JointPositions:
        """On these points, of two robots in each other's way where they are nearer than `gap_m`."""
        from scipy.sparse import csr_array

        size, columns = len(one) * len(other), len(other)
        here, there, beside = _moves(roadmap, one, other, gap_m)
        here_too, there_too, beside_too = _moves(roadmap, other, one, gap_m)
        start = np.concatenate([here * columns + beside, beside_too * columns + here_too])
        end = np.concatenate([there * columns + beside, beside_too * columns + there_too])
        moves = csr_array((np.ones(len(start), dtype=np.int8), (start, end)), shape=(size, size))
        return cls((one, other), moves)

    def reached(self, one: int, other: int) -> Bools:
        """(k, l): the joint positions that two robots reach from two points, by their numbers in the roadmap."""
        from scipy.sparse.csgraph import breadth_first_order

        rows, columns = map(len, self.points)
        a, b = np.searchsorted(self.points[0], one), np.searchsorted(self.points[1], other)
        found = np.zeros(rows * columns, dtype=np.bool_)
        found[breadth_first_order(self.moves, int(a * columns + b), return_predecessors=False)] = True
        return found.reshape(rows, columns)


def most_moves(roadmap: Roadmap, one: Indices, other: Indices) -> int:
    """How many joint moves there may be on two parts of a roadmap."""
    edges = [int(np.isin(roadmap.edges[:, 0], points).sum()) for points in (one, other)]
    return edges[0] * len(other) + edges[1] * len(one)


def _local(roadmap: Roadmap, points: Indices) -> Indices:
    """For each point of the roadmap its number among these; -1 for the others."""
    local = np.full(len(roadmap.points), -1, dtype=np.int64)
    local[points] = np.arange(len(points))
    return local


def _moves(roadmap: Roadmap, points: Indices, others: Indices, gap_m: float) -> tuple[Indices, Indices, Indices]:
    """Moves of a robot between points, from and to, and where another is that is not in the way, (l,) each."""
    local, beside = _local(roadmap, points), _local(roadmap, others)
    edge = np.flatnonzero((local[roadmap.edges] >= 0).all(axis=1))
    number = np.full(len(roadmap.edges), -1, dtype=np.int64)
    number[edge] = np.arange(len(edge))
    hit = np.zeros((len(edge), len(others)), dtype=np.bool_)
    row = np.repeat(number, np.diff(roadmap.reach_start))
    column = beside[roadmap.reach_point]
    near = (roadmap.reach_m < gap_m) & (row >= 0) & (column >= 0)
    hit[row[near], column[near]] = True
    begins = beside[roadmap.edges[edge, 0]]
    hit[np.flatnonzero(begins >= 0), begins[begins >= 0]] = True
    which, other = np.nonzero(~hit)
    here, there = local[roadmap.edges[edge]].T
    return here[which], there[which], other
