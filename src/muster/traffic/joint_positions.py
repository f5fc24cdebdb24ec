"""All joint positions of two robots on a part of a roadmap, one moving at a time while the other stands."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from muster.mission.values.arrays import Bools, Indices
from muster.traffic.roadmap import Roadmap


@dataclass(frozen=True, eq=False)
class JointPositions:
    """The moves between joint positions (a, b) of two robots, number a * k + b.

    Parameters
    ----------
    points
        (k,): the points of the part.
    moves
        (k^2, k^2) sparse.
    """

    points: Indices
    moves: Any

    @classmethod
    def of(cls, roadmap: Roadmap, points: Indices, gap_m: float) -> JointPositions:
        """On these points, of two robots in each other's way where they are nearer than `gap_m`."""
        from scipy.sparse import csr_array

        k = len(points)
        edge, hit = _hits(roadmap, points, gap_m)
        u, v = _local(roadmap, points)[roadmap.edges[edge]].T
        which, other = np.nonzero(~hit)
        here, there = u[which], v[which]
        start = np.concatenate([here * k + other, other * k + here])
        end = np.concatenate([there * k + other, other * k + there])
        return cls(points, csr_array((np.ones(len(start), dtype=np.int8), (start, end)), shape=(k * k, k * k)))

    def reached(self, one: int, other: int) -> Bools:
        """(k, k): the joint positions that two robots reach from two points, by their numbers in the roadmap."""
        from scipy.sparse.csgraph import breadth_first_order

        k = len(self.points)
        a, b = np.searchsorted(self.points, [one, other])
        found = np.zeros(k * k, dtype=np.bool_)
        found[breadth_first_order(self.moves, int(a * k + b), return_predecessors=False)] = True
        return found.reshape(k, k)


def most_moves(roadmap: Roadmap, points: Indices) -> int:
    """How many joint moves there may be on a part of a roadmap."""
    return 2 * len(points) * int(np.isin(roadmap.edges[:, 0], points).sum())


def _local(roadmap: Roadmap, points: Indices) -> Indices:
    """For each point of the roadmap its number among these; -1 for the others."""
    local = np.full(len(roadmap.points), -1, dtype=np.int64)
    local[points] = np.arange(len(points))
    return local


def _hits(roadmap: Roadmap, points: Indices, gap_m: float) -> tuple[Indices, Bools]:
    """The edges between these points, and at which of the points (edges, k) another robot is in the way of each."""
    local = _local(roadmap, points)
    edge = np.flatnonzero((local[roadmap.edges] >= 0).all(axis=1))
    number = np.full(len(roadmap.edges), -1, dtype=np.int64)
    number[edge] = np.arange(len(edge))
    hit = np.zeros((len(edge), len(points)), dtype=np.bool_)
    row = np.repeat(number, np.diff(roadmap.reach_start))
    column = local[roadmap.reach_point]
    near = (roadmap.reach_m < gap_m) & (row >= 0) & (column >= 0)
    hit[row[near], column[near]] = True
    hit[np.arange(len(edge)), local[roadmap.edges[edge, 0]]] = True
    return edge, hit
