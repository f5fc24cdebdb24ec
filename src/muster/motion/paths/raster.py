"""A region as a grid that is on the safe side."""

from __future__ import annotations

import math

import numpy as np

from muster.mission.errors import MissingExtraError, ParameterError
from muster.motion.grid import Grid
from muster.motion.spaces import PolygonSpace

_MOST_CELLS = 10**8


def grid_of(space: PolygonSpace, resolution_m: float) -> Grid:
    """A grid over a region whose cells are free only where they lie wholly in the region.

    Raises
    ------
    ParameterError
        if the resolution is not above 0, or so fine that there would be more than 10^8 cells.
    MissingExtraError
        without the extra `map`.
    """
    try:
        import shapely
    except ImportError as missing:
        raise MissingExtraError("map", "a grid over polygons") from missing

    if not resolution_m > 0:
        raise ParameterError(f"resolution_m: {resolution_m:g}; expected a number above 0")
    west, south, east, north = space.region.bounds
    columns, rows = (max(1, math.ceil(side / resolution_m - 1e-9)) for side in (east - west, north - south))
    if rows * columns > _MOST_CELLS:
        raise ParameterError(f"resolution_m: {resolution_m:g} makes {rows} x {columns} cells; expected 10^8 at most")
    x = west + resolution_m * np.arange(columns + 1)
    y = south + resolution_m * np.arange(rows + 1)
    shapely.prepare(space.region)
    cells = shapely.box(x[np.newaxis, :-1], y[:-1, np.newaxis], x[np.newaxis, 1:], y[1:, np.newaxis])
    return Grid(~shapely.covers(space.region, cells), resolution_m, (west, south, 0.0))
