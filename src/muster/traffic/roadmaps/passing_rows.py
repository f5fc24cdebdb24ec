"""Rows of points along walls, where robots of two sizes get past each other only if both keep to their side.

Where the room is for one large robot its layer has a row of points along the middle. A smaller robot may get past one
that stands at a wall there nevertheless, if it drives along the other wall. So both layers get rows along both walls.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Sequence
from dataclasses import replace
from functools import partial
from itertools import combinations

import numpy as np

from muster.mission.values.arrays import Bools, Floats
from muster.motion.free_space import GridSpace, PolygonSpace
from muster.motion.grid import Grid
from muster.motion.maps.distance_field import distance_field
from muster.motion.maps.raster import grid_of
from muster.traffic.roadmaps.exact_ways import Network
from muster.traffic.roadmaps.lane_points import Room
from muster.traffic.roadmaps.robot_spaces import RobotSpaces

_CELLS = 12
"""Cells between two robots that do not touch."""
_MOST_CELLS = 1_000_000
_NEXT = 1.5
"""Points of a row that are no farther from each other, in times their least distance, are joined."""
_ENTRIES = 2
"""Points of the layer to which each point of a row is joined."""
_DENSER = 4
"""Places on a wall that are looked at, for each point of a row."""


def with_passing_rows(
    networks: Sequence[Network], radii_m: Sequence[float], spaces: RobotSpaces, margin_m: float
) -> list[Network]:
    """The networks of some sizes of robots, the smallest first, with rows where two sizes pass each other so alone."""
    tight: list[list[Grid]] = [[] for _ in networks]
    for (b, small_m), (a, wide_m) in combinations(enumerate(radii_m), 2):
        space = spaces.space(wide_m)
        if space is not None:
            found = _tight_places(space, wide_m, small_m, margin_m)
            tight[a].append(found)
            tight[b].append(found)
    made = list[Network]()
    for network, radius_m, grids in zip(networks, radii_m, tight, strict=True):
        space = spaces.space(radius_m)
        clear = partial(spaces.clear, radius_m=radius_m)
        made.append(network if space is None else _with_rows(network, space, 2 * radius_m + margin_m, grids, clear))
    return made


def _tight_places(space: GridSpace | PolygonSpace, radius_m: float, smaller_m: float, margin_m: float) -> Grid:
    """Where the room is for one robot of a radius, though a smaller one gets past it: the cells that are not blocked.

    Cells are larger than the free space of the large robot by what the free space of the small one is.
    """
    from scipy.ndimage import distance_transform_edt, maximum_filter

    apart_m, room_m = 2 * radius_m + margin_m, 2 * smaller_m + margin_m
    grid = _cells(space, apart_m)
    cell = grid.resolution_m
    depth = distance_field(grid) / cell
    narrow = Room.of(~grid.blocked, depth, apart_m / cell).narrow
    width = maximum_filter(depth, size=2 * math.ceil(apart_m / cell / 2) + 1)
    tight = narrow & (width + 1 >= room_m / cell / 2)
    if tight.any():
        tight = distance_transform_edt(~tight) <= (radius_m - smaller_m) / cell + 2
    return Grid(~tight, cell, grid.origin)


def _with_rows(
    made: Network,
    space: GridSpace | PolygonSpace,
    apart_m: float,
    tight: Iterable[Grid],
    clear: Callable[[Floats], bool],
) -> Network:
    """A network with points along the walls of its free space in tight places, `apart_m` from each other.

    `clear` says whether the straight way along points is free.
    """
    from scipy.spatial import cKDTree

    walls = _along_walls(space, apart_m / _DENSER)
    inside = np.zeros(len(walls), dtype=np.bool_)
    for grid in tight:
        inside |= _is_in(grid, walls)
    rows = _thinned(walls[inside], apart_m)
    if len(rows) and len(made.points):
        rows = rows[cKDTree(made.points).query(rows)[0] > apart_m / _DENSER]  # else the layer has a point there
    if not len(rows) or not len(made.points):
        return made
    first = len(made.points)
    pairs = cKDTree(rows).query_pairs(_NEXT * apart_m, output_type="ndarray") + first
    _, near = cKDTree(made.points).query(rows, k=min(4 * _ENTRIES, first))
    points = np.concatenate([made.points, rows])
    edges = [pair for pair in pairs.tolist() if clear(points[pair])]
    for k, candidates in enumerate(np.reshape(near, (len(rows), -1)).tolist(), first):
        edges += [(k, j) for j in candidates if clear(points[[k, j]])][:_ENTRIES]
    both = np.array(edges, dtype=np.int64).reshape(-1, 2)
    both = np.concatenate([both, both[:, ::-1]])
    return replace(
        made,
        points=points,
        narrow=np.append(made.narrow, np.ones(len(rows), dtype=np.bool_)),
        edges=np.concatenate([made.edges, both]),
        clearance_m=np.append(made.clearance_m, np.zeros(len(both))),
    )


def _cells(space: GridSpace | PolygonSpace, apart_m: float) -> Grid:
    if isinstance(space, GridSpace):
        return space.grid
    west, south, east, north = space.region.bounds
    return grid_of(space, max(apart_m / _CELLS, math.sqrt((east - west) * (north - south) / _MOST_CELLS)))


def _along_walls(space: GridSpace | PolygonSpace, spacing_m: float) -> Floats:
    """Free places (n, 2) beside walls, in their order along each."""
    if isinstance(space, GridSpace):
        beside = ~space.grid.blocked & (distance_field(space.grid) < space.grid.resolution_m)
        return space.grid.to_map(np.argwhere(beside)[:, ::-1].astype(np.float64) + 0.5)
    import shapely

    found = [np.zeros((0, 2))]
    for ring in shapely.get_rings(shapely.get_parts(space.region)):
        count = max(1, math.ceil(ring.length / spacing_m))
        found.append(
            shapely.get_coordinates(shapely.line_interpolate_point(ring, np.arange(count) * ring.length / count))
        )
    return np.concatenate(found)


def _is_in(grid: Grid, places: Floats) -> Bools:
    """Which places are in cells that are not blocked."""
    column, row = np.floor(grid.to_grid(places)).astype(np.int64).T
    rows, columns = grid.shape
    found = (column >= 0) & (column < columns) & (row >= 0) & (row < rows)
    found[found] = ~grid.blocked[row[found], column[found]]
    return np.asarray(found)


def _thinned(places: Floats, apart_m: float) -> Floats:
    """As many of the places as are so far apart, the first ones first."""
    from scipy.spatial import cKDTree

    if not len(places):
        return places
    near = cKDTree(places).query_ball_point(places, apart_m * (1 - 1e-9))
    gone, kept = np.zeros(len(places), dtype=np.bool_), list[int]()
    for k, others in enumerate(near):
        if not gone[k]:
            kept.append(k)
            gone[others] = True
    return places[np.array(kept, dtype=np.int64)]
