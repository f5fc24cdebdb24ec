"""Maps of cells in which hits and passes are counted, and such maps as plain data, with which a run is resumed."""

from __future__ import annotations

import base64
import zlib
from abc import ABC, abstractmethod
from collections.abc import Mapping
from typing import Any

import numpy as np
import numpy.typing as npt

from muster.motion.grid import Bools, Floats, Indices

Counts = npt.NDArray[np.int32]

OCCUPIED_SHARE = 0.1
"""Share of the scans of a cell that end in it from which the cell is occupied."""
_STEPS = 254
"""Of a cell in which the place of what was hit is kept."""
_MOST = 255
"""Hits and passes of a cell that are kept, at most."""


class CountedMap(ABC):
    """What `OccupancyMap` and `VoxelMap` have in common.

    Attributes
    ----------
    clearance_m : float
        The greatest clearance of interest.
    hits, passes : ndarray
        How many beams ended in each cell; how many scans passed it.
    occupied : ndarray of bool
        Which cells hold an obstacle, as far as they were seen.
    near : ndarray of bool
        Which cells were seen from as near as was said to count.
    clearances : ndarray
        From the centre of each cell to the nearest point that was hit; inf beyond `clearance_m`.
    """

    clearance_m: float
    hits: Counts
    passes: Counts
    occupied: Bools
    near: Bools
    clearances: npt.NDArray[np.float32]

    def _make_empty(self, shape: tuple[int, ...]) -> None:
        self.hits, self.passes = np.zeros(shape, dtype=np.int32), np.zeros(shape, dtype=np.int32)
        self.occupied, self.near = np.zeros(shape, dtype=np.bool_), np.zeros(shape, dtype=np.bool_)
        self.clearances = np.full(shape, np.inf, dtype=np.float32)

    @property
    def known(self) -> Bools:
        """Return which cells were seen at all."""
        known: Bools = (self.hits > 0) | (self.passes > 0)
        return known

    def require_clearance(self, clearance_m: float) -> None:
        """Keep clearances up to this distance at least, from now on."""
        if clearance_m > self.clearance_m:
            self.clearance_m = clearance_m
            self._keep_off(np.argwhere(self.occupied))

    @abstractmethod
    def offsets_in(self, cells: Indices) -> Floats:
        """Return how far the mean points hit are from the centres of cells (n, d), in cells."""

    @abstractmethod
    def put(self, cells: Indices, offsets: Floats, hits: Counts) -> None:
        """Let cells (n, d) be occupied, whose mean points hit are off their centres so far."""

    @abstractmethod
    def _keep_off(self, cells: Indices) -> None:
        """Take the points hit in cells (n, d) into the clearances of the cells around them."""


def are_occupied(hits: Counts, passes: Counts) -> Bools:
    """Return which cells are occupied, by how many beams ended in them and how many scans passed them."""
    occupied: Bools = (hits > 0) & (hits >= OCCUPIED_SHARE * (hits + passes))
    return occupied


def packed(seen: CountedMap) -> dict[str, str]:
    """Return a map as text: which cells are known, which were seen from near, and what is occupied."""
    cells = np.argwhere(seen.occupied)
    at = tuple(cells.T)
    offsets = np.clip(np.round(seen.offsets_in(cells) * _STEPS), -127, 127).astype(np.int8)
    counts = np.column_stack([np.minimum(of[at], _MOST) for of in (seen.hits, seen.passes)]).astype(np.uint8)
    return {
        "known": _text(np.packbits(seen.known)),
        "near": _text(np.packbits(seen.near)),
        "occupied": _text(np.packbits(seen.occupied)),
        "offsets": _text(offsets),
        "counts": _text(counts),
    }


def unpack(seen: CountedMap, data: Mapping[str, Any]) -> None:
    """Enter into an empty map what `packed` has made of one of the same cells."""
    shape = seen.occupied.shape

    def bits(name: str) -> Bools:
        return np.unpackbits(_array(data[name], np.uint8), count=seen.occupied.size).astype(np.bool_).reshape(shape)

    seen.passes[bits("known")] = 1
    seen.near |= bits("near")
    cells = np.argwhere(bits("occupied"))
    offsets = _array(data["offsets"], np.int8).reshape(-1, len(shape)) / _STEPS
    hits, passes = _array(data["counts"], np.uint8).reshape(-1, 2).astype(np.int32).T
    seen.passes[tuple(cells.T)] = passes
    seen.put(cells, offsets, hits)


def _text(array: npt.NDArray[Any]) -> str:
    return base64.b64encode(zlib.compress(array.tobytes(), level=1)).decode()


def _array(text: str, kind: type[Any]) -> npt.NDArray[Any]:
    return np.frombuffer(zlib.decompress(base64.b64decode(text)), dtype=kind)
