"""Occupancy maps that lasers build: counts of hits and passes in the cells of a plane.

A cell is occupied where beams ended in it in a share of the scans that covered it ([thrun2005], 9.2, with counts in
place of log odds: scans of several robots are merged by addition). Of an occupied cell the mean of the points that were
hit is kept, so that clearances are more exact than the cells are.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from typing import TYPE_CHECKING

import numpy as np

from muster.motion.grid import Bools, Floats, Grid, Indices
from muster.perception.counted_map import CountedMap, Counts, are_occupied
from muster.perception.laser import Scanner

if TYPE_CHECKING:
    from scipy.spatial import KDTree

_INSIDE = 1e-6
"""Metres behind the point that is hit at which its cell is looked up: what is hit lies behind the face."""


@dataclass(frozen=True, eq=False)
class Scan:
    """One scan.

    Parameters
    ----------
    pose : tuple of float
        Where the scanner takes itself to be: x, y, heading in the map frame.
    ranges : ndarray, shape (n,)
        Of its beams, metres; inf where a beam met nothing.
    hits : ndarray of bool, shape (n,)
        Which beams met an obstacle; others that end met something that moves, or that is no thing.
    """

    pose: tuple[float, float, float]
    ranges: Floats
    hits: Bools

    @classmethod
    def of(cls, pose: tuple[float, float, float], ranges: Floats) -> Scan:
        """Return a scan all of whose beams that end met obstacles."""
        return cls(pose, ranges, np.isfinite(ranges))


@dataclass(eq=False)
class OccupancyMap(CountedMap):
    """What lasers have measured of the cells of a frame. See `CountedMap` for its attributes.

    Parameters
    ----------
    frame : Grid
        Shape, resolution and origin of the cells; which of them are blocked there does not count.
    clearance_m : float
        The greatest clearance of interest.
    fills_cells : bool
        Whether obstacles are known to fill cells of this frame, as those of an image do.

    Clearances are in metres; where obstacles fill cells, they are between the squares of both.
    """

    frame: Grid
    clearance_m: float
    fills_cells: bool = False
    _sums: Floats = field(init=False)

    def __post_init__(self) -> None:
        self._make_empty(self.frame.shape)
        self._sums = np.zeros((*self.frame.shape, 2))

    def see(self, scan: Scan, scanner: Scanner, near_m: float = 0.0, *, passes: bool = True) -> tuple[Indices, bool]:
        """Enter a scan; cells that it sees within `near_m` count as near. Without `passes` only its hits count.

        Returns
        -------
        the cells (n, 2), rows and columns, that it found to be occupied and were not; and whether the map of obstacles
        changed at all.
        """
        freed = passes and self._pass(scan, scanner, near_m)
        if freed:
            self.clearances[:] = np.inf
            self._keep_off(np.argwhere(self.occupied))
        fresh = self.hit(*_hit_points(scan, scanner))
        return fresh, freed or len(fresh) > 0

    def hit(self, points: Floats, inner: Floats) -> Indices:
        """Enter points (n, 2) of obstacles, whose cells are looked up a little way on; return newly occupied cells."""
        columns, rows = np.floor(self.frame.to_grid(inner)).astype(np.int64).T
        height, width = self.frame.shape
        within = (rows >= 0) & (rows < height) & (columns >= 0) & (columns < width)
        rows, columns = rows[within], columns[within]
        np.add.at(self.hits, (rows, columns), 1)
        np.add.at(self._sums, (rows, columns), points[within])
        touched = np.column_stack(np.divmod(np.unique(rows * width + columns), width))
        now = are_occupied(self.hits[tuple(touched.T)], self.passes[tuple(touched.T)])
        fresh: Indices = touched[now & ~self.occupied[tuple(touched.T)]]
        self.occupied[tuple(fresh.T)] = True
        self._keep_off(fresh)
        return fresh

    def count_anew(self, hits: Counts, passes: Counts) -> tuple[Indices, bool]:
        """Take over hits and passes that were counted elsewhere, of obstacles that fill cells.

        Returns
        -------
        as `see`.
        """
        now = are_occupied(hits, passes)
        fresh: Indices = np.argwhere(now & ~self.occupied)
        freed = bool((self.occupied & ~now).any())
        self.hits, self.passes, self.occupied = hits, passes, now
        at = tuple(np.argwhere(now).T)
        self._sums[at] = self.centres(np.argwhere(now)) * hits[at][:, None]
        if freed:
            self.clearances[:] = np.inf
        self._keep_off(np.argwhere(now) if freed else fresh)
        return fresh, freed or len(fresh) > 0

    def recount(self, cells: Indices, hits: Counts, passes: Counts, offsets: Floats) -> tuple[Indices, bool]:
        """Take over, for cells (n, 2), hits and passes that were counted elsewhere, and the places of what was hit.

        Parameters
        ----------
        offsets : ndarray, shape (n, 2)
            How far the mean points hit are off the centres of the cells, in cells, row and column.

        Returns
        -------
        as `see`.
        """
        at, now = tuple(cells.T), are_occupied(hits, passes)
        fresh: Indices = cells[now & ~self.occupied[at]]
        freed = cells[self.occupied[at] & ~now]
        self.hits[at], self.passes[at], self.occupied[at] = hits, passes, now
        self._sums[at] = self.frame.to_map((cells + 0.5 + offsets)[:, ::-1]) * hits[:, None]
        if len(freed):
            reach = math.ceil(self.clearance_m / self.frame.resolution_m)
            self.clearances[_around(freed, reach)] = np.inf
            near = _around(freed, 2 * reach)
            self._keep_off(np.argwhere(self.occupied[near]) + np.array([near[0].start, near[1].start]))
        self._keep_off(cells[now])
        return fresh, len(freed) + len(fresh) > 0

    def clear(self) -> None:
        """Forget all that was seen."""
        self._make_empty(self.frame.shape)

    def note_free(self, cells: Bools) -> None:
        """Count cells that were not seen as passed once: others have found them to be free."""
        self.passes[cells & (self.passes == 0) & (self.hits == 0)] = 1

    def note_near(self, place: Floats, near_m: float) -> None:
        """Count the known cells within a distance of a place (2,) as seen from near."""
        cells = near_m / self.frame.resolution_m
        column, row = self.frame.to_grid(place[None])[0]
        rows, columns = (np.arange(n) + 0.5 for n in self.frame.shape)
        within = np.hypot(rows[:, None] - row, columns - column) <= cells
        self.near |= within & self.known

    def points_in(self, cells: Indices) -> Floats:
        """Return the mean points hit, (n, 2) metres in the map frame, in cells (n, 2) of rows and columns.

        Where obstacles fill cells: their centres.
        """
        if self.fills_cells:
            return self.centres(cells)
        rows, columns = cells.T
        means: Floats = self._sums[rows, columns] / self.hits[rows, columns, None]
        return means

    def offsets_in(self, cells: Indices) -> Floats:
        """Return how far the mean points hit are from the centres of cells (n, 2), in cells, row and column."""
        off: Floats = self.frame.to_grid(self.points_in(cells).reshape(-1, 2))[:, ::-1] - cells - 0.5
        return off

    def put(self, cells: Indices, offsets: Floats, hits: Counts) -> None:
        """Let cells (n, 2) be occupied, whose mean points hit are off their centres so far."""
        at = tuple(cells.T)
        self.hits[at] = hits
        self._sums[at] = self.frame.to_map((cells + 0.5 + offsets)[:, ::-1]) * hits[:, None]
        self.occupied[at] = True
        self._keep_off(cells)

    def nearest_m(self, place: Floats) -> float:
        """Return the distance from a place (2,) to the nearest obstacle seen, metres; inf beyond `clearance_m`."""
        cell_m = self.frame.resolution_m
        reach = math.ceil(self.clearance_m / cell_m) + 1
        column, row = np.floor(self.frame.to_grid(place[None])[0]).astype(np.int64)
        top, left = max(0, row - reach), max(0, column - reach)
        near = np.argwhere(self.occupied[top : max(0, row + reach + 1), left : max(0, column + reach + 1)])
        if not len(near):
            return math.inf
        apart = self.frame.to_grid(self.points_in(near + np.array([top, left]))) - self.frame.to_grid(place[None])
        return float(np.linalg.norm(self._gaps(apart, 0.5), axis=1).min() * cell_m)

    def tree(self) -> KDTree:
        """Return the obstacles' points (n, 2) as a tree that finds the nearest of them."""
        from scipy.spatial import KDTree

        return KDTree(self.points_in(np.argwhere(self.occupied)).reshape(-1, 2))

    def from_line_m(self, points: Floats, cells: Indices) -> Floats:
        """Return the distances (n,) of the obstacles in cells (n, 2) from the line through points (k, 2), metres."""
        import shapely

        line = shapely.LineString(self.frame.to_grid(points if len(points) > 1 else np.repeat(points, 2, axis=0)))
        if self.fills_cells:
            rows, columns = cells.T
            obstacles = shapely.box(columns, rows, columns + 1, rows + 1)
        else:
            obstacles = shapely.points(self.frame.to_grid(self.points_in(cells)))
        metres: Floats = shapely.distance(obstacles, line) * self.frame.resolution_m
        return metres

    def centres(self, cells: Indices) -> Floats:
        """Return the centres (n, 2) of cells (n, 2) of rows and columns, metres in the map frame."""
        return self.frame.to_map(cells[:, ::-1].astype(np.float64) + 0.5)

    def _keep_off(self, cells: Indices) -> None:
        """Take the points hit in these cells into the clearances of the cells around them."""
        if not len(cells):
            return
        reach = math.ceil(self.clearance_m / self.frame.resolution_m)
        height, width = self.frame.shape
        steps = np.arange(-reach, reach + 1)
        up, across = (grid.ravel() for grid in np.meshgrid(steps, steps, indexing="ij"))
        in_cells = self.frame.to_grid(self.points_in(cells))
        for part in np.array_split(np.arange(len(cells)), 1 + len(cells) // 1000):
            rows, columns = cells[part, :1] + up, cells[part, 1:] + across
            apart = np.stack([columns + 0.5 - in_cells[part, :1], rows + 0.5 - in_cells[part, 1:]], axis=-1)
            metres = self.frame.resolution_m * np.linalg.norm(self._gaps(apart, 1.0), axis=-1)
            within = (rows >= 0) & (rows < height) & (columns >= 0) & (columns < width) & (metres <= self.clearance_m)
            np.minimum.at(self.clearances, (rows[within], columns[within]), metres[within].astype(np.float32))

    def _gaps(self, apart: Floats, wide: float) -> Floats:
        """Return what lies between along each axis (..., 2), in cells: between squares, where obstacles fill cells."""
        return np.maximum(np.abs(apart) - wide, 0.0) if self.fills_cells else apart

    def _pass(self, scan: Scan, scanner: Scanner, near_m: float) -> bool:
        """Count the cells that beams passed; return whether one is occupied no more.

        The centre of such a cell is nearer than both beams beside it reached, by a cell at least.
        """
        cell_m, (height, width) = self.frame.resolution_m, self.frame.shape
        reached = np.where(np.isfinite(scan.ranges), scan.ranges, scanner.reach_m) / cell_m
        column, row = self.frame.to_grid(np.array([scan.pose[:2]]))[0]
        turned = scan.pose[2] - self.frame.origin[2]
        across, up = reached * np.cos(turned + scanner.bearings), reached * np.sin(turned + scanner.bearings)
        rows = np.arange(*_between(row, up, height))
        columns = np.arange(*_between(column, across, width))
        if not len(rows) or not len(columns):
            return False
        east, north = (columns + 0.5 - column).astype(np.float32), (rows + 0.5 - row).astype(np.float32)[:, None]
        bearing = np.remainder(np.arctan2(north, east) + np.float32(math.pi - turned), np.float32(2 * math.pi))
        beam = (bearing - np.float32(math.pi + scanner.bearings[0])) / np.float32(scanner.step_rad)
        first = np.floor(beam).astype(np.int32)
        least = np.concatenate([[0.0], np.minimum(reached[:-1], reached[1:]), [0.0]]).astype(np.float32)
        away = np.hypot(east, north)
        passed = away + 1.0 <= least[np.clip(first + 1, 0, len(least) - 1)]
        passed |= np.maximum(np.abs(east), np.abs(north)) <= 0.5  # it stands there
        part = np.s_[rows[0] : rows[-1] + 1, columns[0] : columns[-1] + 1]
        self.passes[part] += passed
        self.near[part] |= passed & (away <= near_m / cell_m)
        freed = self.occupied[part] & passed
        freed[freed] = ~are_occupied(self.hits[part][freed], self.passes[part][freed])
        self.occupied[part] &= ~freed
        return bool(freed.any())


def _around(cells: Indices, reach: int) -> tuple[slice, slice]:
    """Return the rows and columns of the rectangle that holds cells (n, 2) and all within so many cells of them."""
    low, high = np.maximum(cells.min(axis=0) - reach, 0), cells.max(axis=0) + reach + 1
    return slice(int(low[0]), int(high[0])), slice(int(low[1]), int(high[1]))


def _between(place: float, ends: Floats, most: int) -> tuple[int, int]:
    """The first and the last but one of the rows or columns between a place and the ends of beams."""
    first, last = math.floor(place + min(0.0, ends.min())), math.floor(place + max(0.0, ends.max()))
    return max(0, first), min(most, last + 1)


def _hit_points(scan: Scan, scanner: Scanner) -> tuple[Floats, Floats]:
    """Return the points of obstacles that beams hit, (n, 2) in the map frame, and the same a little way on."""
    angles = scan.pose[2] + scanner.bearings[scan.hits]
    ahead = np.column_stack([np.cos(angles), np.sin(angles)])
    points = np.array(scan.pose[:2]) + scan.ranges[scan.hits, None] * ahead
    return points, points + _INSIDE * ahead
