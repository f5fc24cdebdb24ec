"""The energy of a robot along its route: what is drawn from its battery, and what stations add."""

from __future__ import annotations

import math
from typing import NamedTuple

from muster.mission.model import Battery, Station
from muster.verification.agreement import RELATIVE_TOLERANCE

_EXACT = 1e-9


class Energy(NamedTuple):
    """What a battery holds at a stop, in the unit of usage.

    `drawn` is what was drawn since the battery was last full, or since the start, up to a charge here: by lengths that
    are off, levels are off by a share of that.
    """

    arrives: float
    leaves: float
    drawn: float


class Charge(NamedTuple):
    """What a station adds to a battery, in the unit of usage; how long that takes; and what is wrong with it."""

    amount: float
    seconds: float
    fault: str | None = None


NO_CHARGE = Charge(0.0, 0.0)


class Gauge:
    """The level of one battery, from the start of a route on.

    A level below 0 is kept, so that it can be said how much is missing. Stations fill from 0 at least.
    """

    def __init__(self, battery: Battery) -> None:
        self._battery = battery
        self.level = battery.level_at_start
        self._drawn = 0.0

    def draw(self, usage: float) -> None:
        """Take usage from the battery."""
        self.level -= usage
        self._drawn += usage

    @property
    def now(self) -> Energy:
        """What the battery holds at this moment."""
        return Energy(self.level, self.level, self._drawn)

    def visit(self, station: Station, stated: float | None, tolerance: float) -> Charge:
        """Charge or swap at a station; `stated` is the amount that the plan says.

        An amount that is none, or that leaves a battery not full that has to be, is a fault, and so is one beyond the
        capacity. What can be added of it is added.

        Parameters
        ----------
        tolerance
            of the lengths of legs, relative.
        """
        room = self._battery.capacity - max(0.0, self.level)
        slack = max(RELATIVE_TOLERANCE * self._battery.capacity, max(_EXACT, tolerance) * self._drawn)
        amount, fault = (room, None) if stated is None else self._stated(station, stated, room, slack)
        if station.swaps:
            amount = room
        self._fill(amount, room)
        return Charge(amount, station.swap_s if station.swaps else amount / (station.charge_per_s or math.inf), fault)

    def _stated(self, station: Station, stated: float, room: float, slack: float) -> tuple[float, str | None]:
        """The amount of a stated charge, and what is wrong with it."""
        capacity = self._battery.capacity
        if not 0 <= stated < math.inf:
            return 0.0, f"charges {stated:.10g} at {station.id}; expected a finite amount of at least 0"
        amount = min(stated, capacity)
        if stated > room + slack:
            return amount, f"charges {stated:.10g} at {station.id}, where its battery takes {room:.10g}"
        fills = station.swaps or not station.partial
        if fills and stated < room - slack:
            way = "a swap" if station.swaps else "a charge"
            return amount, f"charges {stated:.10g} at {station.id}, where {way} always fills: {room:.10g}"
        return amount, None

    def _fill(self, amount: float, room: float) -> None:
        if amount >= room:
            self.level, self._drawn = self._battery.capacity, 0.0
        else:
            self.level = max(0.0, self.level) + amount


def slack_of(energy: Energy, battery: Battery, tolerance: float) -> float:
    """By how much a level may be too low because of rounding, and of lengths that are off by a tolerance."""
    return _EXACT * battery.capacity + max(_EXACT, tolerance) * energy.drawn
