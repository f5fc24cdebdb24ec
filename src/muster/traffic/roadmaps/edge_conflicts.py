"""Which points a robot that moves along an edge comes near to."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import NamedTuple, Protocol

import numpy as np
import numpy.typing as npt

from muster import core
from muster.mission.values.arrays import Bools, Floats, Indices
from muster.traffic.roadmaps.lane_sections import Section, held_back

_NEARER_M = 1e-9


class WithConflicts(Protocol):
    """Points and edges of which it is known how near each edge comes to which points.

    See `muster.traffic.roadmaps.roadmap.Roadmap`, which is one.
    """

    @property
    def points(self) -> Floats: ...
    @property
    def edges(self) -> Indices: ...
    @property
    def speed_mps(self) -> Floats: ...
    @property
    def reach_start(self) -> Indices: ...
    @property
    def reach_point(self) -> Indices: ...
    @property
    def reach_m(self) -> Floats: ...


def annotated(roadmap: WithConflicts) -> core.AnnotatedRoadmap:
    """Return a roadmap as planners of the core take it; its edges are in the order of their first points."""
    points, edges = np.asarray(roadmap.points, dtype=np.float64), np.asarray(roadmap.edges, dtype=np.int64)
    return core.AnnotatedRoadmap(
        np.ascontiguousarray(points),
        np.searchsorted(edges[:, 0], np.arange(len(points) + 1)).tolist(),
        edges[:, 1].tolist(),
        np.linalg.norm(points[edges[:, 1]] - points[edges[:, 0]], axis=1).tolist(),
        np.asarray(roadmap.speed_mps, dtype=np.float64).tolist(),
        roadmap.reach_start.tolist(),
        roadmap.reach_point.tolist(),
        roadmap.reach_m.tolist(),
    )


class Near(NamedTuple):
    """Edges (l,), points (l,) that a robot on each comes near to, and how near (l,), metres."""

    edge: Indices
    point: Indices
    metres: Floats


class Known(NamedTuple):
    """The conflicts between edges and points that were there before others were added.

    Parameters
    ----------
    near : Near
        By the numbers of edges and points among all.
    edges : Bools
        (m,): which edges were there.
    points : int
        The number of points that were there, which come first.
    """

    near: Near
    edges: Bools
    points: int


def conflicts(
    points: Floats,
    edges: Indices,
    reach_m: npt.ArrayLike,
    sections: Sequence[Section] = (),
    layer: Indices | None = None,
    known: Known | None = None,
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
        only points nearer than that count; (k, k) by the layers of edge and point.
    sections
        of lanes, each for one robot: an edge into one comes near to all points there, at distance 0.
    layer
        (n,): the layer of each point, and of the edges that begin there; without it all are of one.
    known
        conflicts that are not computed again.
    """
    reaches = np.atleast_2d(np.asarray(reach_m, dtype=np.float64))
    layer = np.zeros(len(points), dtype=np.int64) if layer is None else layer
    found = [] if known is None else [known.near]
    for (a, b), reach in np.ndenumerate(reaches):
        some, others = np.flatnonzero(layer[edges[:, 0]] == a), np.flatnonzero(layer == b)
        found += [_near(points, edges, *pairs, float(reach)) for pairs in _unknown(some, others, known)]
    held = held_back(points, edges, sections)
    edge = np.concatenate([*(one.edge for one in found), held[:, 0]])
    point = np.concatenate([*(one.point for one in found), held[:, 1]])
    metres = np.concatenate([*(one.metres for one in found), np.zeros(len(held))])
    order = np.lexsort((metres, point, edge))
    order = order[np.append(True, (np.diff(edge[order]) != 0) | (np.diff(point[order]) != 0))[: len(order)]]
    return np.searchsorted(edge[order], np.arange(len(edges) + 1)), point[order], metres[order]


def _unknown(edges: Indices, points: Indices, known: Known | None) -> Iterator[tuple[Indices, Indices]]:
    """Edges and points, by number, of each of which all conflicts are to be computed."""
    if known is None:
        yield edges, points
        return
    before = known.edges[edges]
    yield edges[~before], points
    yield edges[before], points[points >= known.points]


def _near(points: Floats, edges: Indices, some: Indices, others: Indices, reach_m: float) -> Near:
    """For some edges, by number, which of some points, by number, are nearer than `reach_m`."""
    edge, point = _candidates(points, edges, some, others, reach_m)
    from_u, along = points[point] - points[edges[edge, 0]], points[edges[edge, 1]] - points[edges[edge, 0]]
    squared = np.einsum("ij,ij->i", along, along)
    share = np.clip(np.einsum("ij,ij->i", from_u, along) / np.where(squared > 0, squared, 1.0), 0.0, 1.0)
    metres = np.hypot(*(from_u - share[:, np.newaxis] * along).T)
    metres[point == edges[edge, 1]] = 0.0
    near = (metres < reach_m) & (metres < np.hypot(*from_u.T) - _NEARER_M)
    return Near(edge[near], point[near], metres[near])


def _candidates(
    points: Floats, edges: Indices, some: Indices, others: Indices, reach_m: float
) -> tuple[Indices, Indices]:
    """Pairs of an edge and a point that may be within reach of it; edges of like length are looked at together."""
    from scipy.spatial import cKDTree

    found = [np.zeros((0, 2), dtype=np.int64)]
    tree = cKDTree(points[others])
    ends = points[edges[some]]
    middles = ends.mean(axis=1)
    halves = np.linalg.norm(ends[:, 1] - ends[:, 0], axis=1) / 2
    classes = np.ceil(np.log2(np.maximum(halves / reach_m, 0.25)) * 2).astype(np.int64)
    for one in np.unique(classes):
        alike = np.flatnonzero(classes == one)
        far = halves[alike].max() + reach_m
        near = cKDTree(middles[alike]).sparse_distance_matrix(tree, far, output_type="ndarray")
        found.append(np.stack([some[alike[near["i"]]], others[near["j"]]], axis=1))
    pairs = np.concatenate(found)
    return pairs[:, 0], pairs[:, 1]
