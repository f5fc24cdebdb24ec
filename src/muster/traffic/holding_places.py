"""Holding places: where a robot may rest while others get past it."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

Bools = npt.NDArray[np.bool_]
Floats = npt.NDArray[np.float64]
Indices = npt.NDArray[np.int64]

_AROUND = 2.0
"""Others get past where they do so within so many times the distance of the edges' ends."""


def holding_places(points: Floats, edges: Indices, reach_start: Indices, reach_point: Indices, reach_m: float) -> Bools:
    """For each point whether its neighbours stay joined, close by, by edges that do not come near to it: (n,).

    A point with one neighbour, or none, is at the end of a way and holds nobody up.

    Parameters
    ----------
    points, edges, reach_start, reach_point
        of a roadmap.
    reach_m
        at which robots are in each other's way.
    """
    from scipy.sparse import coo_array
    from scipy.sparse.csgraph import connected_components
    from scipy.spatial import cKDTree

    n = len(points)
    if not len(edges):
        return np.ones(n, dtype=np.bool_)
    lengths = np.linalg.norm(points[edges[:, 0]] - points[edges[:, 1]], axis=1)
    longest = np.zeros(n)
    np.maximum.at(longest, edges[:, 0], lengths)
    np.maximum.at(longest, edges[:, 1], lengths)
    around = _around(cKDTree(points), points, np.maximum(longest, reach_m))
    blocked = np.unique(np.repeat(np.arange(len(edges)), np.diff(reach_start)) * n + reach_point)
    # Copies of the graph, one around each point, side by side: node k of them is (centre, point).
    keys = around[:, 0] * n + around[:, 1]
    of_point = np.argsort(around[:, 1], kind="stable")
    first = np.searchsorted(around[of_point, 1], np.arange(n + 1))
    counts = np.diff(first)[edges[:, 0]]
    edge = np.repeat(np.arange(len(edges)), counts)
    k = np.arange(len(edge)) - np.repeat(np.cumsum(counts) - counts, counts) + first[edges[edge, 0]]
    one = of_point[k]
    centre = around[one, 0]
    wanted = centre * n + edges[edge, 1]
    other = np.searchsorted(keys, wanted).clip(max=len(keys) - 1)
    fits = (keys[other] == wanted) & (centre != edges[edge, 0]) & (centre != edges[edge, 1])
    past = edge * n + centre
    at = np.searchsorted(blocked, past).clip(max=len(blocked) - 1)
    fits &= blocked[at] != past
    links = coo_array((np.ones(int(fits.sum())), (one[fits], other[fits])), shape=(len(keys), len(keys)))
    _, part = connected_components(links, directed=False)
    ends = np.concatenate([edges, edges[:, ::-1]])
    parts = part[np.searchsorted(keys, ends[:, 0] * n + ends[:, 1])]
    least, most = np.full(n, len(keys)), np.full(n, -1)
    np.minimum.at(least, ends[:, 0], parts)
    np.maximum.at(most, ends[:, 0], parts)
    return least >= most


def _around(tree: object, points: Floats, longest: Floats) -> Indices:
    """(k, 2): for each point those around it, itself aside, in order."""
    found = tree.query_ball_point(points, _AROUND * longest, return_sorted=True)  # type: ignore[attr-defined]
    counts = np.array([len(some) for some in found])
    pairs = np.stack([np.repeat(np.arange(len(points)), counts), np.concatenate(found).astype(np.int64)], axis=1)
    return np.asarray(pairs[pairs[:, 0] != pairs[:, 1]])
