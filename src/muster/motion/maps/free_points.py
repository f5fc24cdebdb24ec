"""Whether points are free in a space.

Borders are free, and so is what is beyond one by no more than rounding: 1e-10 of the map's extent, and what float64
leaves uncertain in coordinates far from zero. Planners and the judge ask here, so that they agree about every place.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from muster.motion.free_space import GridSpace, Prism, PrismSpace, Space
from muster.motion.grid import Bools, Floats, Grid

if TYPE_CHECKING:
    from shapely.geometry.base import BaseGeometry

_SLACK = 1e-10  # of the extent
_ULPS = 2e-15  # of the greatest coordinate


def free(space: Space, points: Floats) -> Bools:
    """Whether points (n, 2) or (n, 3) of the map frame, metres, are free: (n,).

    Heights count in a PrismSpace alone, which needs them.
    """
    places = np.asarray(points, dtype=np.float64)
    slack = slack_m(space, places)
    if isinstance(space, GridSpace):
        return _in_free_cells(space.grid, places, slack)
    if space.region.is_empty:
        return np.zeros(len(places), dtype=np.bool_)
    within = _within(space.region, places, slack)
    if isinstance(space, PrismSpace):
        within &= places[:, 2] >= space.lowest_m - slack
        for prism in space.prisms:
            within &= ~_inside_prism(prism, places, slack)
    return within


def slack_m(space: Space, places: Floats) -> float:
    """Metres by which places (n, d) may be beyond a border of a space and still be free."""
    if isinstance(space, GridSpace):
        extent = space.grid.resolution_m * max(space.grid.shape)
    else:
        west, south, east, north = space.region.bounds
        extent = max(east - west, north - south)
    return _SLACK * extent + _ULPS * float(np.abs(places).max(initial=0.0))


def blocked_at(grid: Grid, cells: Floats) -> Bools:
    """Whether places (n, 2), in cells as (column, row), lie in a blocked cell or outside the grid: (n,)."""
    rows, columns = grid.shape
    column, row = np.floor(cells).T
    inside = (column >= 0) & (column < columns) & (row >= 0) & (row < rows)
    blocked: Bools = ~inside
    blocked[inside] = grid.blocked[row[inside].astype(np.int64), column[inside].astype(np.int64)]
    return blocked


def _in_free_cells(grid: Grid, places: Floats, slack: float) -> Bools:
    """Whether one of the cells is free that a place lies in or on the border of."""
    cells, reach = grid.to_grid(places[:, :2]), slack / grid.resolution_m
    found = np.zeros(len(places), dtype=np.bool_)
    for across in (-reach, reach):
        for up in (-reach, reach):
            found |= ~blocked_at(grid, cells + np.array([across, up]))
    return found


def _within(region: BaseGeometry, places: Floats, slack: float) -> Bools:
    import shapely

    shapely.prepare(region)
    return np.asarray(shapely.dwithin(region, shapely.points(places[:, :2]), slack))


def _inside_prism(prism: Prism, places: Floats, slack: float) -> Bools:
    """Whether a place is deeper in a prism than the slack, through sides, floor and ceiling."""
    import shapely

    heights = places[:, 2]
    inside = np.asarray((heights > prism.floor_m + slack) & (heights < prism.ceiling_m - slack))
    feet = shapely.points(places[inside, :2])
    shapely.prepare(prism.polygon)
    beside = shapely.dwithin(prism.polygon.boundary, feet, slack)
    inside[inside] = np.logical_and(shapely.contains_properly(prism.polygon, feet), ~beside)
    return inside
