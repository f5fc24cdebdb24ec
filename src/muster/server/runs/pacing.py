"""When a mission's clock goes on: as fast as the wall clock times a speed, or as fast as it can."""

from __future__ import annotations

from muster.mission.clock import Clock

_LATE_S = 5.0
"""Seconds by which it may be late and still makes up for it."""


class Pace:
    """The wall clock's time at which each moment of a mission is due.

    Parameters
    ----------
    speed
        how many times as fast as the wall clock; None: as fast as it goes.
    now_s
        the mission's clock.
    """

    def __init__(self, clock: Clock, speed: float | None, now_s: float) -> None:
        self._clock = clock
        self.set(speed, now_s)

    def set(self, speed: float | None, now_s: float) -> None:
        """From now on go at another speed, or on after a pause."""
        self.speed = speed
        self._begun, self._begun_s = self._clock.now(), now_s

    def wait_s(self, until_s: float) -> float:
        """Seconds of the wall clock until a moment of the mission is due; what was lost beyond a while stays lost."""
        if self.speed is None:
            return 0.0
        wait = self._begun + (until_s - self._begun_s) / self.speed - self._clock.now()
        if wait < -_LATE_S:
            self.set(self.speed, until_s)
        return max(0.0, wait)
