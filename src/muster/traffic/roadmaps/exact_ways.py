"""What cells are too coarse for: places on a border of the free space, and passages narrower than a cell.

They are joined by exact shortest paths. Where all is joined already, this costs little.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from itertools import pairwise
from typing import TYPE_CHECKING, Any

import numpy as np

from muster.mission.values.arrays import Bools, Floats, Indices
from muster.motion.free_space import GridSpace, PolygonSpace
from muster.motion.path import Path
from muster.motion.paths import PathFinder

if TYPE_CHECKING:
    from collections.abc import Iterator

    from scipy.spatial import cKDTree


_CANDIDATES = 12
"""Nearest points that a place may be joined to."""
_SAME_M = 1e-9


@dataclass(frozen=True, eq=False)
class Network:
    """Points and edges that are made step by step.

    Parameters
    ----------
    points, narrow
        (n, 2) metres, and whether the room is for one there (n,).
    edges, clearance_m
        (m, 2) numbers of points, and (m,).
    places
        the point of each place; -1: none.
    """

    points: Floats
    narrow: Bools
    edges: Indices
    clearance_m: Floats
    places: Indices

    def merged(self) -> Network:
        """With one point in place of several at one place; of two edges between the same points one is left."""
        _, first, number = np.unique(self.points, axis=0, return_index=True, return_inverse=True)
        if len(first) == len(self.points):
            return self
        same = first[number.reshape(-1)]
        kept = np.unique(same)
        to = np.searchsorted(kept, same)
        ends = np.sort(to[self.edges], axis=1)
        between = np.flatnonzero(ends[:, 0] != ends[:, 1])
        edges, once = np.unique(ends[between], axis=0, return_index=True)
        places = np.where(self.places < 0, -1, to[self.places])
        return Network(self.points[kept], self.narrow[kept], edges, self.clearance_m[between[once]], places)

    def with_way(self, start: int, way: Floats, end: int) -> Network:
        """With the corners (k, 2) of a way between two points; of its clearance only that it is free is known."""
        first = len(self.points)
        numbers = [start, *range(first, first + len(way)), end]
        edges = np.concatenate([self.edges, np.array(list(pairwise(numbers)), dtype=np.int64)])
        clearance = np.concatenate([self.clearance_m, np.zeros(len(way) + 1)])
        points = np.concatenate([self.points, way])
        narrow = np.append(self.narrow, np.ones(len(way), dtype=np.bool_))
        return Network(points, narrow, edges, clearance, self.places)

    def with_point(self, at: Floats) -> Network:
        return replace(self, points=np.concatenate([self.points, at[np.newaxis]]), narrow=np.append(self.narrow, True))

    def with_place(self, place: int, point: int) -> Network:
        """With a point, by number, as that of a place."""
        numbers = self.places.copy()
        numbers[place] = point
        return replace(self, places=numbers)


def joined_exactly(made: Network, space: GridSpace | PolygonSpace, places: Floats) -> Network:
    """A network whose points are joined where the free space joins them, with every place (k, 2) that is free."""
    from scipy.spatial import cKDTree

    lanes = cKDTree(made.points)
    finder: PathFinder | None = None
    if isinstance(space, PolygonSpace):
        for part, groups in _torn(made, space):
            finder = finder or PathFinder(space)
            made = _mended(made, groups, finder, part)
    for place in np.flatnonzero(made.places < 0):
        finder = finder or PathFinder(space)
        made = with_place(made, int(place), places[place], finder, lanes)
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
        return made.with_point(np.array([inside.x, inside.y]))
    joined = groups[0]
    for group in groups[1:]:
        away, near = cKDTree(made.points[joined]).query(made.points[group])
        one, other = int(group[np.argmin(away)]), int(joined[near[np.argmin(away)]])
        found = finder.path(made.points[one], made.points[other])
        if isinstance(found, Path):
            made = made.with_way(one, found.points[1:-1], other)
            joined = np.concatenate([joined, group])
    return made


def with_place(made: Network, place: int, at: Floats, finder: PathFinder | None, lanes: cKDTree) -> Network:
    """With a point for a place, joined straight to a near one, else by the shortest path to the nearest there is.

    Parameters
    ----------
    finder
        of the free space; None where all is free.
    lanes
        the first points of the network: the place is joined to one of them; one is its own where it is there.
    """
    if not lanes.n:
        return made
    away, near = lanes.query(at, k=min(_CANDIDATES, lanes.n))
    candidates = [int(k) for k in np.atleast_1d(near)]
    if np.atleast_1d(away)[0] < _SAME_M:
        return made.with_place(place, candidates[0])
    way = _way(at, made.points[candidates], finder)
    if way is None:
        return made
    k, corners = way
    return made.with_point(at).with_place(place, len(made.points)).with_way(len(made.points), corners, candidates[k])


def _way(at: Floats, points: Floats, finder: PathFinder | None) -> tuple[int, Floats] | None:
    """The nearest of points to which a straight way leads, else a path: its number, and the corners of the way."""
    for k, point in enumerate(points):
        if finder is None or finder.clear(np.stack([at, point])):
            return k, np.zeros((0, 2))
    for k, point in enumerate(points):
        found = finder.path(at, point) if finder is not None else None
        if isinstance(found, Path):
            return k, found.points[1:-1]
    return None
