"""Polygons as cells, conservatively: a cell is blocked as soon as some of it is."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any

import numpy as np
import numpy.typing as npt

from muster.mission.errors import ParameterError
from muster.mission.values.ranges import require_positive
from muster.motion.free_space import PolygonSpace
from muster.motion.grid import Bools, Grid, Indices

if TYPE_CHECKING:
    from shapely.geometry.base import BaseGeometry

_MOST_CELLS = 10**8
_SLACK = 1e-9  # of a cell: what reaches into it by less does not touch it


def grid_of(space: PolygonSpace, resolution_m: float) -> Grid:
    """A grid over a region whose cells are free only where they lie wholly in the region.

    Raises
    ------
    ParameterError
        if the resolution is not above 0, or so fine that there would be more than 10^8 cells.
    """
    import shapely

    require_positive(resolution_m=resolution_m)
    if space.region.is_empty:
        return Grid(np.ones((1, 1), dtype=np.bool_), resolution_m)
    west, south, east, north = space.region.bounds
    columns = max(1, math.ceil((east - west) / resolution_m - _SLACK))
    rows = max(1, math.ceil((north - south) / resolution_m - _SLACK))
    if rows * columns > _MOST_CELLS:
        raise ParameterError(f"resolution_m: {resolution_m:g} makes {rows} x {columns} cells; expected 10^8 at most")
    frame = Grid(np.zeros((rows, columns), dtype=np.bool_), resolution_m, (west, south, 0.0))
    beyond = shapely.difference(shapely.box(0, 0, columns, rows), in_cells(space.region, frame))
    return Grid(touched(beyond, (rows, columns)), resolution_m, frame.origin)


def default_resolution(radius_m: float, extent_m: float) -> float:
    """A resolution for bodies of a radius in a region whose longer side is `extent_m`: half the radius, metres.

    Never finer than a thousandth of the region nor coarser than a hundredth; without a radius a 500th.
    """
    wanted = radius_m / 2 if radius_m > 0 else extent_m / 500
    return min(max(wanted, extent_m / 1000), extent_m / 100)


def in_cells(shape: BaseGeometry, grid: Grid) -> BaseGeometry:
    """A shape of the map frame in cells of a grid."""
    import shapely

    return shapely.transform(shape, grid.to_grid)


def touched(shape: BaseGeometry, size: tuple[int, int]) -> Bools:
    """The cells (rows, columns) that a shape reaches into, the shape being given in cells; its mere border is nothing.

    Row by row: what lies in a row falls into connected parts, and each of them touches every cell from its one end to
    its other.
    """
    import shapely

    rows, columns = size
    marks = np.zeros((rows, columns + 1), dtype=np.int32)
    if shape.is_empty:
        return marks[:, :-1] > 0
    pieces, row = _by_rows(shape, rows)
    parts, at = shapely.get_parts(pieces, return_index=True)
    left, low, right, high = shapely.bounds(parts).T
    solid = (shapely.get_type_id(parts) == _POLYGON) & (high - low > _SLACK) & (right - left > 2 * _SLACK)
    first = np.clip(np.floor(left[solid] + _SLACK), 0, columns).astype(np.int64)
    last = np.clip(np.ceil(right[solid] - _SLACK), 0, columns).astype(np.int64)
    np.add.at(marks, (row[at[solid]], first), 1)
    np.add.at(marks, (row[at[solid]], last), -1)
    return np.cumsum(marks, axis=1)[:, :-1] > 0


def _by_rows(shape: BaseGeometry, rows: int) -> tuple[npt.NDArray[Any], Indices]:
    """What of a shape, in cells, lies in each row that it reaches into: pieces, and their rows.

    Bands of rows are halved, so that no row is cut out of the whole shape.
    """
    import shapely

    west, south, east, north = shape.bounds
    pieces = np.array([shape], dtype=object)
    first = np.array([max(0, math.floor(south))])
    end = np.array([min(rows, math.ceil(north))])
    while len(pieces) and int((end - first).max()) > 1:
        middle = (first + end + 1) // 2
        whole = np.concatenate([pieces, pieces])
        first, end = np.concatenate([first, middle]), np.concatenate([middle, end])
        some = end > first
        ones = np.ones(int(some.sum()))
        first, end = first[some], end[some]
        pieces = shapely.intersection(whole[some], shapely.box((west - 1) * ones, first, (east + 1) * ones, end))
        filled = ~shapely.is_empty(pieces)
        pieces, first, end = pieces[filled], first[filled], end[filled]
    return pieces, first


_POLYGON = 3  # Shapely's type id
