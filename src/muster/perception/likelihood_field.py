"""The likelihood field of a map: how likely the end of a beam is at a place ([thrun2005], section 6.4).

The likelihood falls with the distance to the nearest wall. It needs no rays, so that thousands of poses are weighed in
milliseconds.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from muster.mission.errors import ParameterError
from muster.mission.values.ranges import require_finite_positive
from muster.motion.grid import Grid
from muster.motion.maps.distance_field import distance_field
from muster.perception.kalman import Floats

_MARGIN_M = 1.0
"""The field goes on beyond the outermost walls by this; further out a beam's end is as unlikely as at the margin."""


@dataclass(frozen=True, eq=False)
class LikelihoodField:
    """Distances to the nearest wall, by cell. Made by `of_walls`.

    Parameters
    ----------
    frame
        where the cells are.
    distances_m
        (rows, columns), from the centre of a cell.
    """

    frame: Grid
    distances_m: Floats

    @classmethod
    def of_walls(cls, walls: Floats, resolution_m: float = 0.05) -> LikelihoodField:
        """The field of straight walls.

        Parameters
        ----------
        walls
            (k, 4), the x, y of both ends in metres, map frame; k at least 1.

        Raises
        ------
        ParameterError
            for another shape, no wall, or a resolution that is not above 0.
        """
        ends = np.asarray(walls, dtype=np.float64)
        if ends.ndim != 2 or ends.shape[1:] != (4,) or not len(ends) or not np.isfinite(ends).all():
            raise ParameterError(f"walls: shape {ends.shape}; expected (any, 4) finite numbers, at least one wall")
        require_finite_positive(resolution_m=resolution_m)
        points = _along(ends, resolution_m / 2)
        margin = math.ceil(_MARGIN_M / resolution_m)
        west, south = points.min(axis=0) - 2 * margin * resolution_m
        column, row = ((points - (west, south)) / resolution_m).astype(int).T
        blocked = np.zeros((row.max() + 2 * margin + 1, column.max() + 2 * margin + 1), dtype=np.bool_)
        blocked[row, column] = True
        inside = slice(margin, -margin)  # a distance field has an obstacle around it, which is no wall
        distances = distance_field(Grid(blocked, resolution_m))[inside, inside]
        corner = (float(west + margin * resolution_m), float(south + margin * resolution_m), 0.0)
        return cls(Grid(blocked[inside, inside], resolution_m, corner), np.ascontiguousarray(distances))

    def distances(self, points: Floats) -> Floats:
        """Metres (...) from points (..., 2) of the map frame to the nearest wall."""
        x, y, _ = self.frame.origin
        rows, columns = self.frame.shape
        scale = 1 / self.frame.resolution_m
        column = np.clip(((points[..., 0] - x) * scale).astype(np.int64), 0, columns - 1)
        row = np.clip(((points[..., 1] - y) * scale).astype(np.int64), 0, rows - 1)
        found: Floats = self.distances_m[row, column]
        return found


def _along(walls: Floats, step_m: float) -> Floats:
    """Points (n, 2) along walls (k, 4), at most `step_m` apart, both ends with them."""
    pieces = []
    for wall in walls:
        count = max(2, math.ceil(math.dist(wall[:2], wall[2:]) / step_m) + 1)
        pieces.append(np.linspace(wall[:2], wall[2:], count))
    return np.concatenate(pieces)
