"""Moves points of passages from the middle of a cell to the middle between the walls."""

from __future__ import annotations

from typing import Any

import numpy as np

from muster.mission.values.arrays import Floats
from muster.motion.free_space import GridSpace, PolygonSpace
from muster.motion.grid import Grid

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
