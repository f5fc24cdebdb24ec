"""Maps that robots build each for itself, in pieces that they send each other, and the map that these pieces make.

A piece holds what has changed since the piece before: cells of a robot's map that are free now, that the robot has
covered itself, or that hold an obstacle. In the map of all pieces a cell is an obstacle where one robot has it as one,
unless more than nine times as many have it as free, or one has covered it: what others saw there was that robot. This
depends on no order: robots that have the same pieces have the same map, to the bit.
"""

from __future__ import annotations

import math
import struct
import zlib
from collections.abc import Hashable, Iterator, Mapping, Sequence
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from muster.mission.errors import ParameterError
from muster.motion.grid import Bools, Floats, Indices
from muster.perception.occupancy_map import OccupancyMap
from muster.perception.team_map import TeamMap

UNSEEN, FREE, COVERED, OBSTACLE = 0, 1, 2, 3
_WEIGHTS = np.array([0, 1, 1000, 0], dtype=np.int32)
"""For how many robots one counts that has a cell in each state as free."""
STEPS = 254
"""Parts of a cell in which the place of what was hit is told."""
_HEAD = struct.Struct("<BIII")  # the layer, the runs of free and of covered cells, and the cells with obstacles
_MOST_BYTES = 32 * 2**20
"""Bytes of a piece that is unpacked, at most: more than those of any map."""

States = npt.NDArray[np.int8]
Offsets = npt.NDArray[np.int32]


@dataclass(frozen=True, eq=False)
class CellChange:
    """Cells of a layer that have changed.

    Parameters
    ----------
    layer : int
        The number of the layer.
    cells : ndarray of int, shape (n,)
        The cells, by row and column in one number, ascending.
    states : ndarray of int8, shape (n,)
        What they are now: FREE, COVERED or OBSTACLE; UNSEEN in no piece.
    offsets : ndarray of int, shape (n, 2)
        Of obstacles, how far the mean point hit is off the centre of the cell, row and column, in STEPS a cell; else 0.
    """

    layer: int
    cells: Indices
    states: States
    offsets: Offsets

    def part(self, which: Bools | Indices | slice) -> CellChange:
        """Return the change of some of the cells."""
        return CellChange(self.layer, self.cells[which], self.states[which], self.offsets[which])


class PieceMaker:
    """Makes pieces of the map that one robot builds for itself.

    Parameters
    ----------
    own : TeamMap
        The robot's map.
    room : int
        The bytes that a piece may have; one that cannot be divided may have more.
    """

    def __init__(self, own: TeamMap, room: int) -> None:
        self._maps, self._room = own.layer_maps, room
        self._told = [np.full(seen.occupied.size, UNSEEN, dtype=np.int8) for seen in self._maps]
        self._covered = [np.zeros(seen.occupied.shape, dtype=np.bool_) for seen in self._maps]

    def cover(self, place: Floats, radius_m: float) -> None:
        """Note the cells within a radius of a place (2,), metres, that the robot has covered itself."""
        for seen, covered in zip(self._maps, self._covered, strict=True):
            column, row = seen.frame.to_grid(place[None])[0]
            reach = radius_m / seen.frame.resolution_m
            low, high = (max(0, math.floor(at - reach)) for at in (row, column)), (row + reach, column + reach)
            part = tuple(slice(a, max(a, math.ceil(b))) for a, b in zip(low, high, strict=True))
            rows, columns = (
                np.arange(n.start, n.start + size) + 0.5 for n, size in zip(part, covered[part].shape, strict=True)
            )
            covered[part] |= np.hypot(rows[:, None] - row, columns - column) <= reach

    def pieces(self) -> list[bytes]:
        """Return what has changed since the last call, in as many pieces as there need to be."""
        changes = [change for number in range(len(self._maps)) for change in self._changes(number)]
        return [piece for change in changes for piece in _packed(change, self._room)]

    def _changes(self, number: int) -> Iterator[CellChange]:
        seen = self._maps[number]
        now = np.where(seen.known, FREE, UNSEEN).astype(np.int8)
        now[self._covered[number]] = COVERED
        now[seen.occupied] = OBSTACLE
        now = now.ravel()
        cells: Indices = np.flatnonzero(now != self._told[number])
        self._told[number] = now
        if len(cells):
            states, offsets = now[cells], np.zeros((len(cells), 2), dtype=np.int32)
            hit = states == OBSTACLE
            off = seen.offsets_in(_rows_and_columns(cells[hit], seen))
            offsets[hit] = np.clip(np.round(off * STEPS), -STEPS // 2, STEPS // 2)
            yield CellChange(number, cells, states, offsets)


class PooledMap:
    """The map that pieces of several robots make.

    Parameters
    ----------
    team_map : TeamMap
        The map, empty at first, into which `settle` enters the pieces.
    """

    def __init__(self, team_map: TeamMap) -> None:
        self.map = team_map
        self._states: dict[Hashable, list[CellChange]] = {}  # of each track and layer, all cells
        self._steps: dict[Hashable, list[list[_Step]]] = {}  # by piece
        self._votes = [_Votes.empty(seen) for seen in team_map.layer_maps]
        self._touched = [np.zeros(seen.occupied.size, dtype=np.bool_) for seen in team_map.layer_maps]

    def add(self, track: Hashable, piece: bytes) -> None:
        """Take in the next piece of a track, which one robot writes.

        Raises
        ------
        ParameterError
            If it is no piece of such a map. It counts as an empty one then, for all robots alike.
        """
        steps: list[_Step] = []
        self._steps.setdefault(track, []).append(steps)
        sizes = [len(touched) for touched in self._touched]
        for change in unpacked(piece, sizes):
            if track not in self._states:
                self._states[track] = [_unseen(k, size) for k, size in enumerate(sizes)]
            states = self._states[track][change.layer]
            step = _Step(states.part(change.cells), change)
            states.states[change.cells], states.offsets[change.cells] = change.states, change.offsets
            steps.append(step)
            self._votes[change.layer].change(step.was, step.now)
            self._touched[change.layer][change.cells] = True

    def settle(self) -> None:
        """Enter all pieces that were added into the map, within a look of it."""
        for number, (votes, touched) in enumerate(zip(self._votes, self._touched, strict=True)):
            if touched.any():
                votes.enter(self.map, number, np.flatnonzero(touched))
                touched[:] = False

    def enter_first(self, counts: Mapping[Hashable, int], team_map: TeamMap) -> None:
        """Make another map as it is by the first pieces of each track, so many; none of tracks that are not named."""
        votes = [one.copy() for one in self._votes]
        for track, pieces in self._steps.items():
            for step in (step for steps in reversed(pieces[counts.get(track, 0) :]) for step in reversed(steps)):
                votes[step.was.layer].change(step.now, step.was)
        team_map.begin_look()
        for number, (one, seen) in enumerate(zip(votes, team_map.layer_maps, strict=True)):
            seen.clear()
            one.enter(team_map, number, np.flatnonzero((one.hits > 0) | (one.passes > 0)))
        team_map.end_look()


@dataclass(frozen=True, eq=False)
class _Step:
    """What a piece has changed in the map of its robot: what some cells were, and what they are."""

    was: CellChange
    now: CellChange


@dataclass(frozen=True, eq=False)
class _Votes:
    """How many robots have each cell of a layer as an obstacle, and as free; and the sum of their offsets."""

    hits: npt.NDArray[np.int32]
    passes: npt.NDArray[np.int32]
    offsets: Offsets

    @classmethod
    def empty(cls, seen: OccupancyMap) -> _Votes:
        size = seen.occupied.size
        return cls(np.zeros(size, np.int32), np.zeros(size, np.int32), np.zeros((size, 2), np.int32))

    def copy(self) -> _Votes:
        return _Votes(self.hits.copy(), self.passes.copy(), self.offsets.copy())

    def change(self, was: CellChange, now: CellChange) -> None:
        """Count cells as they are now, and no more as they were."""
        cells = now.cells
        self.hits[cells] += (now.states == OBSTACLE).astype(np.int32) - (was.states == OBSTACLE)
        self.passes[cells] += _WEIGHTS[now.states] - _WEIGHTS[was.states]
        self.offsets[cells] += now.offsets - was.offsets

    def enter(self, team_map: TeamMap, number: int, cells: Indices) -> None:
        hits, passes = self.hits[cells], self.passes[cells]
        offsets = self.offsets[cells] / (STEPS * np.maximum(hits, 1))[:, None]
        team_map.recount(number, _rows_and_columns(cells, team_map.layer_maps[number]), hits, passes, offsets)


def _unseen(layer: int, size: int) -> CellChange:
    return CellChange(layer, np.arange(size), np.zeros(size, np.int8), np.zeros((size, 2), np.int32))


def _rows_and_columns(cells: Indices, seen: OccupancyMap) -> Indices:
    return np.column_stack(np.divmod(cells, seen.occupied.shape[1]))


def _packed(change: CellChange, room: int) -> list[bytes]:
    """Return a change as pieces, each with so many bytes at most if it can be divided."""
    hit = change.states == OBSTACLE
    runs = [_runs(change.cells[change.states == state]) for state in (FREE, COVERED)]
    numbers = np.concatenate([*(part for run in runs for part in run), np.diff(change.cells[hit], prepend=0)])
    head = _HEAD.pack(change.layer, *(len(starts) for starts, _ in runs), int(hit.sum()))
    piece = zlib.compress(head + numbers.astype("<u4").tobytes() + change.offsets[hit].astype(np.int8).tobytes())
    half = len(change.cells) // 2
    if len(piece) <= room or not half:
        return [piece]
    return _packed(change.part(slice(half)), room) + _packed(change.part(slice(half, None)), room)


def _runs(cells: Indices) -> tuple[Indices, Indices]:
    """Return runs of neighbouring cells: how far each begins after the one before began, and how long it is."""
    firsts = np.flatnonzero(np.diff(cells, prepend=-2) != 1)
    return np.diff(cells[firsts], prepend=0), np.diff(np.append(firsts, len(cells)))


def unpacked(piece: bytes, sizes: Sequence[int]) -> list[CellChange]:
    """Return the changes in a piece of a map whose layers have so many cells.

    Raises
    ------
    ParameterError
        If it is no such piece.
    """
    data = _decompressed(piece)
    layer, *counts = _HEAD.unpack_from(data)
    free, covered, hits = counts
    if layer >= len(sizes) or len(data) != _HEAD.size + 8 * (free + covered) + 6 * hits:
        raise ParameterError(f"piece of a map: layer {layer}, {len(data)} bytes; expected one of {len(sizes)} layers")
    numbers = np.frombuffer(data, "<u4", 2 * (free + covered) + hits, _HEAD.size).astype(np.int64)
    ends = np.cumsum([free, free, covered, covered])
    parts = np.split(numbers, ends)
    cells = [_cells(parts[0], parts[1], sizes[layer]), _cells(parts[2], parts[3], sizes[layer]), np.cumsum(parts[4])]
    whole = np.concatenate(cells)
    is_named = np.zeros(sizes[layer], dtype=np.bool_)
    is_named[whole[whole < len(is_named)]] = True
    if np.count_nonzero(is_named) != len(whole):
        raise ParameterError(f"piece of a map: cells twice, or beyond {sizes[layer]}; expected cells of the layer")
    offsets = np.zeros((len(whole), 2), dtype=np.int32)
    offsets[len(whole) - hits :] = np.frombuffer(data, np.int8, 2 * hits, len(data) - 2 * hits).reshape(-1, 2)
    states = np.repeat(np.array([FREE, COVERED, OBSTACLE], np.int8), [len(part) for part in cells])
    return [CellChange(layer, whole, states, offsets)] if len(whole) else []


def _decompressed(piece: bytes) -> bytes:
    reader = zlib.decompressobj()
    try:
        data = reader.decompress(piece, _MOST_BYTES)
    except zlib.error as error:
        raise ParameterError(f"piece of a map: {len(piece)} bytes: {error}; expected a piece") from None
    if not reader.eof or reader.unused_data or len(data) < _HEAD.size:
        raise ParameterError(f"piece of a map: {len(data)} bytes unpacked; expected a whole piece")
    return data


def _cells(gaps: Indices, lengths: Indices, size: int) -> Indices:
    """Return the cells of runs, as `_runs` makes them."""
    if not len(gaps):
        return gaps
    starts = np.cumsum(gaps)
    if lengths.min() < 1 or lengths.sum() > size or (starts + lengths).max() > size:
        raise ParameterError(f"piece of a map: cells beyond {size}; expected cells of the layer")
    before = np.append(0, np.cumsum(lengths)[:-1])
    return np.repeat(starts - before, lengths) + np.arange(lengths.sum())
