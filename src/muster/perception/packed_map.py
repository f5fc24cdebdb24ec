"""Maps that robots build as plain data, so that an interrupted run goes on with what it knew."""

from __future__ import annotations

import base64
import zlib
from collections.abc import Mapping
from typing import Any, Protocol

import numpy as np
import numpy.typing as npt

from muster.motion.grid import Bools, Floats, Indices
from muster.perception.occupancy_map import Counts

_STEPS = 254
"""Of a cell in which the place of what was hit is kept."""
_MOST = 255
"""Hits and passes of a cell that are kept, at most."""


class Counted(Protocol):
    """A map of cells in which hits and passes are counted: `OccupancyMap` or `VoxelMap`."""

    hits: Counts
    passes: Counts
    occupied: Bools
    near: Bools

    @property
    def known(self) -> Bools:
        """Which cells were seen at all."""
        ...

    def offsets_in(self, cells: Indices) -> Floats:
        """Return how far the mean points hit are from the centres of cells (n, d), in cells."""
        ...

    def put(self, cells: Indices, offsets: Floats, hits: Counts) -> None:
        """Let cells (n, d) be occupied, whose mean points hit are off their centres so far."""
        ...


def packed(seen: Counted) -> dict[str, str]:
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


def unpack(seen: Counted, data: Mapping[str, Any]) -> None:
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
