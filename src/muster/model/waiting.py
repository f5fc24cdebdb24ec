"""What robots are expected to wait for others on their ways: a cost beside travel."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from muster.mission.values.arrays import Bools, Floats

Places = Sequence[int] | npt.NDArray[np.int64]


@dataclass(frozen=True, eq=False)
class Waiting:
    """Seconds beside those of travel, which usage counts too: in metres, as what the robot would travel meanwhile.

    Parameters
    ----------
    seconds
        (p, p) from one place of a problem to another, at least 0; empty: nobody waits.
    robots
        (m,) whether a robot of the problem waits; empty where nobody does.
    """

    seconds: Floats
    robots: Bools

    def of(self, i: int, places: Places, to: Places) -> Floats | float:
        """(len(places), len(to)) seconds for which robot i waits; 0 where it waits nowhere."""
        if not len(self.seconds) or not self.robots[i]:
            return 0.0
        return np.asarray(self.seconds[np.asarray(places, np.int64)[:, None], np.asarray(to, np.int64)[None]])

    def part(self, robots: Sequence[int], places: Sequence[int]) -> Waiting:
        """The waiting of some robots between some places."""
        if not len(self.seconds):
            return self
        return Waiting(np.ascontiguousarray(self.seconds[np.ix_(places, places)]), self.robots[list(robots)])


NO_WAITING = Waiting(np.empty((0, 0)), np.empty(0, dtype=np.bool_))
