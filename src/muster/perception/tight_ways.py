"""Ways through narrow places, in plane and space: pushed off what was hit, to the middle of what is free."""

from __future__ import annotations

import itertools
import math
from typing import TYPE_CHECKING

import numpy as np

from muster.motion.grid import Floats

if TYPE_CHECKING:
    from scipy.spatial import KDTree

_PUSH, _PUSHES = 0.1, 20
"""Of a cell by which ways are pushed at a time, and how often."""


def in_the_middle(
    points: Floats, tree: KDTree, cell_m: float, wanted_m: float, least_m: float
) -> tuple[Floats, Floats]:
    """Push a way off obstacles that are too near; return it, and its places (n, d) at which the body does not fit.

    Parameters
    ----------
    points : ndarray, shape (k, d)
        The way, metres. Its ends stay.
    tree : KDTree
        The points of obstacles.
    cell_m : float
        The side of a cell of the map.
    wanted_m, least_m : float
        The distance from obstacles up to which the way is pushed, and the one that the body needs.
    """
    points = dense(points, cell_m)
    away, _ = tree.query(points)
    near = np.flatnonzero(away < wanted_m)
    near = near[(near > 0) & (near < len(points) - 1)]
    for _ in range(_PUSHES):
        away, nearest = tree.query(points[near])
        short = away < wanted_m
        if not short.any():
            break
        off = points[near] - tree.data[nearest]
        points[near[short]] += (_PUSH * cell_m / np.maximum(away, 1e-9))[short, None] * off[short]
    away, _ = tree.query(points[near])
    return points, points[near[away < least_m]]


def dense(points: Floats, step_m: float) -> Floats:
    """Return points (n, d) on a line, not farther apart than a step."""
    pieces = [
        np.linspace(a, b, max(1, math.ceil(math.dist(a, b) / step_m)), endpoint=False)
        for a, b in itertools.pairwise(points)
    ]
    return np.concatenate([*pieces, points[-1:]])
