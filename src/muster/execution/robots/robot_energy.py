"""The energy of one robot during execution: its level, as telemetry tells it or as usage is counted."""

from __future__ import annotations

from dataclasses import dataclass

from muster.mission.model import Robot
from muster.model.energy import Energy, EnergyLevel, Refill

_REFILL_MARGIN = 0.02
"""Share of the capacity that a robot is filled more than planned: no way is driven exactly as it was planned."""
_KNOWN_AFTER = 0.02
"""Share of the capacity that a robot has to use before it is known how fast its energy drains."""
_EMPTY = 1e-9


@dataclass
class RobotEnergy(EnergyLevel):
    """What a robot holds, in the unit of usage.

    Parameters
    ----------
    reserve
        what stays in it by plan.
    lowest
        the least that it held.
    told
        whether telemetry tells the level; else it is counted.
    added
        what was added at stations.
    detours
        how many times as much the fleet uses as was planned.
    """

    reserve: float
    lowest: float
    told: bool = False
    added: float = 0.0
    detours: float = 1.0
    _drained: float = 0.0  # while usage grew by `_drained_over`
    _drained_over: float = 0.0

    @classmethod
    def of(cls, robot: Robot) -> RobotEnergy | None:
        """Return the energy of a robot as a mission begins; None of one that usage does not empty."""
        energy = Energy.of(robot)
        return None if energy is None else cls(energy.capacity, energy.at_start, energy.least, energy.at_start)

    @property
    def drain(self) -> float:
        """How fast it drains: times the planned usage, at least 1; 1 as long as that is not known."""
        if self._drained_over < _KNOWN_AFTER * self.capacity:
            return self.detours
        return self.detours * max(1.0, self._drained / self._drained_over)

    @property
    def is_empty(self) -> bool:
        """Whether telemetry tells that nothing is left."""
        return self.told and self.level <= _EMPTY * self.capacity

    def missing_for(self, usage: float) -> float:
        """By how much planned usage would bring it below its reserve; below 0: by as much it stays above."""
        return self.drain * usage - (self.level - self.reserve)

    def to_add(self, refill: Refill, until: float | None, ahead: float) -> float:
        """What a service is still to add: as planned, and what the robot has learnt to need.

        Parameters
        ----------
        until
            the share up to which it is to be filled; None: wholly.
        ahead
            the usage planned from then to the next refill.
        """
        goal = self.capacity
        if until is not None and refill.partial:
            needed = max(until * self.capacity, self.reserve + self.drain * ahead)
            goal = min(goal, needed + _REFILL_MARGIN * self.capacity)
        return max(0.0, goal - self.level)

    def hear(self, share: float | None, used: float, *, served: bool) -> None:
        """Note what telemetry tells, None: nothing; and how much the robot has used so far.

        `served`: whether it is at a station that adds energy, or was when it was last heard.
        """
        before, first = self.level, self.counted is None
        more = self.spend(used)
        if share is not None:
            self.told, self.level = True, share * self.capacity
        if served:
            self.added += max(0.0, self.level - before)
        elif self.told and not first:
            self._drained += max(0.0, before - self.level)
            self._drained_over += more
        self.lowest = min(self.lowest, self.level)

    def recall(self, share: float, used: float) -> None:
        """What it held before a restart, a share of its capacity, and how much the robot used after that."""
        self.level = max(0.0, share * self.capacity - used)
        self.lowest = min(self.lowest, self.level)

    def add(self, amount: float) -> None:
        """Energy was added at a station, which telemetry does not tell."""
        if not self.told:
            self.added += amount
            super().add(amount)
