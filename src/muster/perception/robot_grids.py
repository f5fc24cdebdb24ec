"""Occupancy grids that robots build themselves, in the cells of the team's map.

A cell of the team's map is an obstacle by a robot's grid where a cell of it that is occupied reaches into it, and free
where its centre lies in one that is free.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from muster.mission.errors import ParameterError
from muster.motion.grid import Bools, Grid

OCCUPIED, FREE = 65, 25
"""Per cent from which a cell counts as occupied, and below which it counts as free, as ROS saves maps."""
MOST_CELLS = 64_000_000
"""Cells of a grid at most: a square of 400 m at 5 cm."""
_INSET = 1e-3
"""Share of a cell by which the points that stand for it lie inside: its neighbours are not hit."""


@dataclass(frozen=True, eq=False)
class RobotGrid:
    """The occupancy grid of one robot.

    Parameters
    ----------
    cells : Grid
        Its cells in the map frame; blocked are those that are occupied.
    free : ndarray of bool, shape of the cells
        Which cells are free; others that are not occupied are unknown.
    """

    cells: Grid
    free: Bools

    @classmethod
    def of(
        cls, per_cent: npt.NDArray[np.int8], size: tuple[int, int], cell_m: float, origin: tuple[float, float, float]
    ) -> RobotGrid:
        """Return the grid of a message nav_msgs/OccupancyGrid.

        Parameters
        ----------
        per_cent : ndarray of int8, shape (rows * columns,)
            Occupancy of the cells, 0 to 100, row by row from the lowest; -1 where it is not known.
        size : tuple of int
            Rows and columns.
        cell_m : float
            Side of a cell, metres.
        origin : tuple of float
            x, y, yaw of the outer corner of cell (0, 0): metres in the map frame, radians.

        Raises
        ------
        ParameterError
            If these are no grid.
        """
        rows, columns = size
        if not (math.isfinite(cell_m) and cell_m > 0):
            raise ParameterError(f"resolution: {cell_m:g}; expected metres above 0")
        if not 0 < rows * columns <= MOST_CELLS:
            raise ParameterError(f"height, width: {rows}, {columns}; expected 1 to {MOST_CELLS} cells")
        if len(per_cent) != rows * columns:
            raise ParameterError(f"data: {len(per_cent)} cells; expected {rows} rows of {columns}")
        if not all(map(math.isfinite, origin)):
            raise ParameterError(f"origin: {', '.join(map(str, origin))}; expected finite numbers")
        values = per_cent.reshape(size)
        return cls(Grid(values >= OCCUPIED, cell_m, origin), (values >= 0) & (values < FREE))


class SeenCells(NamedTuple):
    """What a robot's grid says of the cells of another frame: which are obstacles, and which are free."""

    occupied: Bools
    free: Bools


def in_cells_of(frame: Grid, grid: RobotGrid) -> SeenCells:
    """Return what a robot's grid says of the cells of a frame."""
    occupied = _reached_into(frame, grid.cells)
    rows, columns = frame.shape
    across, up = np.meshgrid(np.arange(columns) + 0.5, np.arange(rows) + 0.5)
    there = grid.cells.to_grid(frame.to_map(np.column_stack([across.ravel(), up.ravel()])))
    column, row = np.floor(there).astype(np.int64).T
    height, width = grid.cells.shape
    within = (row >= 0) & (row < height) & (column >= 0) & (column < width)
    free = np.zeros(rows * columns, dtype=np.bool_)
    free[within] = grid.free[row[within], column[within]]
    return SeenCells(occupied, free.reshape(frame.shape) & ~occupied)


def _reached_into(frame: Grid, cells: Grid) -> Bools:
    """Return the cells of a frame into which blocked cells reach, by points in them that are no farther apart."""
    found = np.zeros(frame.shape, dtype=np.bool_)
    corners = np.argwhere(cells.blocked)[:, ::-1].astype(np.float64)
    steps = np.linspace(_INSET, 1 - _INSET, 1 + math.ceil(math.sqrt(2) * cells.resolution_m / frame.resolution_m))
    height, width = frame.shape
    for across in steps:
        for up in steps:
            column, row = np.floor(frame.to_grid(cells.to_map(corners + np.array([across, up])))).astype(np.int64).T
            within = (row >= 0) & (row < height) & (column >= 0) & (column < width)
            found[row[within], column[within]] = True
    return found
