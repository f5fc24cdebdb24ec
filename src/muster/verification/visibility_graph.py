"""Shortest paths along straight lines between points: SciPy's Dijkstra, guided towards the goal."""

from __future__ import annotations

import numpy as np

from muster.motion.grid import Floats, Indices

_DETOURS = (0.02, 0.08, 0.32, 1.28, 5.12, 20.48)  # of the straight line


class VisibilityGraph:
    """A graph of points that see each other.

    Parameters
    ----------
    nodes
        (n, 2) or (n, 3) points.
    pairs
        (k, 2) numbers of nodes that see each other, in either order, perhaps more than once.
    ends
        so many of the first nodes are where ways only begin or end: one may stand where nothing passes.
    """

    def __init__(self, nodes: Floats, pairs: Indices, ends: int = 0) -> None:
        from scipy.sparse import csr_array
        from scipy.sparse.csgraph import connected_components

        self._nodes, self._ends = nodes, ends
        count = len(nodes)
        edges = np.unique(np.concatenate([pairs, pairs[:, ::-1]]) @ np.array([count, 1], dtype=np.int64))
        self._from, to = np.divmod(edges, max(count, 1))
        self._to = to.astype(np.int32)
        self._starts = np.searchsorted(self._from, np.arange(count + 1)).astype(np.int32)
        self._lengths = np.linalg.norm(nodes[self._from] - nodes[to], axis=1)
        graph = csr_array((np.ones(len(edges)), self._to, self._starts), shape=(count, count))
        self._part = connected_components(graph, directed=False)[1]

    def way(self, start: int, end: int) -> Indices | None:
        """The nodes of a shortest way; None if there is none.

        A way's length counts as what it is longer than the straight line to the end: with that, Dijkstra is A*. It
        looks no farther than a detour that is widened until the end is within.
        """
        from scipy.sparse import csr_array
        from scipy.sparse.csgraph import dijkstra

        if self._part[start] != self._part[end]:
            return None
        left = np.linalg.norm(self._nodes - self._nodes[end], axis=1)
        excess = np.maximum(self._lengths + left[self._to] - left[self._from], 0.0)
        excess[(self._from < self._ends) & (self._from != start)] = np.inf
        graph = csr_array((excess, self._to, self._starts), shape=(len(left), len(left)))
        for limit in (*(detour * left[start] for detour in _DETOURS), np.inf):
            lengths, before = dijkstra(graph, indices=start, return_predecessors=True, limit=limit)
            if np.isfinite(lengths[end]):
                break
        else:
            return None
        way = [end]
        while way[-1] != start:
            way.append(int(before[way[-1]]))
        return np.array(way[::-1])

    def length(self, way: Indices) -> float:
        """How long a way is, in the unit of the nodes."""
        return float(np.linalg.norm(np.diff(self._nodes[way], axis=0), axis=1).sum())
