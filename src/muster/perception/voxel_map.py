"""The air as lidars have measured it: counts of hits and passes in voxels, as `occupancy_map` has them in the plane."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import TYPE_CHECKING

import numpy as np
import numpy.typing as npt

from muster.motion.grid import Bools, Floats, Indices
from muster.motion.voxels import VoxelFrame, lower_clearances, passed_voxels
from muster.perception.counted_map import CountedMap, Counts, are_occupied
from muster.perception.sphere_scanner import SphereScanner

if TYPE_CHECKING:
    from scipy.spatial import KDTree

_INSIDE = 1e-6
"""Metres behind the point that is hit at which its voxel is looked up."""
_BELOW_CELLS = 2.0
"""Voxels by which beams that meet the ground count as longer: there is nothing below."""


@dataclass(frozen=True, eq=False)
class SpaceScan:
    """One scan all around.

    Parameters
    ----------
    eye : ndarray, shape (3,)
        Where the scanner takes itself to be, metres in the map frame.
    heading : float
        Radians.
    ranges : ndarray, shape (rings, columns)
        Metres; inf where a beam met nothing.
    hits : ndarray of bool, shape (rings, columns)
        Which beams met an obstacle; others that end met something that moves, or the ground.
    on_ground : ndarray of bool, shape (rings, columns)
        Which beams met the ground.
    """

    eye: Floats
    heading: float
    ranges: Floats
    hits: Bools
    on_ground: Bools

    def points(self, scanner: SphereScanner) -> tuple[Floats, Floats]:
        """Return the points (n, 3) of obstacles that beams hit, and the same a little way on."""
        ahead = scanner.directions(self.heading)[self.hits]
        points = self.eye + self.ranges[self.hits][:, None] * ahead
        return points, points + _INSIDE * ahead


@dataclass(eq=False)
class VoxelMap(CountedMap):
    """What lidars have measured of the voxels of a frame. See `CountedMap` for its attributes.

    Parameters
    ----------
    frame : VoxelFrame
        The voxels.
    clearance_m : float
        The greatest clearance of interest.

    Clearances are in voxels. Which voxels were seen from near counts on the ground only.
    """

    frame: VoxelFrame
    clearance_m: float
    _sums: npt.NDArray[np.float32] = field(init=False)
    _tree: KDTree | None = field(default=None, init=False)

    def __post_init__(self) -> None:
        self._make_empty(self.frame.shape)
        self._sums = np.zeros((*self.frame.shape, 3), dtype=np.float32)

    def see(self, scan: SpaceScan, scanner: SphereScanner) -> tuple[Floats, bool]:
        """Enter a scan; return the points (n, 3) of voxels that are newly occupied, and whether obstacles changed."""
        freed = self._pass(scan, scanner)
        points, inner = scan.points(scanner)
        voxels, within = self.frame.voxels(inner)
        places = tuple(voxels[within].T)
        np.add.at(self.hits, places, 1)
        offset = points[within] - self.frame.centres(voxels[within])
        np.add.at(self._sums, places, offset.astype(np.float32))
        touched = np.unique(np.ravel_multi_index(places, self.frame.shape))
        now = are_occupied(self.hits.ravel()[touched], self.passes.ravel()[touched])
        fresh = touched[now & ~self.occupied.ravel()[touched]]
        self.occupied.reshape(-1)[fresh] = True
        if freed:
            self.clearances[:] = np.inf
            self._keep_off(np.argwhere(self.occupied))
        cells = np.column_stack(np.unravel_index(fresh, self.frame.shape))
        self._keep_off(cells)
        changed = freed or len(fresh) > 0
        if changed:
            self._tree = None
        return self.points_in(cells), changed

    def points_in(self, voxels: Indices) -> Floats:
        """Return the mean points hit (n, 3), metres in the map frame, in voxels (n, 3) of layer, row, column."""
        places = tuple(voxels.T)
        means: Floats = self._sums[places] / np.maximum(self.hits[places], 1)[:, None]
        return self.frame.centres(voxels) + means

    def offsets_in(self, cells: Indices) -> Floats:
        """Return how far the mean points hit are from the centres of voxels (n, 3), in voxels: layer, row, column."""
        off: Floats = (self.points_in(cells) - self.frame.centres(cells))[:, ::-1] / self.frame.cell_m
        return off

    def put(self, cells: Indices, offsets: Floats, hits: Counts) -> None:
        """Let voxels (n, 3) be occupied, whose mean points hit are off their centres so far."""
        at = tuple(cells.T)
        self.hits[at] = hits
        self._sums[at] = offsets[:, ::-1] * self.frame.cell_m * hits[:, None]
        self.occupied[at] = True
        self._tree = None
        self._keep_off(cells)

    def tree(self) -> KDTree:
        """Return the obstacles' points (n, 3) as a tree that finds the nearest of them."""
        from scipy.spatial import KDTree

        if self._tree is None:
            self._tree = KDTree(self.points_in(np.argwhere(self.occupied)).reshape(-1, 3))
        return self._tree

    def _keep_off(self, voxels: Indices) -> None:
        if len(voxels):
            lower_clearances(self.frame, self.clearances, self.points_in(voxels), self.clearance_m)

    def _pass(self, scan: SpaceScan, scanner: SphereScanner) -> bool:
        """Count the voxels that beams passed; return whether one is occupied no more."""
        reached = np.where(np.isfinite(scan.ranges), scan.ranges, scanner.reach_m)
        reached[scan.on_ground] += _BELOW_CELLS * self.frame.cell_m
        passed = passed_voxels(self.frame, scan.eye, scan.heading, reached)
        self.passes.reshape(-1)[passed] += 1
        held = passed[self.occupied.ravel()[passed]]
        freed = held[~are_occupied(self.hits.ravel()[held], self.passes.ravel()[held])]
        self.occupied.reshape(-1)[freed] = False
        return len(freed) > 0
