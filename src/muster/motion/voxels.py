"""Voxels: the air as cubes, the shortest ways through free ones, and what a scan all around tells of them."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from muster import core
from muster.motion.free_space import PrismSpace
from muster.motion.grid import Bools, Floats, Indices
from muster.motion.maps.raster import touched


@dataclass(frozen=True)
class VoxelFrame:
    """Cubes upright in the map frame.

    Parameters
    ----------
    shape : tuple of int
        Layers, rows, columns; layer 0 is the lowest, row 0 the southernmost.
    cell_m : float
        The side of a cube, metres.
    origin : tuple of float
        x, y, z of the outer corner of voxel (0, 0, 0), metres in the map frame.
    """

    shape: tuple[int, int, int]
    cell_m: float
    origin: tuple[float, float, float]

    @classmethod
    def over(cls, low: Floats, high: Floats, least_m: float, most: int) -> VoxelFrame:
        """Return cubes over a box (3,) to (3,), of a side of `least_m` at least, and about `most` of them at most."""
        span = np.maximum(high - low, least_m)
        cell_m = max(least_m, float(np.cbrt(span.prod() / most)))
        columns, rows, layers = np.ceil(span / cell_m - 1e-9).astype(int).tolist()
        return cls((layers, rows, columns), cell_m, (float(low[0]), float(low[1]), float(low[2])))

    def to_cells(self, points: Floats) -> Floats:
        """Return points (n, 3) of the map frame as x, y, z in voxels."""
        cells: Floats = (points - np.array(self.origin)) / self.cell_m
        return cells

    def to_map(self, cells: Floats) -> Floats:
        """Return the inverse of `to_cells`."""
        points: Floats = cells * self.cell_m + np.array(self.origin)
        return points

    def centres(self, voxels: Indices) -> Floats:
        """Return the centres (n, 3) of voxels (n, 3) of layer, row, column, metres in the map frame."""
        return self.to_map(voxels[:, ::-1].astype(np.float64) + 0.5)

    def voxels(self, points: Floats) -> tuple[Indices, Bools]:
        """Return the voxels (n, 3) in which points (n, 3) are, as layer, row, column, and which of them exist."""
        found = np.floor(self.to_cells(points)).astype(np.int64)[:, ::-1]
        within: Bools = np.asarray(((found >= 0) & (found < np.array(self.shape))).all(axis=1))
        return found, within

    def beyond(self, space: PrismSpace) -> Bools:
        """Return the voxels that reach out of a space, be it by a part; its lowest height does not count."""
        import shapely

        layers, rows, columns = self.shape
        x, y, z = self.origin

        def flat(points: Floats) -> Floats:
            cells: Floats = (points - np.array([x, y])) / self.cell_m
            return cells

        whole = shapely.box(0, 0, columns, rows)
        outside = touched(shapely.difference(whole, shapely.transform(space.region, flat)), (rows, columns))
        blocked = np.repeat(outside[None], layers, axis=0)
        for prism in space.prisms:
            first = 0 if prism.floor_m == -math.inf else max(0, math.floor((prism.floor_m - z) / self.cell_m))
            last = layers if prism.ceiling_m == math.inf else max(0, math.ceil((prism.ceiling_m - z) / self.cell_m))
            blocked[first:last] |= touched(shapely.transform(prism.polygon, flat), (rows, columns))
        return blocked


class VoxelWays:
    """The shortest ways through free voxels, in metres of the map frame.

    Parameters
    ----------
    frame : VoxelFrame
        Where the voxels are.
    blocked : ndarray of bool, shape (layers, rows, columns)
        Which are not free. What is above or below them is as the next of them.
    """

    def __init__(self, frame: VoxelFrame, blocked: Bools) -> None:
        self.frame, self.blocked = frame, blocked
        self._ways = core.VoxelWays(np.ascontiguousarray(blocked))

    def free(self, place: Floats) -> bool:
        """Return whether a place (3,) is in a free voxel."""
        return self._ways.free(self._cells(place))

    def sees(self, a: Floats, b: Floats) -> bool:
        """Return whether all voxels between two places (3,) are free."""
        return self._ways.sees(self._cells(a), self._cells(b))

    def part(self, place: Floats) -> int:
        """Return the number of the connected part of the free voxels that a place (3,) is in; 0: it is in none."""
        return self._ways.part(self._cells(place))

    def way(self, start: Floats, goal: Floats) -> Floats | None:
        """Return the points (k, 3) of the shortest way, its ends included; None: there is none."""
        found = self._ways.way(self._cells(start), self._cells(goal))
        if not len(found):
            return None
        points = self.frame.to_map(found)
        points[0], points[-1] = start, goal
        return points

    def _cells(self, place: Floats) -> tuple[float, float, float]:
        x, y, z = self.frame.to_cells(place).tolist()
        return x, y, z


def passed_voxels(frame: VoxelFrame, eye: Floats, heading: float, reached_m: Floats) -> Indices:
    """Return the voxels, as indices of the flat array, that a scan all around found to be free.

    Parameters
    ----------
    eye : ndarray, shape (3,)
        Where the scanner is, metres in the map frame.
    heading : float
        Of the first column of beams, radians.
    reached_m : ndarray, shape (rings, columns)
        How far beams reached, metres: rings from straight down to straight up, columns anticlockwise.
    """
    x, y, z = frame.to_cells(eye).tolist()
    return core.voxels_passed(frame.shape, (x, y, z), heading, np.ascontiguousarray(reached_m / frame.cell_m))


def lower_clearances(frame: VoxelFrame, clearances: npt.NDArray[np.float32], points: Floats, reach_m: float) -> None:
    """Lower the distances from voxels' centres to the nearest of points (n, 3), in voxels, within some metres."""
    core.lower_clearances(clearances, np.ascontiguousarray(frame.to_cells(points)), reach_m / frame.cell_m)
