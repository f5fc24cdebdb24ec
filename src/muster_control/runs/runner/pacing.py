"""The pace of a mission's clock: the wall clock times a speed, or as fast as possible."""

from __future__ import annotations

from muster.mission.system.clock import Clock

_LATE_S = 5.0
"""Seconds by which it may be late and still makes up for it."""


class Pace:
    """The wall clock's time at which each moment of a mission is due.

    Parameters
    ----------
    speed
        times the wall clock; None: as fast as possible.
    now_s
        the mission's clock.
    """

    def __init__(self, clock: Clock, speed: float | None, now_s: float) -> None:
        self._clock = clock
        self.set(speed, now_s)

    def set(self, speed: float | None, now_s: float) -> None:
        """Set the speed, or continue after a pause."""
        self.speed = speed
        self._begun, self._begun_s = self._clock.now(), now_s

    def wait_s(self, until_s: float) -> float:
        """Seconds of the wall clock until a mission time is due; a delay beyond a limit is not made up for."""
        if self.speed is None:
            return 0.0
        wait = self._begun + (until_s - self._begun_s) / self.speed - self._clock.now()
        if wait < -_LATE_S:
            self.set(self.speed, until_s)
        return max(0.0, wait)
