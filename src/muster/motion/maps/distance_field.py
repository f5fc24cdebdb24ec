"""The field of distances: for every cell of a grid how far the nearest obstacle is.

A distance transform [felzenszwalb2012], to whole squares.
"""

from __future__ import annotations

import numpy as np

from muster.core import squared_distances
from muster.motion.grid import Floats, Grid


def distance_field(grid: Grid) -> Floats:
    """(rows, columns): metres from each cell's centre to the nearest blocked square; 0 in blocked cells.

    What lies outside the grid is blocked.
    """
    fenced = np.pad(grid.blocked, 1, constant_values=True)
    gaps = np.empty(fenced.shape)
    squared_distances(fenced, 0.5, gaps)
    inside = gaps[1:-1, 1:-1]
    return np.sqrt(inside, out=inside) * grid.resolution_m
