"""How near robots came to each other: at each moment the nearest pair, and how far apart it is."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

Floats = npt.NDArray[np.float64]

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
        (m, n, 3) and (n,) metres, n at least 2; a robot that is not there has NaN.
    """
    first, second = np.triu_indices(len(radii), 1)
    touch = radii[first] + radii[second]
    metres, best = np.full(len(positions), np.nan), np.zeros(len(positions), dtype=np.int64)
    at_once = max(1, _MOST_NUMBERS // len(touch))
    for start in range(0, len(positions), at_once):
        block = slice(start, start + at_once)
        apart = np.linalg.norm(positions[block, first] - positions[block, second], axis=2)
        best[block] = np.where(np.isnan(apart), np.inf, apart - touch).argmin(axis=1)
        metres[block] = np.take_along_axis(apart, best[block, None], axis=1)[:, 0]
    return Nearest(metres, np.stack([first[best], second[best]], axis=1), touch[best])
