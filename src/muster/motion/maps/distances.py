"""Distances on a grid: inflation by a body's radius, and the clearance of points.

Both are exact: an obstacle is the whole square of a blocked cell, and what lies outside the grid is blocked. The judge
uses them, so the core has no part in them.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any

import numpy as np

from muster.motion.grid import Bools, Floats, Grid
from muster.motion.maps.free_points import blocked_at

_SLACK = 1e-9  # of a radius: 3 cells of 0.05 m are 0.15 m, whatever float64 says


def inflated(grid: Grid, radius_m: float) -> Grid:
    """The grid with every cell blocked of which some point is nearer than `radius_m` to a blocked cell's square.

    A centre anywhere in a free cell, its border included, has a clearance of at least `radius_m` (1 - 1e-9).
    """
    if radius_m <= 0:
        return grid
    reach = min(radius_m / grid.resolution_m, float(sum(grid.shape)))  # beyond the grid all is blocked
    near = _gaps(grid.blocked) < reach * (1 - _SLACK)
    return Grid(grid.blocked | near, grid.resolution_m, grid.origin)


def clearance_to_blocked(grid: Grid) -> Callable[[Floats], Floats]:
    """A function that gives metres (n,) from points (n, 2) of the map frame to the nearest blocked square."""
    from scipy.spatial import KDTree

    fenced = np.pad(grid.blocked, 1, constant_values=True)
    # A blocked cell without a free neighbour is nearest to no free place.
    centres = np.argwhere(fenced & _with_neighbours(~fenced))[:, ::-1].astype(np.float64) - 0.5
    tree = KDTree(centres) if len(centres) else None

    def clearance(points: Floats) -> Floats:
        cells = grid.to_grid(np.asarray(points, dtype=np.float64)[:, :2])
        metres = np.zeros(len(cells))
        clear = ~blocked_at(grid, cells)
        if tree is not None and clear.any():
            metres[clear] = _gaps_to_squares(tree, centres, cells[clear]) * grid.resolution_m
        return metres

    return clearance


def _gaps(blocked: Bools) -> Floats:
    """From the square of each cell to the nearest blocked square, in cells; 0 where they touch.

    Two squares are as far apart as the centre of one is from the centres of the other and its eight neighbours.
    """
    from scipy.ndimage import distance_transform_edt

    fenced = np.pad(blocked, 1, constant_values=True)
    gaps: Floats = distance_transform_edt(~_with_neighbours(fenced))
    return gaps[1:-1, 1:-1]


def _with_neighbours(cells: Bools) -> Bools:
    """These cells and their eight neighbours."""
    padded = np.pad(cells, 1)
    rows: Bools = padded[:-2] | padded[1:-1] | padded[2:]
    both: Bools = rows[:, :-2] | rows[:, 1:-1] | rows[:, 2:]
    return both


def _gaps_to_squares(tree: Any, centres: Floats, places: Floats) -> Floats:
    """From each place to the nearest of the unit squares around `centres`, in cells.

    With the nearest centre at distance d the nearest square is not farther than d, so its centre is within
    d + sqrt(1/2): only squares as near as that are looked at.
    """
    nearest, _ = tree.query(places)
    reach = nearest + math.sqrt(0.5) * (1 + _SLACK)
    found = tree.query_ball_point(places, reach)
    counts = np.array([len(some) for some in found])
    gaps = np.abs(np.repeat(places, counts, axis=0) - centres[np.concatenate(found).astype(np.int64)]) - 0.5
    lengths = np.hypot(*np.maximum(gaps, 0.0).T)
    least: Floats = np.minimum.reduceat(lengths, np.cumsum(counts) - counts)
    return least
