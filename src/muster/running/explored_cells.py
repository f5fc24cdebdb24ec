"""The map that a team builds as events tell it: in cells wide enough to be shown, what has changed at a time."""

from __future__ import annotations

import math

import numpy as np
import numpy.typing as npt

from muster.motion.grid import Bools
from muster.perception.team_map import TeamMap
from muster.state.explored_map import FREE, OBSTACLE, UNSEEN
from muster.state.ground_events import MapGrows

MOST_CELLS = 160
"""Cells on the longer side of a map that is shown."""


class ShownMap:
    """The map of explored ground, coarsened; `event` tells what has changed since the last one."""

    def __init__(self, team_map: TeamMap) -> None:
        self._map = team_map
        frame = team_map.ground.seen.frame
        self._wide = max(1, math.ceil(max(frame.shape) / MOST_CELLS))
        self._size = (math.ceil(frame.shape[0] / self._wide), math.ceil(frame.shape[1] / self._wide))
        self._told: npt.NDArray[np.int8] = np.full(self._size, UNSEEN, dtype=np.int8)

    @property
    def explored_m2(self) -> float:
        """How large the ground is that was seen to be free."""
        self._map.share_air()
        seen = self._map.ground.seen
        return float(np.count_nonzero(seen.known & ~seen.occupied) * seen.frame.resolution_m**2)

    def event(self) -> MapGrows | None:
        """Return the event of what has changed; None: nothing has."""
        self._map.share_air()
        now = np.full(self._size, UNSEEN, dtype=np.int8)
        seen = self._map.ground.seen
        now[self._any(seen.known)] = FREE
        now[self._any(seen.occupied)] = OBSTACLE
        changed = now != self._told
        if not changed.any():
            return None
        self._told = now
        frame = seen.frame
        runs = tuple(run for row in np.flatnonzero(changed.any(axis=1)) for run in _runs(int(row), now, changed))
        return MapGrows(
            cell_m=frame.resolution_m * self._wide,
            origin=frame.origin,
            size=self._size,
            runs=runs,
            explored_m2=round(self.explored_m2, 3),
        )

    def _any(self, cells: Bools) -> Bools:
        """Return for each wide cell whether any of its cells is one of these."""
        rows, columns = self._size
        padded = np.zeros((rows * self._wide, columns * self._wide), dtype=np.bool_)
        padded[: cells.shape[0], : cells.shape[1]] = cells
        wide: Bools = np.any(padded.reshape(rows, self._wide, columns, self._wide), axis=(1, 3))
        return wide


def _runs(row: int, now: npt.NDArray[np.int8], changed: Bools) -> list[tuple[int, int, int, int]]:
    """Return the runs of equal cells that changed in a row: row, first column, how many, what they are."""
    values = np.where(changed[row], now[row], -1)
    edges = np.flatnonzero(np.diff(values)) + 1
    firsts = np.concatenate([[0], edges])
    counts = np.diff(np.concatenate([firsts, [len(values)]]))
    return [
        (row, int(first), int(count), int(values[first]))
        for first, count in zip(firsts, counts, strict=True)
        if values[first] >= 0
    ]
