"""The edges of a roadmap: which points robots move between, on straight free pieces."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from muster import core
from muster.mission.values.arrays import Bools, Floats, Indices

_SAME = 1e-6
"""Relative: pieces of a square count as what they are, whatever float64 says."""


@dataclass(frozen=True, eq=False)
class Sight:
    """Which straight pieces are free, from quick to exact.

    Parameters
    ----------
    cells
        the free cells.
    depth
        (rows, columns): from a cell's centre to the nearest blocked square, in cells.
    exact
        of pieces (k, 2 ends, 2), in cells, that leave the free cells, whether they are free nevertheless (k,).
    """

    cells: core.GridMap
    depth: Floats
    exact: Callable[[Floats], Bools]

    def sees(self, a: Floats, b: Floats) -> bool:
        """Whether a piece is in free cells."""
        return self.cells.sees((float(a[0]), float(a[1])), (float(b[0]), float(b[1])))

    def free(self, pieces: Floats) -> Bools:
        """Whether pieces (k, 2, 2) are free."""
        # A disc as large as the depth is free around a cell's centre: two that cover a piece make looking needless.
        middles = np.floor(pieces)
        column, row = middles.astype(np.int64).transpose(2, 0, 1)
        radii = self.depth[row, column] - np.linalg.norm(pieces - middles - 0.5, axis=2)
        found = radii.clip(min=0).sum(axis=1) > np.linalg.norm(pieces[:, 0] - pieces[:, 1], axis=1)
        for k in np.flatnonzero(~found):
            found[k] = self.sees(*pieces[k])
        found[~found] = self.exact(pieces[~found])
        return np.asarray(found)


def visible_pairs(sight: Sight, points: Floats, reach: float) -> Indices:
    """Pairs (m, 2) of points (n, 2), in cells, that see each other and are within `reach` cells; by number."""
    from scipy.spatial import cKDTree

    pairs = cKDTree(points).query_pairs(reach, output_type="ndarray").astype(np.int64)
    pairs = pairs[np.lexsort(pairs.T[::-1])]
    return np.asarray(pairs[sight.free(points[pairs])])


def pruned(pairs: Indices, points: Floats, lanes: int) -> Indices:
    """The pairs without those that a point of the lanes stands between: a Gabriel graph of what sees each other.

    A pair goes where both its points see a third one from which the two appear at more than a right angle. Each pair
    that goes is replaced by two shorter ones, so what is connected stays so. [gabriel1969]

    Parameters
    ----------
    lanes
        the first so many points are lanes; the others are places, through which no lane leads.
    """
    n = len(points)
    both = np.concatenate([pairs, pairs[:, ::-1]])
    both = both[np.lexsort(both.T[::-1])]
    keys = both[:, 0] * n + both[:, 1]
    starts = np.searchsorted(both[:, 0], np.arange(n + 1))
    squared = ((points[pairs[:, 0]] - points[pairs[:, 1]]) ** 2).sum(axis=1)
    counts = np.diff(starts)[pairs[:, 0]]
    pair = np.repeat(np.arange(len(pairs)), counts)
    k = np.arange(len(pair)) - np.repeat(np.cumsum(counts) - counts, counts)
    third = both[starts[pairs[pair, 0]] + k, 1]
    other = pairs[pair, 1]
    fits = (third < lanes) & (third != other)
    pair, third, other = pair[fits], third[fits], other[fits]
    legs = ((points[pairs[pair, 0]] - points[third]) ** 2).sum(axis=1) + ((points[other] - points[third]) ** 2).sum(
        axis=1
    )
    between = legs < squared[pair] * (1 - _SAME)
    pair, wanted = pair[between], third[between] * n + other[between]
    at = np.searchsorted(keys, wanted).clip(max=len(keys) - 1)
    gone = np.zeros(len(pairs), dtype=np.bool_)
    gone[pair[keys[at] == wanted]] = True
    return pairs[~gone]


@dataclass(frozen=True, eq=False)
class Regions:
    """The free cells divided among points by the nearest way: a Voronoi diagram in free space.

    Parameters
    ----------
    owner, parent
        for each cell of the fenced grid, flat: the point it belongs to, -1 for none; the cell one step nearer to it.
    width
        columns of the fenced grid.
    """

    owner: Indices
    parent: Indices
    width: int

    @classmethod
    def of(cls, free: Bools, points: Floats) -> Regions:
        """Of free cells (rows, columns) among points (n, 2) in cells, each in a free one: a flood from all at once."""
        width = free.shape[1] + 2
        owner = np.pad(free, 1).ravel().astype(np.int64) - 2
        parent = np.full(len(owner), -1, dtype=np.int64)
        cells = points.astype(np.int64)
        front = (cells[:, 1] + 1) * width + cells[:, 0] + 1
        owner[front] = np.arange(len(points))
        front = np.unique(front)
        while len(front):
            grown = []
            for step in (1, -1, width, -width):
                there = front + step
                fresh = owner[there] == -1
                there, here = there[fresh], front[fresh]
                owner[there], parent[there] = owner[here], here
                grown.append(there)
            front = np.concatenate(grown)
        return cls(np.maximum(owner, -1), parent, width)

    def cell_at(self, point: Floats) -> int:
        """The cell of the fenced grid in which a point is."""
        return (int(point[1]) + 1) * self.width + int(point[0]) + 1

    def back(self, cell: int) -> list[Floats]:
        """The middles of the cells from one to the point that it belongs to."""
        way = [cell]
        while (last := int(self.parent[way[-1]])) >= 0:
            way.append(last)
        return [np.array([c % self.width - 0.5, c // self.width - 0.5]) for c in way]

    def touching(self, points: int) -> Indices:
        """(k, 4): the points of two regions that touch, the lower first, and a cell of each, where they do."""
        found = []
        for step in (1, self.width):
            one, other = self.owner[:-step], self.owner[step:]
            cell = np.flatnonzero((one >= 0) & (other >= 0) & (one != other))
            found.append(np.stack([one[cell], other[cell], cell, cell + step], axis=1))
        touching = np.concatenate(found)
        swapped = touching[:, 0] > touching[:, 1]
        touching[swapped] = touching[swapped][:, [1, 0, 3, 2]]
        _, first = np.unique(touching[:, 0] * points + touching[:, 1], return_index=True)
        return np.asarray(touching[first])


def detours(regions: Regions, points: Floats, pairs: Indices, sight: Sight) -> tuple[Floats, Indices]:
    """Further points (k, 2) and pairs (l, 2) where neighbours in free space have no short way: around bends.

    Where the regions of two points touch and no three pairs join them, the corners of a path through both regions are
    added. So the pairs connect whatever the free cells connect.
    """
    touching = regions.touching(len(points))
    ways = [
        (a, [points[a], *regions.back(one)[::-1], *regions.back(other), points[b]], b)
        for a, b, one, other in touching[~_joined(touching, pairs, len(points))].tolist()
    ]
    return _cornered(ways, len(points), sight)


def ways_to_lanes(regions: Regions, points: Floats, hidden: Indices, sight: Sight) -> tuple[Floats, Indices]:
    """Further points (k, 2) and pairs (l, 2) that join points which see no lane, by number, to that of their region."""
    ways = []
    for a in hidden.tolist():
        cell = regions.cell_at(points[a])
        b = int(regions.owner[cell])
        ways.append((a, [points[a], *regions.back(cell), points[b]], b))
    return _cornered(ways, len(points), sight)


def _cornered(ways: list[tuple[int, list[Floats], int]], count: int, sight: Sight) -> tuple[Floats, Indices]:
    """The corners (k, 2), numbered from `count`, of ways from one point to another, and the pairs (l, 2) along them."""
    found: list[Floats] = []
    pairs: list[tuple[int, int]] = []
    for a, way, b in ways:
        corners = _taut(way, sight)[1:-1]
        first = count + len(found)
        pairs += pairwise([a, *range(first, first + len(corners)), b])
        found += corners
    return np.reshape(found, (-1, 2)), np.reshape(np.array(pairs, dtype=np.int64), (-1, 2))


def _joined(touching: Indices, pairs: Indices, n: int) -> Bools:
    """Whether the points of each row are joined by three pairs at most."""
    from scipy.sparse import csr_array

    stay = np.repeat(np.arange(n), 2).reshape(-1, 2)
    moves = np.concatenate([pairs, pairs[:, ::-1], stay])
    one = csr_array((np.ones(len(moves)), moves.T), shape=(n, n))
    two = one @ one
    return np.asarray((two[touching[:, 0]] * one[touching[:, 1]]).sum(axis=1)).ravel() > 0


def _taut(way: list[Floats], sight: Sight) -> list[Floats]:
    """A way by as few of its points as see each other one after the other."""
    taut, k = [way[0]], 0
    while k < len(way) - 1:
        k = next(j for j in range(len(way) - 1, k, -1) if j == k + 1 or sight.sees(way[k], way[j]))
        taut.append(way[k])
    return taut
