"""Which points a robot that moves along an edge comes near to."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from muster.mission.values.arrays import Floats, Indices
from muster.traffic.lane_sections import Section, held_back

_NEARER_M = 1e-9


def conflicts(
    points: Floats, edges: Indices, reach_m: float, sections: Sequence[Section] = ()
) -> tuple[Indices, Indices, Floats]:
    """For each edge u -> v the points w that a robot on it comes near to: start (m + 1,), point (l,), distance (l,).

    Those of edge k are at `start[k]` to `start[k + 1]`, by number; distances, in metres, are from w to the segment.
    v is one of them, at distance 0; u is not, nor is a point to which u is the nearest of the segment: from there the
    robot moves away.

    Parameters
    ----------
    points
        (n, 2) metres.
    edges
        (m, 2) from, to.
    reach_m
        only points nearer than that count.
    sections
        of lanes, each for one robot: an edge into one comes near to all points there, at distance 0.
    """
    edge, point = _candidates(points, edges, reach_m)
    from_u, along = points[point] - points[edges[edge, 0]], points[edges[edge, 1]] - points[edges[edge, 0]]
    squared = np.einsum("ij,ij->i", along, along)
    share = np.clip(np.einsum("ij,ij->i", from_u, along) / np.where(squared > 0, squared, 1.0), 0.0, 1.0)
    metres = np.hypot(*(from_u - share[:, np.newaxis] * along).T)
    metres[point == edges[edge, 1]] = 0.0
    near = (metres < reach_m) & (metres < np.hypot(*from_u.T) - _NEARER_M)
    edge, point, metres = edge[near], point[near], metres[near]
    into, there = held_back(points, edges, sections).T
    edge, point = np.append(edge, into), np.append(point, there)
    metres = np.append(metres, np.zeros(len(into)))
    order = np.lexsort((metres, point, edge))
    order = order[np.append(True, (np.diff(edge[order]) != 0) | (np.diff(point[order]) != 0))[: len(order)]]
    return np.searchsorted(edge[order], np.arange(len(edges) + 1)), point[order], metres[order]


def _candidates(points: Floats, edges: Indices, reach_m: float) -> tuple[Indices, Indices]:
    """Pairs of an edge and a point that may be within reach of it; edges of like length are looked at together."""
    from scipy.spatial import cKDTree

    found = [np.zeros((0, 2), dtype=np.int64)]
    tree = cKDTree(points)
    middles = points[edges].mean(axis=1)
    halves = np.linalg.norm(points[edges[:, 1]] - points[edges[:, 0]], axis=1) / 2
    classes = np.ceil(np.log2(np.maximum(halves / reach_m, 0.25)) * 2).astype(np.int64)
    for one in np.unique(classes):
        some = np.flatnonzero(classes == one)
        far = halves[some].max() + reach_m
        near = cKDTree(middles[some]).sparse_distance_matrix(tree, far, output_type="ndarray")
        found.append(np.stack([some[near["i"]], near["j"]], axis=1))
    pairs = np.concatenate(found)
    return pairs[:, 0], pairs[:, 1]
