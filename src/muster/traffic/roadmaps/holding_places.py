"""Where a robot may rest while others get past it."""

from __future__ import annotations

from typing import Any

import numpy as np

from muster.mission.values.arrays import Bools, Floats, Indices

_AROUND = 2.0
"""Others get past where they do so within so many times the length of the edges there, and the reach of a robot."""


def passable(centres: Floats, points: Floats, edges: Indices, hits: tuple[Indices, Indices], reach_m: float) -> Bools:
    """Whether others get past a robot that rests at a centre: (c,).

    They do where the nearest points that are out of its way stay joined to and fro, close by, by edges that do not come
    near to it. At the end of a way there is one such point, or none, and nobody to be held up.

    Parameters
    ----------
    centres
        (c, 2) metres.
    points, edges
        of the layer of a roadmap by which the others pass.
    hits
        edges, by number, and centres that each comes near to.
    reach_m
        at which such robots are in each other's way.
    """
    from scipy.sparse import coo_array
    from scipy.sparse.csgraph import connected_components

    c = len(centres)
    if not len(edges) or not c:
        return np.ones(c, dtype=np.bool_)
    around = _Neighbourhoods.of(centres, points, edges, reach_m)
    copy, edge = around.copies(edges)
    start, end = around.find(copy, edges[edge, 0]), around.find(copy, edges[edge, 1])
    hit = _is_in(edge * c + copy, np.sort(hits[0] * c + hits[1]))
    out_of_way = ~around.near[start] & ~around.near[end] & ~hit
    links = coo_array(
        (np.ones(int(out_of_way.sum()), dtype=np.int8), (start[out_of_way], end[out_of_way])), shape=(around.size,) * 2
    )
    _, part = connected_components(links, connection="strong")
    ring = np.concatenate([end[around.near[start] & ~around.near[end]], start[around.near[end] & ~around.near[start]]])
    least, most = np.full(c, around.size), np.full(c, -1)
    np.minimum.at(least, around.centre[ring], part[ring])
    np.maximum.at(most, around.centre[ring], part[ring])
    return np.asarray(least >= most)


def far_m(centres: Floats, points: Floats, edges: Indices, reach_m: float) -> Floats:
    """How far around each centre others look for a way past it: (c,), metres. Parameters as of `passable`."""
    from scipy.spatial import cKDTree

    longest = np.full(len(points), reach_m)
    lengths = np.linalg.norm(points[edges[:, 0]] - points[edges[:, 1]], axis=1)
    np.maximum.at(longest, edges.ravel(), lengths.repeat(2))
    return np.asarray(_AROUND * longest[cKDTree(points).query(centres)[1]] + reach_m)


class _Neighbourhoods:
    """The points around each centre: copies of parts of a roadmap, side by side.

    `centre`, `point` (size,) are sorted; `near` (size,) says whether the point is within reach of the centre.
    """

    def __init__(self, centre: Indices, point: Indices, near: Bools, n: int) -> None:
        self.centre, self.point, self.near = centre, point, near
        self._n, self._keys = n, centre * n + point

    @property
    def size(self) -> int:
        return len(self.centre)

    @classmethod
    def of(cls, centres: Floats, points: Floats, edges: Indices, reach_m: float) -> _Neighbourhoods:
        from scipy.spatial import cKDTree

        found: Any = cKDTree(points).query_ball_point(
            centres, far_m(centres, points, edges, reach_m), return_sorted=True
        )
        centre = np.repeat(np.arange(len(centres)), [len(some) for some in found])
        point = np.concatenate(found).astype(np.int64)
        near = np.linalg.norm(centres[centre] - points[point], axis=1) < reach_m
        return cls(centre, point, near, len(points))

    def copies(self, edges: Indices) -> tuple[Indices, Indices]:
        """The centres around which both ends of an edge are, and the edges, by number."""
        order = np.argsort(self.point, kind="stable")
        first = np.searchsorted(self.point[order], np.arange(self._n + 1))
        counts = np.diff(first)[edges[:, 0]]
        edge = np.repeat(np.arange(len(edges)), counts)
        k = np.arange(len(edge)) - np.repeat(np.cumsum(counts) - counts, counts) + first[edges[edge, 0]]
        centre = self.centre[order[k]]
        both = _is_in(centre * self._n + edges[edge, 1], self._keys)
        return centre[both], edge[both]

    def find(self, centre: Indices, point: Indices) -> Indices:
        """The numbers of points around centres."""
        return np.searchsorted(self._keys, centre * self._n + point)


def _is_in(keys: Indices, sorted_keys: Indices) -> Bools:
    if not len(sorted_keys):
        return np.zeros(len(keys), dtype=np.bool_)
    at = np.searchsorted(sorted_keys, keys).clip(max=len(sorted_keys) - 1)
    return np.asarray(sorted_keys[at] == keys)
