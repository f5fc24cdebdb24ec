"""Measured charges of batteries: what a robot's telemetry says, as far as plans of the rest of a mission need it."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from muster.mission.values.arrays import Floats


@dataclass(frozen=True, kw_only=True)
class Charge:
    """What was measured of a robot's battery.

    Parameters
    ----------
    left
        the share that is left, 0 to 1.
    used
        the robot's usage when it was measured, in the mission's unit.
    capacity
        the usage that a full battery allows; inf where the mission does not say.
    """

    left: float
    used: float = 0.0
    capacity: float = math.inf


@dataclass(frozen=True)
class Drains:
    """Shares of batteries that routes use up: `spent`, and usage beyond `used` as a share of `capacity`; each (m,)."""

    spent: Floats
    used: Floats
    capacity: Floats

    @classmethod
    def of(cls, charges: Sequence[Charge | None], capacities: Floats) -> Drains:
        """Of robots with these measured charges; where nothing was measured, of a full battery and these capacities."""
        found = cls(np.zeros(len(capacities)), np.zeros(len(capacities)), capacities.copy())
        for i, charge in enumerate(charges):
            if charge is not None:
                found.spent[i], found.used[i], found.capacity[i] = 1 - charge.left, charge.used, charge.capacity
        return found

    def shares(self, usages: Floats, robots: int | slice) -> Floats:
        """The shares that routes with these usages use up in all: at most 1, 0 where nothing bounds a robot."""
        planned = share_used(np.maximum(usages - self.used[robots], 0.0), self.capacity[robots])
        return np.asarray(np.minimum(self.spent[robots] + planned, np.maximum(1.0, planned)))


def share_used(usage: Floats | float, capacity: Floats | float) -> Floats:
    """The share of its capacity that a robot's route has used up: 0 to 1; 0 where capacity is unlimited."""
    return np.divide(usage, capacity, out=np.zeros(np.shape(usage)), where=np.greater(capacity, 0.0))
