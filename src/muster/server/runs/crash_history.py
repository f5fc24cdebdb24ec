"""How often a run's runners have died, and when that is too often."""

from __future__ import annotations

import time
from collections.abc import Callable

DEATHS, KILLS = 3, 30
"""How often in a row runners may die without getting further: by themselves, and by SIGKILL."""
_LONG_S = 60.0
"""Seconds of the wall clock after which a runner of real robots has got further."""


class Deaths:
    """Of one run, in a row: a runner that gets further begins a new one.

    A simulated world gets further by its own clock and log. The clock of real robots goes on whatever a runner does,
    and each of them plans again: there it counts how long it has lived.
    """

    def __init__(self, *, real: bool, clock: Callable[[], float] = time.monotonic) -> None:
        self.count = 0
        self._real, self._clock = real, clock
        self._furthest = (-1.0, -1)
        self._born_s = clock()

    def born(self) -> None:
        """A runner begins."""
        self._born_s = self._clock()

    def too_often(self, reached: tuple[float, int], *, killed: bool) -> bool:
        """Note that it has died at a time of the mission and an entry of the log; whether no other is to follow it."""
        lived_s = self._clock() - self._born_s
        further = lived_s >= _LONG_S if self._real else reached > self._furthest
        self._furthest = max(self._furthest, reached)
        self.count = 1 if further else self.count + 1
        return self.count >= (KILLS if killed else DEATHS)
