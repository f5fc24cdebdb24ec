"""The map's walls as faces that stop simulated robots: sides of polygons, or borders of an image's blocked cells."""

from __future__ import annotations

import itertools
import math

import numpy as np

from muster.motion.grid import Bools, Floats, Grid
from muster.motion.map_world import Body, World
from muster.perception.explored_ground import is_obstacle
from muster.perception.sphere_scanner import Slab


def faces_and_slabs(world: World, body: Body) -> tuple[Floats, list[Slab]]:
    """What stops a body on a map.

    Returns
    -------
    upright faces (k, 6), each x, y of one end, x, y of the other, lowest and highest z; and the zones with a height.
    Metres in the map frame; infinite where a wall has no end.
    """
    three_d = world.dimensions == 3
    if world.image is not None:
        ends = borders_of(world.blocked(body, three_d))
        return np.column_stack([ends, np.full(len(ends), -math.inf), np.full(len(ends), math.inf)]), []
    assert world.boundary is not None
    faces = _sides(list(world.boundary.exterior.coords), -math.inf, math.inf)
    slabs: list[Slab] = []
    for area in world.stopping(body, three_d):
        flies = three_d and body.kind == "air"
        low, high = (area.floor_m, area.ceiling_m) if flies else (-math.inf, math.inf)
        ring = [(float(x), float(y)) for x, y in area.polygon.exterior.coords]
        faces += _sides(ring, low, high)
        if math.isfinite(low) or math.isfinite(high):
            slabs.append((ring[:-1], low, high))
    return np.array(faces, dtype=np.float64).reshape(-1, 6), slabs


def things_in_air(world: World) -> tuple[Floats, list[Slab]]:
    """Return the upright faces and the level ones of what stands in the air, as `faces_and_slabs` does.

    What is closed by rule is not there, nor is what is closed to robots on the ground alone: it has no height.
    """
    faces: list[list[float]] = []
    slabs: list[Slab] = []
    for area in world.areas:
        if not (is_obstacle(area) and "air" in area.zone.forbidden_to):
            continue
        ring = [(float(x), float(y)) for x, y in area.polygon.exterior.coords]
        faces += _sides(ring, area.floor_m, area.ceiling_m)
        slabs.append((ring[:-1], area.floor_m, area.ceiling_m))
    return np.array(faces, dtype=np.float64).reshape(-1, 6), slabs


def _sides(ring: list[tuple[float, ...]] | list[tuple[float, float]], low: float, high: float) -> list[list[float]]:
    return [[*map(float, a[:2]), *map(float, b[:2]), low, high] for a, b in itertools.pairwise(ring)]


def borders_of(grid: Grid) -> Floats:
    """The borders between free and blocked cells, in pieces as long as they go: (k, 4), both ends in the map frame.

    What lies outside the grid is blocked.
    """
    fenced = np.pad(grid.blocked, 1, constant_values=True)
    level = _runs(fenced[1:, :] != fenced[:-1, :])  # between rows
    upright = _runs((fenced[:, 1:] != fenced[:, :-1]).T)
    ends = np.concatenate([level, upright[:, [1, 0, 3, 2]]])
    return np.concatenate([grid.to_map(ends[:, :2]), grid.to_map(ends[:, 2:])], axis=1)


def _runs(borders: Bools) -> Floats:
    """Runs of true in each row: (k, 4) of (from, row, to, row); columns count from the frame's, which is -1."""
    steps = np.diff(np.pad(borders.astype(np.int8), ((0, 0), (1, 1))), axis=1)
    lines, begins = np.nonzero(steps == 1)
    _, ends = np.nonzero(steps == -1)
    return np.column_stack([begins - 1, lines, ends - 1, lines]).astype(np.float64)
