"""The energy of one robot during execution: its level, as telemetry tells it or as usage is counted."""

from __future__ import annotations

from dataclasses import dataclass, field

from muster.mission.stations import Battery

_KNOWN_AFTER = 0.02
"""Share of the capacity that a robot has to use before it is known how fast its battery drains."""
_EMPTY = 1e-9


@dataclass
class RobotEnergy:
    """What a battery holds, in the unit of usage.

    Parameters
    ----------
    battery
        as the mission has it.
    level
        what it holds now.
    told
        whether telemetry tells that; else it is counted.
    charged
        what was added at stations.
    detours
        how many times as much the fleet uses as was planned.
    """

    battery: Battery
    level: float = field(init=False)
    least: float = field(init=False)
    told: bool = False
    charged: float = 0.0
    detours: float = 1.0
    _used: float | None = None  # the robot's usage when the level was last noted
    _drained: float = 0.0  # while it used so much
    _drained_over: float = 0.0

    def __post_init__(self) -> None:
        self.level = self.least = self.battery.level_at_start

    @property
    def share(self) -> float:
        """What it holds as a share of its capacity."""
        return self.level / self.battery.capacity

    @property
    def above_reserve(self) -> float:
        """What it holds above its reserve."""
        return self.level - self.battery.least

    @property
    def drain(self) -> float:
        """How fast the battery drains: times the planned usage, at least 1; 1 as long as that is not known."""
        if self._drained_over < _KNOWN_AFTER * self.battery.capacity:
            return self.detours
        return self.detours * max(1.0, self._drained / self._drained_over)

    @property
    def is_empty(self) -> bool:
        """Whether telemetry tells that nothing is left."""
        return self.told and self.level <= _EMPTY * self.battery.capacity

    def hear(self, share: float | None, used: float, *, served: bool) -> None:
        """Note what telemetry tells, None: nothing; and how much the robot has used so far.

        `served`: whether it is at a station that adds energy, or was when it was last heard.
        """
        more = 0.0 if self._used is None else max(0.0, used - self._used)
        before, first, self._used = self.level, self._used is None, used
        if share is None:
            self.level = max(0.0, self.level - more) if not first else self.level
        else:
            self.told, self.level = True, share * self.battery.capacity
        if served:
            self.charged += max(0.0, self.level - before)
        elif self.told and not first:
            self._drained += max(0.0, before - self.level)
            self._drained_over += more
        self.least = min(self.least, self.level)

    def recall(self, share: float, used: float) -> None:
        """What it held before a restart, a share of its capacity, and how much the robot used after that."""
        self.level = max(0.0, share * self.battery.capacity - used)
        self.least = min(self.least, self.level)

    def add(self, amount: float) -> None:
        """Energy was added at a station, which telemetry does not tell."""
        if not self.told:
            self.charged += amount
            self.level = min(self.battery.capacity, self.level + amount)
