"""The points of a roadmap: where robots may stand so that they are out of each other's way.

Three kinds of room, told apart by how wide the free space is for the centre of the widest robot, `apart` being the
distance at which two such robots do not touch:

- narrower than `apart` (a passage for one): points along the middle, the innermost first: the sill of a door, the end
  of a dead end;
- between `apart` and twice that: two lanes, as far from the walls as they can be;
- wider: a square lattice, offset to where the most of its points are free.

What is left and at least `apart` from all of them, and as far from the lattice as its own points are from each other,
as corners of rooms, is filled with further points.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable
from dataclasses import dataclass

import numpy as np

from muster.mission.values.arrays import Bools, Floats

_OFFSETS = 8
"""Offsets of the lattice that are tried, along each axis."""
_ON_LANE = 0.75
"""Cells by which a point may be off the middle of a passage."""
_SLACK = 1e-6
_HALF_CELL = math.sqrt(0.5)
"""From the middle of a cell to its corner."""


@dataclass(frozen=True, eq=False)
class Room:
    """Free cells (rows, columns), how deep in free space each is, and how wide the room is around it; in cells.

    Parameters
    ----------
    depth
        from a cell's centre to the nearest blocked square.
    narrow, double
        where the room is for one, and for two; elsewhere it is wider.
    """

    free: Bools
    depth: Floats
    narrow: Bools
    double: Bools

    @classmethod
    def of(cls, free: Bools, depth: Floats, apart: float) -> Room:
        """`apart` in cells."""
        wide = free & _spread(depth >= apart, apart)
        for_two = free & _spread(depth >= (apart + 1) / 2 - _SLACK, apart / 2)
        return cls(free, depth, free & ~for_two & ~wide, for_two & ~wide)


def lane_points(
    room: Room, apart: float, pitch: float, places: Floats, to_middle: Callable[[Floats], Floats]
) -> Floats:
    """Points (n, 2), as (column, row) in cells, each `apart` from the others and at the middle of a cell or a lattice.

    Parameters
    ----------
    apart, pitch
        cells between points in narrow places, and of the lattice.
    places
        (k, 2) in cells: points are put there where they are on a lane or near to a point of the lattice.
    to_middle
        moves points of passages for one from the middle of their cells to the middle between the walls.
    """
    taken = Taken(room.free.shape, apart)
    on_lanes = [taken.take(place) for place in places if _is_on_lane(room, place) and not taken.at(place)]
    ridge = taken.pack(_in_order(_ridge(room), _away_from(room.free & ~room.narrow)))
    lanes = to_middle(np.reshape(ridge, (-1, 2)))
    pairs = taken.pack(_in_order(_two_lanes(room, apart), _away_from(room.free & ~room.narrow & ~room.double)))
    lattice = _lattice(room, taken, pitch, places)
    taken.take_all(lattice, pitch)
    corners = taken.pack(_in_order(room.free & ~taken.cells, room.depth))
    return np.concatenate([np.reshape(some, (-1, 2)) for some in (on_lanes, lanes, pairs, lattice, corners)])


class Taken:
    """The cells that are too near to points that were chosen."""

    def __init__(self, shape: tuple[int, ...], apart: float) -> None:
        self._pad = int(apart) + 2
        self._apart = apart
        self._columns = shape[1]
        self._padded = np.zeros((shape[0] + 2 * self._pad, shape[1] + 2 * self._pad), dtype=np.bool_)
        self._offsets = np.arange(-self._pad, self._pad + 1)

    @property
    def cells(self) -> Bools:
        """(rows, columns): whether a cell's centre is nearer than `apart` to a point."""
        return self._padded[self._pad : -self._pad, self._pad : -self._pad]

    def at(self, point: Floats) -> bool:
        return bool(self.cells[int(point[1]), int(point[0])])

    def take(self, point: Floats) -> Floats:
        """Choose a point; it is returned."""
        column, row = int(point[0]), int(point[1])
        across = column + self._offsets + 0.5 - point[0]
        up = row + self._offsets + 0.5 - point[1]
        near = up[:, np.newaxis] ** 2 + across**2 < (self._apart - _SLACK) ** 2
        self._padded[row : row + len(up), column : column + len(across)] |= near
        return point

    def take_all(self, points: Floats, apart: float) -> None:
        """Choose many points so far apart; with the cells that may be too near, as points may be anywhere in theirs."""
        there = np.zeros(self.cells.shape, dtype=np.bool_)
        column, row = points.astype(np.int64).T
        there[row, column] = True
        self.cells[_away_from(there) < apart + _HALF_CELL] = True

    def pack(self, cells: Iterable[int]) -> list[Floats]:
        """Choose the middle of each cell (row * columns + column), in order, that is not taken yet."""
        chosen, taken = [], self.cells
        for cell in cells:
            row, column = divmod(cell, self._columns)
            if not taken[row, column]:
                chosen.append(self.take(np.array([column + 0.5, row + 0.5])))
        return chosen


def _spread(cells: Bools, reach: float) -> Bools:
    """The cells in a square about these, `reach` cells to each side."""
    from scipy.ndimage import maximum_filter

    return np.asarray(maximum_filter(cells, size=2 * int(np.ceil(reach)) + 1))


def _ridge(room: Room) -> Bools:
    """The middle of passages for one: cells about as deep as the deepest within two cells."""
    from scipy.ndimage import maximum_filter

    return np.asarray(room.narrow & (room.depth > maximum_filter(room.depth, size=5) - _ON_LANE))


def _two_lanes(room: Room, apart: float) -> Bools:
    """Cells of passages for two from which the other lane is `apart`."""
    from scipy.ndimage import maximum_filter

    half_width = maximum_filter(room.depth, size=2 * int(np.ceil(apart / 2)) + 1)
    return np.asarray(room.double & (np.abs(room.depth - (half_width - apart / 2)) <= _ON_LANE))


def _is_on_lane(room: Room, place: Floats) -> bool:
    column, row = int(place[0]), int(place[1])
    around = room.depth[max(0, row - 2) : row + 3, max(0, column - 2) : column + 3]
    return bool(room.narrow[row, column] and room.depth[row, column] > around.max() - 2 * _ON_LANE)


def _in_order(cells: Bools, key: Floats) -> list[int]:
    """Cells as row * columns + column, those with the greatest key in whole cells first, then row by row."""
    found = np.flatnonzero(cells)
    order = np.argsort(-np.round(key.ravel()[found]), kind="stable")
    ordered: list[int] = found[order].tolist()
    return ordered


def _away_from(cells: Bools) -> Floats:
    """How far each cell is from the nearest of these, in cells; inf where there are none."""
    from scipy.ndimage import distance_transform_edt

    if not cells.any():
        return np.full(cells.shape, np.inf)
    return np.asarray(distance_transform_edt(~cells))


def _lattice(room: Room, taken: Taken, pitch: float, places: Floats) -> Floats:
    """The free points (n, 2) of the lattice whose offset gives the most, a place on it counting as much as three."""
    allowed = room.free & ~room.narrow & ~room.double & ~taken.cells
    rows, columns = room.free.shape
    best, most = np.zeros((0, 2)), -1.0
    for k in range(_OFFSETS**2):
        offset = pitch * (np.array(divmod(k, _OFFSETS)) + 0.5) / _OFFSETS
        x, y = np.arange(offset[0], columns, pitch), np.arange(offset[1], rows, pitch)
        found = allowed[np.ix_(y.astype(np.int64), x.astype(np.int64))]
        off = np.abs((places - offset + pitch / 2) % pitch - pitch / 2).max(axis=1) if len(places) else np.zeros(0)
        value = float(found.sum()) + 3.0 * float((off < pitch / _OFFSETS).sum())
        if value > most:
            row, column = np.nonzero(found)
            best, most = np.stack([x[column], y[row]], axis=1), value
    return best
