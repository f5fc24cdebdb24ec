"""Clocks. Time is passed in: no logic in Muster reads the wall clock."""

from __future__ import annotations

import time
from typing import Protocol

TIME_ROUNDING_S = 1e-6
"""By which a time may be past a limit: clocks add up steps."""


class Clock(Protocol):
    """Seconds from some fixed moment, never going back."""

    def now(self) -> float: ...


class SystemClock:
    """The machine's monotonic clock."""

    def now(self) -> float:
        return time.perf_counter()


class WallClock:
    """The time of day: seconds since 1970. It goes back where somebody sets it back."""

    def now(self) -> float:
        return time.time()


class ProcessorClock:
    """The processor time of this process, of all its threads: what else the machine does takes nothing from a limit."""

    def now(self) -> float:
        return time.process_time()


class VirtualClock:
    """A clock that goes on only when told to; `step_s` is added at each reading."""

    def __init__(self, start_s: float = 0.0, step_s: float = 0.0) -> None:
        self._now = start_s
        self._step = step_s

    def now(self) -> float:
        now = self._now
        self._now += self._step
        return now

    def advance(self, by_s: float) -> None:
        self._now += by_s
