"""How near robots came to each other: at each moment the nearest pair, and how far apart it is."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

Floats = npt.NDArray[np.float64]


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
    metres, pairs = np.full(len(positions), np.nan), np.zeros((len(positions), 2), dtype=np.int64)
    least = np.zeros(len(positions))
    for k, places in enumerate(positions):
        apart = np.linalg.norm(places[first] - places[second], axis=1)
        if np.isfinite(apart).any():
            best = int(np.nanargmin(apart - touch))
            metres[k], pairs[k], least[k] = apart[best], (first[best], second[best]), touch[best]
    return Nearest(metres, pairs, least)
