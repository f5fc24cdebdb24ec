"""The energy that robots have left as measured: what plans of the rest of a mission need of telemetry."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from muster.mission.values.arrays import Floats


@dataclass(frozen=True, kw_only=True)
class EnergyLeft:
    """What was measured of a robot's energy.

    Parameters
    ----------
    left
        the share that is left, 0 to 1.
    used
        the robot's usage when it was measured, in the mission's unit.
    capacity
        the usage that a full robot has energy for; inf where the mission does not say.
    """

    left: float
    used: float = 0.0
    capacity: float = math.inf


@dataclass(frozen=True)
class Drains:
    """Shares of energy that routes use up: `spent`, and usage beyond `used` as a share of `capacity`; each (m,)."""

    spent: Floats
    used: Floats
    capacity: Floats

    @classmethod
    def of(cls, left: Sequence[EnergyLeft | None], capacities: Floats) -> Drains:
        """Of robots that have so much left; where nothing was measured, of full robots and these capacities."""
        found = cls(np.zeros(len(capacities)), np.zeros(len(capacities)), capacities.copy())
        for i, one in enumerate(left):
            if one is not None:
                found.spent[i], found.used[i], found.capacity[i] = 1 - one.left, one.used, one.capacity
        return found

    def shares(self, usages: Floats, robots: int | slice) -> Floats:
        """The shares that routes with these usages use up in all: at most 1, 0 where nothing bounds a robot."""
        planned = share_used(np.maximum(usages - self.used[robots], 0.0), self.capacity[robots])
        return np.asarray(np.minimum(self.spent[robots] + planned, np.maximum(1.0, planned)))


def share_used(usage: Floats | float, capacity: Floats | float) -> Floats:
    """The share of its capacity that a robot's route has used up: 0 to 1; 0 where capacity is unlimited."""
    return np.divide(usage, capacity, out=np.zeros(np.shape(usage)), where=np.greater(capacity, 0.0))
