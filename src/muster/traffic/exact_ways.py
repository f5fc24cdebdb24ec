"""What cells are too coarse for: places on a border of the free space, and passages narrower than a cell.

They are joined by exact shortest paths. Where all is joined already, this costs little.
"""

from __future__ import annotations

from dataclasses import dataclass
from itertools import pairwise
from typing import TYPE_CHECKING, Any

import numpy as np
import numpy.typing as npt

from muster.motion.free_space import GridSpace, PolygonSpace
from muster.motion.path import Path
from muster.motion.paths import PathFinder

if TYPE_CHECKING:
    from collections.abc import Iterator

Floats = npt.NDArray[np.float64]
Indices = npt.NDArray[np.int64]

_CANDIDATES = 12
"""Nearest points that a place may be joined to straight."""


@dataclass(frozen=True, eq=False)
class Network:
    """Points (n, 2) in metres, edges (m, 2), their clearance (m,) in metres, and the point of each place (-1: none)."""

    points: Floats
    edges: Indices
    clearance_m: Floats
    places: Indices

    def with_way(self, start: int, way: Floats, end: int) -> Network:
        """With the corners (k, 2) of a way between two points; nothing is known of its clearance but that it is free."""
        first = len(self.points)
        numbers = [start, *range(first, first + len(way)), end]
        edges = np.concatenate([self.edges, np.array(list(pairwise(numbers)), dtype=np.int64)])
        clearance = np.concatenate([self.clearance_m, np.zeros(len(way) + 1)])
        return Network(np.concatenate([self.points, way]), edges, clearance, self.places)

    def with_place(self, place: int, at: Floats) -> Network:
        """With a point for a place."""
        numbers = self.places.copy()
        numbers[place] = len(self.points)
        return Network(np.concatenate([self.points, at[np.newaxis]]), self.edges, self.clearance_m, numbers)


def joined_exactly(made: Network, space: GridSpace | PolygonSpace, places: Floats) -> Network:
    """A network whose points are joined where the free space joins them, with every place (k, 2) that is free."""
    lanes = len(made.points)
    finder: PathFinder | None = None
    if isinstance(space, PolygonSpace):
        for part, groups in _torn(made, space):
            finder = finder or PathFinder(space)
            made = _mended(made, groups, finder, part)
    for place in np.flatnonzero(made.places < 0):
        finder = finder or PathFinder(space)
        made = _with_place(made, int(place), places[place], finder, lanes)
    return made


def _torn(made: Network, space: PolygonSpace) -> Iterator[tuple[Any, list[Indices]]]:
    """The connected parts of a region of which the network has no point, or groups of points that are not joined."""
    import shapely
    from scipy.sparse import coo_array
    from scipy.sparse.csgraph import connected_components

    n = len(made.points)
    links = coo_array((np.ones(len(made.edges)), made.edges.T), shape=(n, n))
    count, group = connected_components(links, directed=False)
    parts = shapely.get_parts(space.region)
    if count == len(parts) == 1:
        return
    members = np.split(np.argsort(group, kind="stable"), np.cumsum(np.bincount(group, minlength=count))[:-1])
    first = shapely.points(made.points[[some[0] for some in members]]) if count else np.array([])
    for part in parts:
        inside = np.flatnonzero(shapely.dwithin(part, first, 1e-9))
        if len(inside) != 1:
            yield part, sorted((members[k] for k in inside), key=len, reverse=True)


def _mended(made: Network, groups: list[Indices], finder: PathFinder, part: Any) -> Network:
    """With a point in a part without any, or with ways between groups of points in a part, each to the nearest."""
    from scipy.spatial import cKDTree

    if not groups:
        inside = part.representative_point()
        return Network(np.concatenate([made.points, [[inside.x, inside.y]]]), made.edges, made.clearance_m, made.places)
    joined = groups[0]
    for group in groups[1:]:
        away, near = cKDTree(made.points[joined]).query(made.points[group])
        one, other = int(group[np.argmin(away)]), int(joined[near[np.argmin(away)]])
        found = finder.path(made.points[one], made.points[other])
        if isinstance(found, Path):
            made = made.with_way(one, found.points[1:-1], other)
            joined = np.concatenate([joined, group])
    return made


def _with_place(made: Network, place: int, at: Floats, finder: PathFinder, lanes: int) -> Network:
    """With a point for a place, joined straight to a near one, else by the shortest path to the nearest there is."""
    from scipy.spatial import cKDTree

    if not lanes:
        return made
    _, near = cKDTree(made.points[:lanes]).query(at, k=min(_CANDIDATES, lanes))
    candidates = [int(k) for k in np.atleast_1d(near)]
    seen = next((k for k in candidates if finder.clear(np.stack([at, made.points[k]]))), None)
    if seen is not None:
        return made.with_place(place, at).with_way(len(made.points), np.zeros((0, 2)), seen)
    for k in candidates:
        found = finder.path(at, made.points[k])
        if isinstance(found, Path):
            return made.with_place(place, at).with_way(len(made.points), found.points[1:-1], k)
    return made
