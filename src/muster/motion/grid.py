"""The occupancy grid: the map as squares that are free or blocked."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

Bools = npt.NDArray[np.bool_]
Floats = npt.NDArray[np.float64]
Indices = npt.NDArray[np.int64]


@dataclass(frozen=True, eq=False)
class Grid:
    """Cells of a plane, each free or blocked. What lies outside is blocked.

    Parameters
    ----------
    blocked
        (rows, columns); row 0 is the lowest, y of the grid grows with the row, x with the column.
    resolution_m
        side of a cell.
    origin
        (x, y, yaw) of the outer corner of cell (0, 0): metres in the map frame, radians anticlockwise.
    """

    blocked: Bools
    resolution_m: float
    origin: tuple[float, float, float] = (0.0, 0.0, 0.0)

    def __post_init__(self) -> None:
        blocked = np.ascontiguousarray(self.blocked, dtype=np.bool_)
        blocked.setflags(write=False)
        object.__setattr__(self, "blocked", blocked)

    @property
    def shape(self) -> tuple[int, int]:
        """(rows, columns)."""
        return self.blocked.shape[0], self.blocked.shape[1]

    def to_grid(self, points: Floats) -> Floats:
        """Points (n, 2) of the map frame in cells: (n, 2) of (column, row), the cell (0, 0) from 0 to 1."""
        x, y, yaw = self.origin
        east, north = points[:, 0] - x, points[:, 1] - y
        c, s = math.cos(yaw), math.sin(yaw)
        return np.stack([c * east + s * north, c * north - s * east], axis=1) / self.resolution_m

    def to_map(self, points: Floats) -> Floats:
        """The inverse of `to_grid`: (n, 2) metres in the map frame."""
        x, y, yaw = self.origin
        along, across = points[:, 0] * self.resolution_m, points[:, 1] * self.resolution_m
        c, s = math.cos(yaw), math.sin(yaw)
        return np.stack([x + c * along - s * across, y + s * along + c * across], axis=1)
