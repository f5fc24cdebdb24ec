"""Frontiers: where ground that was seen borders on ground that was not, and robots can get ([yamauchi1997])."""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np

from muster.motion.grid import Bools, Floats, Indices
from muster.motion.map_world import Body
from muster.perception.explored_ground import ExploredGround

_LEAST_CELLS = 3
_AS_WIDE = np.ones((3, 3), dtype=np.bool_)


def frontier_cells(ground: ExploredGround, body: Body, *, near: bool) -> Bools:
    """Return the cells that were seen, are free for a body, and border on such as were not seen and may be free.

    Parameters
    ----------
    near : bool
        Whether only what was seen from near counts as seen.
    """
    from scipy.ndimage import binary_dilation

    free, known = ground.free_cells(body), ground.seen.near if near else ground.seen.known
    cells: Bools = free & known & binary_dilation(free & ~known, _AS_WIDE)
    return cells


def frontiers(ground: ExploredGround, body: Body, places: Floats, *, near: bool) -> list[tuple[Floats, float]]:
    """Return a place on each frontier that robots can reach, and the frontier's length in metres, the longest first.

    Parameters
    ----------
    ground : ExploredGround
        What is known.
    body : Body
        The robots' body.
    places : ndarray, shape (n, 2)
        Where robots are.
    near : bool
        Whether only what was seen from near counts as seen.
    """
    from scipy.ndimage import label

    cell_m = ground.seen.frame.resolution_m
    numbers, count = label(frontier_cells(ground, body, near=near), _AS_WIDE)
    cells = np.argwhere(numbers > 0)
    parts = numbers[tuple(cells.T)]
    order = np.argsort(parts, kind="stable")
    groups = np.split(cells[order], np.cumsum(np.bincount(parts, minlength=count + 1)[1:-1])) if count else []
    least = max(_LEAST_CELLS, math.ceil(2 * body.radius_m / cell_m))
    long_enough = sorted((group for group in groups if len(group) >= least), key=len, reverse=True)
    if not long_enough:
        return []
    targets = ground.seen.centres(np.array([_middle(group) for group in long_enough]))
    reached = np.isfinite(ground.lengths(body, places, targets).min(axis=0)).tolist()
    return [
        (target, len(group) * cell_m)
        for target, group, is_reached in zip(targets, long_enough, reached, strict=True)
        if is_reached
    ]


def is_near_frontier(frontier: Bools, ground: ExploredGround, place: Sequence[float], within_m: float) -> bool:
    """Return whether a cell of the frontier is within a distance of a place (x, y)."""
    cells = math.ceil(within_m / ground.seen.frame.resolution_m)
    column, row = np.floor(ground.seen.frame.to_grid(np.array([place[:2]]))[0]).astype(int)
    return bool(frontier[max(0, row - cells) : row + cells + 1, max(0, column - cells) : column + cells + 1].any())


def _middle(cells: Indices) -> Indices:
    """Return the cell of some that is nearest to their mean."""
    nearest: Indices = cells[np.argmin(np.linalg.norm(cells - cells.mean(axis=0), axis=1))]
    return nearest
