"""What the search for a way answers: a path, or why there is none. No path is a value, not an error."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

Floats = npt.NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class Path:
    """Straight pieces from a start to a goal.

    Parameters
    ----------
    points
        (k, 2) or (k, 3) metres in the map frame, k >= 1, the start first and the goal last.
    """

    points: Floats

    @property
    def length_m(self) -> float:
        return float(np.linalg.norm(np.diff(self.points, axis=0), axis=1).sum())


@dataclass(frozen=True)
class NoPath:
    """Why there is no path.

    Parameters
    ----------
    reason
        `start blocked`, `goal blocked`, `disconnected`, or `not found` from a planner that samples and has ended.
    detail
        for people: where, and what is in the way.
    """

    reason: str
    detail: str = ""
