"""The connected free region around a point as a polygon, for planners that follow borders or measure distances."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from muster.mission.values.arrays import Floats
from muster.motion.free_space import GridSpace, PolygonSpace
from muster.motion.grid import Grid

if TYPE_CHECKING:
    import shapely

_GAP = 1e-6
"""By which share of a cell a grid's region is smaller, so that two blocked cells at a corner let nothing through."""


def part_around(space: GridSpace | PolygonSpace, point: Floats) -> shapely.Polygon:
    """The part of the free region in which a free point lies, metres in the map frame.

    Its rings have the inside on the left. On a grid the region is smaller than the free cells by a millionth of a cell.
    """
    import shapely

    region = space.region if isinstance(space, PolygonSpace) else _free_cells(space.grid)
    parts = list(getattr(region, "geoms", [region]))
    nearest = int(np.argmin(shapely.distance(parts, shapely.Point(point[:2]))))
    found: shapely.Polygon = shapely.orient_polygons(parts[nearest])
    return found


def slack_of(space: GridSpace | PolygonSpace) -> float:
    """Metres by which a free point may lie outside the region of `part_around`."""
    if isinstance(space, GridSpace):
        return 4 * _GAP * space.grid.resolution_m
    west, south, east, north = space.region.bounds
    return 1e-9 * max(east - west, north - south)


def _free_cells(grid: Grid) -> shapely.Polygon | shapely.MultiPolygon:
    """The union of the free cells, in runs along the rows."""
    import shapely

    fenced = np.pad(~grid.blocked, ((0, 0), (1, 1))).astype(np.int8)
    change = np.diff(fenced, axis=1)
    rows, first = np.nonzero(change == 1)
    last = np.nonzero(change == -1)[1]
    region = shapely.union_all(shapely.box(first, rows, last, rows + 1))
    apart = region.buffer(-_GAP, join_style="mitre")
    return shapely.transform(apart, grid.to_map)
