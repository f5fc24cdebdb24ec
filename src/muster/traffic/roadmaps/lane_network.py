"""From free space to a network: points where robots stand, and the straight free pieces between them."""

from __future__ import annotations

import math
from dataclasses import replace
from functools import partial
from typing import Any

import numpy as np

from muster import core
from muster.mission.values.arrays import Bools, Floats, Indices
from muster.motion.free_space import GridSpace, PolygonSpace
from muster.motion.grid import Grid
from muster.motion.maps.distance_field import distance_field
from muster.motion.maps.raster import grid_of
from muster.traffic.roadmaps.exact_ways import Network, joined_exactly
from muster.traffic.roadmaps.lane_points import Room, lane_points
from muster.traffic.roadmaps.roadmap_edges import Regions, Sight, detours, pruned, visible_pairs, ways_to_lanes

_CELLS = 12
"""Cells between two robots that do not touch, where the map leaves the choice."""
_FEWEST_CELLS = 6
"""Coarser maps are divided more finely."""
_MOST_CELLS = 1_500_000
_MOST_HALVINGS = 4
"""So often cells are halved where a passage is too narrow for them."""
_CELLS_ACROSS = 3.0
"""A passage at least so many cells wide is joined cell by cell, whatever its direction."""
_APART = 1 + 1e-6
"""Points that are to be apart are so whatever float64 says."""
_NEIGHBOURS = 2.0
"""Points up to so many times the pitch of the lattice from each other may be joined."""


def network(space: GridSpace | PolygonSpace, apart_m: float, places: Floats, most_points: int) -> Network:
    """The network of a free space.

    Parameters
    ----------
    apart_m
        two robots whose centres are so far apart do not touch.
    places
        (k, 2) metres: each gets a point, where it is free and can be joined.
    most_points
        about so many points at most are laid into open space.
    """
    grid = _cells(space, apart_m)
    cell = grid.resolution_m
    free, depth = ~grid.blocked, distance_field(grid) / cell
    apart = apart_m * _APART / cell
    pitch = max(apart, math.sqrt(free.sum() / most_points))
    sight = Sight(core.GridMap(grid.blocked), depth, partial(_inside, space, grid))
    inside = grid.to_grid(places)
    is_free = np.array([_is_inside(free, place) for place in inside], dtype=np.bool_)

    middle = partial(to_middle, space=space, grid=grid, depth=depth)
    room = Room.of(free, depth, apart)
    lanes = lane_points(room, apart, pitch, inside[is_free], middle)
    lanes = _with_all_parts(free, depth, lanes)
    reach = _NEIGHBOURS * pitch
    regions = Regions.of(free, lanes)
    bends, around = detours(regions, lanes, visible_pairs(sight, lanes, reach), sight)
    lanes = np.concatenate([lanes, bends])
    points, numbers = _with_places(lanes, inside, is_free, pitch)
    seen = visible_pairs(sight, points, reach)
    pairs = pruned(seen[(seen < len(lanes)).any(axis=1)], points, len(lanes))
    hidden = np.setdiff1d(np.arange(len(lanes), len(points)), pairs)
    corners, ways = ways_to_lanes(regions, points, hidden, sight)
    points = np.concatenate([points, corners])
    pairs = np.unique(np.sort(np.concatenate([pairs, around, ways]), axis=1), axis=0)
    metres = grid.to_map(points)
    metres[numbers[is_free]] = places[is_free]
    column, row = points.astype(np.int64).T
    made = Network(metres, room.narrow[row, column], pairs, _clearance(depth, points, pairs) * cell, numbers)
    return _both_ways(joined_exactly(made.merged(), space, places))


def _both_ways(made: Network) -> Network:
    edges = np.concatenate([made.edges, made.edges[:, ::-1]])
    return replace(made, edges=edges, clearance_m=np.tile(made.clearance_m, 2))


def _cells(space: GridSpace | PolygonSpace, apart_m: float) -> Grid:
    """Cells that are free as a whole, small beside the distance of robots."""
    if isinstance(space, PolygonSpace):
        west, south, east, north = space.region.bounds
        finest_m = math.sqrt((east - west) * (north - south) / _MOST_CELLS)
        cell_m = max(apart_m * _APART / _CELLS, finest_m)
        for _ in range(_MOST_HALVINGS):
            if cell_m <= finest_m or not _hide_passages(space, cell_m, apart_m):
                break
            cell_m = max(cell_m / 2, finest_m)
        return grid_of(space, cell_m)
    grid = space.grid
    finer = math.ceil(grid.resolution_m * _FEWEST_CELLS / apart_m)
    finer = max(1, min(finer, math.isqrt(_MOST_CELLS // max(1, grid.blocked.size))))
    blocked = grid.blocked.repeat(finer, axis=0).repeat(finer, axis=1)
    return Grid(blocked, grid.resolution_m / finer, grid.origin)


def _hide_passages(space: PolygonSpace, cell_m: float, apart_m: float) -> bool:
    """Whether the region has passages, not only corners, that are too narrow to be seen in cells of a size."""
    import shapely

    half_m = _CELLS_ACROSS * cell_m / 2
    cores = shapely.buffer(space.region, -half_m, join_style="mitre")
    seen = shapely.buffer(cores, half_m * _APART, join_style="mitre")
    west, south, east, north = shapely.bounds(shapely.get_parts(shapely.difference(space.region, seen))).T
    return bool((np.hypot(east - west, north - south) > max(apart_m, 2 * half_m)).any())


def _inside(space: GridSpace | PolygonSpace, grid: Grid, pieces: Floats) -> Bools:
    """Whether pieces (k, 2, 2), in cells, are inside a region, which cells say too strictly; a grid is its cells."""
    if not isinstance(space, PolygonSpace):
        return np.zeros(len(pieces), dtype=np.bool_)
    import shapely

    shapely.prepare(space.region)
    metres = grid.to_map(pieces.reshape(-1, 2)).reshape(-1, 2, 2)
    return np.asarray(shapely.contains_properly(space.region, shapely.linestrings(metres)))


def _is_inside(free: Bools, place: Floats) -> bool:
    column, row = np.floor(place).astype(int)
    rows, columns = free.shape
    return bool(0 <= column < columns and 0 <= row < rows and free[row, column])


def _with_all_parts(free: Bools, depth: Floats, points: Floats) -> Floats:
    """The points, and one more in each connected part of the free cells that has none."""
    from scipy.ndimage import label, maximum_position

    parts, count = label(free)
    cells = points.astype(np.int64)
    empty = np.setdiff1d(np.arange(1, count + 1), parts[cells[:, 1], cells[:, 0]])
    if not len(empty):
        return points
    deepest = np.array(maximum_position(depth, parts, empty), dtype=np.float64)
    return np.concatenate([points, deepest[:, ::-1] + 0.5])


def _with_places(lanes: Floats, places: Floats, is_free: Bools, pitch: float) -> tuple[Floats, Indices]:
    """The points with those of places that are on none yet, and the point of each place (-1: it is not free)."""
    from scipy.spatial import cKDTree

    numbers = np.full(len(places), -1, dtype=np.int64)
    away, numbers[is_free] = cKDTree(lanes).query(places[is_free])
    further = np.flatnonzero(is_free)[away > 1e-6 * pitch]
    fresh, which = np.unique(places[further], axis=0, return_inverse=True)
    numbers[further] = len(lanes) + which.ravel()
    return np.concatenate([lanes, fresh]), numbers


def _clearance(depth: Floats, points: Floats, pairs: Indices) -> Floats:
    """Cells by which each piece is away from blocked ones at least, to within a cell or so."""
    ends = points[pairs]
    steps = int(np.ceil(2 * np.linalg.norm(ends[:, 1] - ends[:, 0], axis=1).max(initial=0.0))) + 1
    least = np.full(len(pairs), np.inf)
    for share in np.linspace(0.0, 1.0, steps):
        at = (1 - share) * ends[:, 0] + share * ends[:, 1]
        cells = at.astype(np.int64)
        least = np.minimum(least, depth[cells[:, 1], cells[:, 0]] - np.linalg.norm(at - cells - 0.5, axis=1))
    return least.clip(min=0.0)


_FARTHEST = 0.75
"""Cells that a point moves at most."""


def to_middle(points: Floats, space: GridSpace | PolygonSpace, grid: Grid, depth: Floats) -> Floats:
    """Points (n, 2) in passages for one, in cells of a grid, moved to the middle where that is in a free cell.

    Parameters
    ----------
    points
        each in the middle of a cell.
    space
        what the grid was made of.
    depth
        from each cell to the nearest blocked one, in cells.
    """
    if not len(points):
        return points
    steps = _between_walls(points, space, grid) if isinstance(space, PolygonSpace) else _between_cells(points, depth)
    moved = points + steps
    column, row = np.floor(moved).astype(np.int64).T
    rows, columns = grid.shape
    inside = (row >= 0) & (row < rows) & (column >= 0) & (column < columns)
    inside[inside] = ~grid.blocked[row[inside], column[inside]]
    return np.where(inside[:, np.newaxis], moved, points)


def _between_cells(points: Floats, depth: Floats) -> Floats:
    """Half a cell towards the neighbour that is as deep, where the one on the other side is not."""
    fenced = np.pad(depth, 1)
    column, row = points.astype(np.int64).T + 1
    steps = np.zeros_like(points)
    for axis, (across, up) in enumerate(((1, 0), (0, 1))):
        here = fenced[row, column]
        after = fenced[row + up, column + across] >= here
        before = fenced[row - up, column - across] >= here
        steps[:, axis] = 0.5 * (after.astype(np.float64) - before)
    return steps


def _between_walls(points: Floats, space: PolygonSpace, grid: Grid) -> Floats:
    """Half of what the wall across is farther than the nearest one."""
    import shapely

    cell = grid.resolution_m
    metres = grid.to_map(points)
    walls: Any = _sides(space)
    tree = shapely.STRtree(walls)
    _, side = tree.query_nearest(shapely.points(metres), all_matches=False)
    feet = shapely.get_coordinates(shapely.shortest_line(shapely.points(metres), walls[side]))[1::2]
    away = np.linalg.norm(metres - feet, axis=1)
    across = (metres - feet) / np.maximum(away, 1e-12)[:, np.newaxis]
    # The wall across is looked for as far as it may be where the point is moved.
    far = away + 2 * _FARTHEST * cell
    rays: Any = shapely.linestrings(np.stack([metres, metres + far[:, np.newaxis] * across], axis=1))
    ray, wall = tree.query(rays, predicate="intersects")
    hits = shapely.distance(shapely.points(metres[ray]), shapely.intersection(rays[ray], walls[wall]))
    opposite = np.full(len(points), np.inf)
    np.minimum.at(opposite, ray, hits)
    length = np.where(np.isfinite(opposite), (opposite - away) / 2, 0.0).clip(min=0.0)
    return np.asarray(length[:, np.newaxis] * across / cell)


def _sides(space: PolygonSpace) -> Any:
    """The sides of a region, a line each."""
    import shapely

    rings = [shapely.get_coordinates(ring) for ring in shapely.get_rings(shapely.get_parts(space.region))]
    ends: Any = np.concatenate([np.stack([ring[:-1], ring[1:]], axis=1) for ring in rings])
    return shapely.linestrings(ends)
