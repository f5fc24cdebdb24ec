"""What a robot's energy and the services of stations are, as plans, runs and simulated worlds read them.

The mission states both by batteries and stations; whoever asks what a robot holds, what a station adds, or how long
that takes reads these primitives. All amounts are in the unit of usage.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, field

from muster.mission.model import Robot, Station


@dataclass(frozen=True)
class Energy:
    """What a robot can hold.

    Parameters
    ----------
    capacity : float
        The most.
    at_start : float
        What it holds at first.
    least : float
        The reserve, which no plan uses.
    """

    capacity: float
    at_start: float
    least: float

    @classmethod
    def of(cls, robot: Robot) -> Energy | None:
        """Return the energy of a robot; None of one that usage does not empty."""
        battery = robot.battery
        return None if battery is None else cls(battery.capacity, battery.level_at_start, battery.least)


@dataclass(frozen=True)
class Refill:
    """The service of a station that adds energy.

    Parameters
    ----------
    rate : float, optional
        What a second adds; None: it takes `whole_s`, and fills at its end.
    whole_s : float
        How long a service without a rate takes.
    partial : bool
        Whether a service may end before the robot is full.
    """

    rate: float | None
    whole_s: float
    partial: bool

    @classmethod
    def of(cls, station: Station) -> Refill | None:
        """Return the service of a station; None of one that adds no energy."""
        if not station.gives_energy:
            return None
        return cls(station.charge_per_s, station.swap_s, station.charges and station.partial)

    def seconds(self, amount: float) -> float:
        """Return how long it takes to add an amount."""
        return self.whole_s if self.rate is None else amount / self.rate

    def added(self, seconds: float, *, ends: bool) -> float:
        """Return what some seconds of a service add; inf: all that there is room for; `ends`: they are its last."""
        if self.rate is not None:
            return seconds * self.rate
        return math.inf if ends else 0.0


@dataclass
class EnergyLevel:
    """What a robot holds now: it falls with usage, and is between 0 and the capacity.

    Parameters
    ----------
    capacity : float
        What the robot holds when it is full.
    level : float
        What it holds.
    counted : float, optional
        The robot's usage when the level was last lowered; None: not known before the first time.
    """

    capacity: float
    level: float
    counted: float | None = field(default=None, kw_only=True)

    @property
    def share(self) -> float:
        """What the robot holds as a share of its capacity."""
        return self.level / self.capacity

    def spend(self, used: float, drain: float = 1.0) -> float:
        """Lower the level by what has been used since the last time, `drain` times, and return that usage.

        `used` is the robot's usage so far.
        """
        more = 0.0 if self.counted is None else max(0.0, used - self.counted)
        self.counted, self.level = used, max(0.0, self.level - drain * more)
        return more

    def add(self, amount: float) -> None:
        """Add energy until the robot is full."""
        self.level = min(self.capacity, self.level + amount)


def levels_in_words(arrives: float, leaves: float, unit: str) -> str:
    """Return what a robot holds before and after a stop, as explanations say it."""
    return f"its battery holds {arrives:.2f} {unit} when it arrives and {leaves:.2f} {unit} when it leaves"
