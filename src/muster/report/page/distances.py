"""The distances between robots: the nearest pair at each moment."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from muster.mission.values.arrays import Floats

_MOST_NUMBERS = 1_000_000  # in memory at once


@dataclass(frozen=True, eq=False)
class Nearest:
    """The nearest pair at each of m moments.

    Parameters
    ----------
    metres
        (m,) between the two centres; NaN where fewer than two robots are there.
    pairs
        (m, 2) the two robots.
    touch_m
        (m,) the sum of their radii: nearer than this is contact.
    """

    metres: Floats
    pairs: npt.NDArray[np.int64]
    touch_m: Floats


def nearest(positions: Floats, radii: Floats) -> Nearest:
    """The pairs of robots that are nearest to contact.

    Parameters
    ----------
    positions, radii
        (m, n, 3) and (n,) metres, n at least 2; an absent robot has NaN.
    """
    moments, n = positions.shape[:2]
    touch = radii[:, None] + radii[None, :]
    touch[np.diag_indices(n)] = -np.inf
    pairs = np.zeros((moments, 2), dtype=np.int64)
    at_once = max(1, _MOST_NUMBERS // n**2)
    for start in range(0, moments, at_once):
        apart = _distances(positions[start : start + at_once]) - touch
        best = np.where(np.isnan(apart), np.inf, apart).reshape(len(apart), -1).argmin(axis=1)
        pairs[start : start + at_once] = np.stack(np.unravel_index(best, (n, n)), axis=1)
    first, second, rows = pairs[:, 0], pairs[:, 1], np.arange(moments)
    metres = np.linalg.norm(positions[rows, first] - positions[rows, second], axis=1)
    alone = first == second
    return Nearest(np.where(alone, np.nan, metres), pairs, np.where(alone, 0.0, radii[first] + radii[second]))


def _distances(places: Floats) -> Floats:
    """Distances between all places (k, n, 3) of each moment: (k, n, n) metres, by |a - b|^2 = a a + b b - 2 a b."""
    squares = np.square(places).sum(axis=2)
    apart = squares[:, :, None] + squares[:, None, :] - 2 * places @ places.transpose(0, 2, 1)
    return np.asarray(np.sqrt(np.maximum(apart, 0.0)))
