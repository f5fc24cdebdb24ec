"""Exact lines of sight among the free cells of a grid map, for the judge's shortest paths.

All lengths here are in cells: x grows with the column, y with the row. Free cells are closed squares, and between two
blocked cells that touch at a corner nothing passes. A shortest way turns only at corners of the lattice with one
blocked cell around them. What such a corner sees is found for all of them at once, row by row upwards: what a point
sees of a row is some cones, and each is cut at the free runs of the next row. A cone without width is dropped: along
it lie corners that see each other.
"""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from muster.motion.free_space import GridSpace
from muster.motion.grid import Bools, Floats, Indices
from muster.motion.maps.free_points import free as is_free
from muster.motion.maps.free_points import slack_m

_CLOSE = 1e-6  # of a cell: less than cones between lattice points can be apart, more than rounding
_ROUNDED = 1e-9  # of a cell: what is this near to a lattice line is on it


class Cells:
    """Sight among the free cells of a grid.

    `corners` (c, 2) are where ways may turn; `unit_m` is the length of 1.
    """

    def __init__(self, space: GridSpace) -> None:
        grid = space.grid
        self.unit_m = grid.resolution_m
        self._space, self._grid = space, grid
        self._up, self._down = _Rows(grid.blocked), _Rows(grid.blocked[::-1])
        self.corners, self._blocked_side = _corners(grid.blocked)
        rows, columns = grid.shape
        self._numbers = _Numbers(self.corners, (rows + 1, columns + 1))
        turned = np.lexsort((self.corners[:, 0], -self.corners[:, 1]))
        self._turned = turned, _Numbers(self._flipped(self.corners[turned]), (rows + 1, columns + 1))

    def settled(self, points: Floats) -> tuple[Floats, Bools]:
        """Points (n, 2) of the map frame in cells, and whether each is free."""
        places = self._grid.to_grid(points)
        slack = slack_m(self._space, points) / self.unit_m
        places = _on_lattice(places, max(_ROUNDED, slack))
        return places, self._stands(places) & is_free(self._space, points)

    def between_corners(self) -> Indices:
        """Pairs (k, 2) of corners that see each other, where a way may turn at both."""
        toward = self._blocked_side
        # Straight away from its blocked cell no way leaves a corner: of the upper half it needs only one side.
        least = np.where((toward[:, 1] < 0) & (toward[:, 0] > 0), 0.0, -np.inf)
        most = np.where((toward[:, 1] < 0) & (toward[:, 0] < 0), 0.0, np.inf)
        pairs = self._up.seen(self._numbers, self.corners, least, most)
        level = self._flipped(self.corners)
        below = self._down.beside(self._turned[1], level)
        below[:, 1] = self._turned[0][below[:, 1]]
        pairs = np.concatenate([pairs, below])
        steps = self.corners[pairs[:, 0]] - self.corners[pairs[:, 1]]
        return np.asarray(pairs[(pairs[:, 0] != pairs[:, 1]) & self._taut(pairs[:, 1], steps)])

    def from_places(self, places: Floats) -> Indices:
        """Pairs (k, 2) of a place, in cells, and a corner it sees, where a way may turn at the corner."""
        wide = np.full(len(places), np.inf)
        above = self._up.seen(self._numbers, places, -wide, wide)
        below = self._down.seen(self._turned[1], self._flipped(places), -wide, wide)
        below[:, 1] = self._turned[0][below[:, 1]]
        pairs = np.concatenate([above, below])
        return pairs[self._taut(pairs[:, 1], places[pairs[:, 0]] - self.corners[pairs[:, 1]])]

    def clear(self, start: Floats, end: Floats) -> bool:
        """Whether the straight line between two free places, in cells, is free."""
        return self._up.clear(start, end) or (start[1] == end[1] and self._down.clear(*self._flipped([start, end])))

    def _taut(self, corners: Indices, steps: Floats) -> Bools:
        """Whether a way that leaves a corner along a step can have turned there, around its blocked cell."""
        along = steps * self._blocked_side[corners]
        return np.asarray((along >= -_CLOSE).any(axis=1))

    def _stands(self, places: Floats) -> Bools:
        return (self._up.run_at(places) >= 0) | (self._down.run_at(self._flipped(places)) >= 0)

    def _flipped(self, places: npt.ArrayLike) -> Floats:
        return np.array([0.0, self._grid.shape[0]]) + np.asarray(places, dtype=np.float64) * [1, -1]


class _Rows:
    """The runs of free cells, row by row. A run is `left <= x <= right` in its `row`; they are in reading order."""

    def __init__(self, blocked: Bools) -> None:
        self.height, self.width = blocked.shape
        steps = np.diff(np.pad(~blocked, ((0, 0), (1, 1))).astype(np.int8), axis=1)
        self.row, left = np.nonzero(steps == 1)
        self.left, self.right = left.astype(np.float64), np.nonzero(steps == -1)[1].astype(np.float64)
        self._begun = np.cumsum(steps == 1, dtype=np.int64)
        self._ended = np.cumsum(steps == -1, dtype=np.int64)

    def run_at(self, places: Floats) -> Indices:
        """The run (n,) that each place is in, or -1; of a place on a line the row above it counts."""
        x, row = places[:, 0], np.floor(places[:, 1])
        within = (row >= 0) & (row < self.height) & (x >= 0) & (x <= self.width)
        found = self._first(np.where(within, row, 0), np.where(within, x, 0) - 2 * _CLOSE)
        held = np.minimum(found, max(len(self.row) - 1, 0))
        if not len(self.row):
            return np.full(len(places), -1)
        within &= (found < len(self.row)) & (self.row[held] == row) & (self.left[held] <= x) & (x <= self.right[held])
        return np.where(within, held, -1)

    def _first(self, row: Floats, x: Floats) -> Indices:
        """The first run that ends to the right of x by more than `_CLOSE`, in the row or else in a later one."""
        column = np.clip(np.floor(x + _CLOSE), 0, self.width).astype(np.int64)
        return np.asarray(self._ended[row.astype(np.int64) * (self.width + 1) + column])

    def _beyond(self, row: Floats, x: Floats) -> Indices:
        """The first run that does not begin to the left of x by more than `_CLOSE`."""
        column = np.clip(np.ceil(x - _CLOSE) - 1, 0, self.width).astype(np.int64)
        return np.asarray(self._begun[row.astype(np.int64) * (self.width + 1) + column])

    def beside(self, numbers: _Numbers, places: Floats) -> Indices:
        """Pairs (k, 2) of a place on a line and a corner it sees along it, over the run above it."""
        run = self.run_at(places)
        level = (run >= 0) & (places[:, 1] == np.floor(places[:, 1]))
        return numbers.pairs(np.flatnonzero(level), places[level, 1], self.left[run[level]], self.right[run[level]])

    def seen(self, numbers: _Numbers, places: Floats, least: Floats, most: Floats) -> Indices:
        """Pairs (k, 2) of a place and a corner that it sees, level or above it, dx / dy between `least` and `most`.

        What lies level is seen on both sides.
        """
        found = [self.beside(numbers, places)]
        run = self.run_at(places)
        who = np.flatnonzero(run >= 0)
        run, least, most = run[who], least[who], most[who]
        while len(who):
            x, y = places[who].T
            top = self.row[run] + 1.0
            for height in (top - y, top - 1 - y):  # a ray stays in a run that holds both its ends
                ahead = height > 0
                least[ahead] = np.maximum(least[ahead], (self.left[run[ahead]] - x[ahead]) / height[ahead])
                most[ahead] = np.minimum(most[ahead], (self.right[run[ahead]] - x[ahead]) / height[ahead])
            wide = (most - least) * (top - y) > _CLOSE
            who, least, most, x, y, top = who[wide], least[wide], most[wide], x[wide], y[wide], top[wide]
            low, high = x + least * (top - y), x + most * (top - y)
            found.append(numbers.pairs(who, top, low, high))
            on = top < self.height
            who, least, most, low, high, top = who[on], least[on], most[on], low[on], high[on], top[on]
            first = self._first(top, low)
            each, run = _ranges(first, self._beyond(top, high))
            who, least, most = who[each], least[each], most[each]
        return np.concatenate(found)

    def clear(self, start: Floats, end: Floats) -> bool:
        """Whether a line is free; of a level line on a lattice line only the row above counts."""
        (x0, y0), (x1, y1) = (start, end) if start[1] <= end[1] else (end, start)
        rows = np.arange(np.floor(y0), max(np.ceil(y1), np.floor(y0) + 1))
        if rows[-1] >= self.height:
            return False
        slope = (x1 - x0) / (y1 - y0) if y1 > y0 else 0.0
        at = x0 + slope * (np.clip([rows, rows + 1], y0, y1) - y0) if y1 > y0 else np.array([[x0], [x1]])
        low, high = at.min(axis=0), at.max(axis=0)
        run = self._first(rows, high - 2 * _CLOSE)
        if (run >= len(self.row)).any() or (self.row[run] != rows).any():
            return False
        left, right = self.left[run], self.right[run]
        shared = np.minimum(right[:-1], right[1:]) - np.maximum(left[:-1], left[1:])
        return bool((left <= low + _CLOSE).all() and (high - _CLOSE <= right).all() and (shared > 0).all())


class _Numbers:
    """The numbers of corners on a line between two x. Corners are in reading order; `size` is (lines, columns)."""

    def __init__(self, corners: Floats, size: tuple[int, int]) -> None:
        marks = np.zeros(size, dtype=np.int64)
        marks[corners[:, 1].astype(np.int64), corners[:, 0].astype(np.int64)] = 1
        self._columns = size[1]
        self._before = np.concatenate([[0], np.cumsum(marks)])

    def pairs(self, who: Indices, line: Floats, low: Floats, high: Floats) -> Indices:
        """Pairs (k, 2) of each of `who` and a corner on its line from `low` to `high`."""
        first = np.clip(np.ceil(low - _CLOSE), 0, self._columns).astype(np.int64)
        last = np.clip(np.floor(high + _CLOSE) + 1, 0, self._columns).astype(np.int64)
        lines = line.astype(np.int64) * self._columns
        each, corner = _ranges(self._before[lines + first], self._before[lines + np.maximum(first, last)])
        return np.stack([who[each], corner], axis=1)


def _ranges(first: Indices, last: Indices) -> tuple[Indices, Indices]:
    """All numbers of the ranges `first[k]` to before `last[k]`: for each its k, and itself."""
    counts = np.maximum(last - first, 0)
    each = np.repeat(np.arange(len(counts)), counts)
    return each, np.arange(len(each)) - np.repeat(np.cumsum(counts) - counts, counts) + first[each]


def _corners(blocked: Bools) -> tuple[Floats, Floats]:
    """The lattice points with one blocked cell around them, (c, 2) of x and y; and where that is: each -1 or 1."""
    fenced = np.pad(blocked, 1, constant_values=True)
    around = {(dx, dy): _quarter(fenced, dx, dy) for dx in (-1, 1) for dy in (-1, 1)}
    y, x = np.nonzero(np.sum([*around.values()], axis=0) == 1)
    sides = sum(quarter[y, x, None] * np.array(side, dtype=np.float64) for side, quarter in around.items())
    return np.stack([x, y], axis=1).astype(np.float64), np.asarray(sides, dtype=np.float64).reshape(-1, 2)


def _quarter(fenced: Bools, dx: int, dy: int) -> Bools:
    """Whether the cell on one side of each lattice point is blocked."""
    rows, columns = fenced.shape
    return fenced[(dy + 1) // 2 : rows - 1 + (dy + 1) // 2, (dx + 1) // 2 : columns - 1 + (dx + 1) // 2]


def _on_lattice(places: Floats, slack: float) -> Floats:
    nearest = np.round(places)
    return np.where(np.abs(places - nearest) <= slack, nearest, places)
