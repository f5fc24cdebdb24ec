"""The result of a path search: a path, or the reason why there is none. No path is a value, not an error."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from muster.mission.values.arrays import Floats

_STRAIGHT = 1e-9  # rad: what turns by less goes straight on


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

    @property
    def turns(self) -> Floats:
        """(j, 2) or (j, 3): the points without those in the midst of a straight piece, such as each cell on a grid."""
        if len(self.points) < 3:
            return self.points
        steps = np.diff(self.points, axis=0)
        lengths = np.linalg.norm(steps, axis=1, keepdims=True)
        directions = steps / np.where(lengths > 0, lengths, 1.0)
        bends = np.linalg.norm(np.diff(directions, axis=0), axis=1) > _STRAIGHT
        turns: Floats = self.points[np.concatenate([[True], bends, [True]])]
        return turns


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
