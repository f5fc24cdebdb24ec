"""The obstacles of a voxel map as zones of a mission: upright blocks with floors and ceilings."""

from __future__ import annotations

import numpy as np

from muster.mission.model import Zone
from muster.motion.grid import Bools, Indices
from muster.perception.voxel_map import VoxelMap

MOST_BLOCKS = 200
"""Blocks up to which voxels are kept as fine as they are; beyond, eight at a time become one."""


def zones_of(seen: VoxelMap) -> tuple[Zone, ...]:
    """Return blocks that cover all occupied voxels: `MOST_BLOCKS` at most, as wide as that takes."""
    occupied, wide = seen.occupied, 1
    while len(blocks := _blocks(occupied)) > MOST_BLOCKS and min(occupied.shape) > 1:
        occupied, wide = _halved(occupied), 2 * wide
    x, y, z = seen.frame.origin
    cell_m = seen.frame.cell_m * wide
    zones = []
    for bottom, south, west, top, north, east in blocks.tolist():
        corners = ((west, south), (east, south), (east, north), (west, north))
        zones.append(
            Zone(
                polygon=tuple((round(x + i * cell_m, 4), round(y + j * cell_m, 4)) for i, j in corners),
                floor_m=round(z + bottom * cell_m, 4) if bottom else None,
                ceiling_m=round(z + top * cell_m, 4),
                forbidden_to=("ground", "air"),
            )
        )
    return tuple(zones)


def _blocks(occupied: Bools) -> Indices:
    """Return blocks (n, 6) that together are these voxels: first layer, row, column; and the ends of each."""
    left, found = occupied.copy(), []
    for layer, row, column in np.argwhere(occupied):
        if not left[layer, row, column]:
            continue
        top, north, east = layer + 1, row + 1, column + 1
        while east < left.shape[2] and left[layer, row, east]:
            east += 1
        while north < left.shape[1] and left[layer, north, column:east].all():
            north += 1
        while top < left.shape[0] and left[top, row:north, column:east].all():
            top += 1
        left[layer:top, row:north, column:east] = False
        found.append((layer, row, column, top, north, east))
    return np.array(found, dtype=np.int64).reshape(-1, 6)


def _halved(occupied: Bools) -> Bools:
    """Return voxels of twice the side, occupied where one of their eight parts is."""
    padded = np.pad(occupied, [(0, n % 2) for n in occupied.shape])
    layers, rows, columns = (n // 2 for n in padded.shape)
    parts = padded.reshape(layers, 2, rows, 2, columns, 2)
    return np.asarray(parts.any(axis=(1, 3, 5)))
