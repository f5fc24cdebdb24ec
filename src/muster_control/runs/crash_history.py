"""Counts crashes of a run's runners, and decides when to give up."""

from __future__ import annotations

import time
from collections.abc import Callable

MOST_CRASHES, MOST_KILLS = 3, 30
"""How many runners may end in a row without progress: by themselves, and by SIGKILL."""
_LONG_S = 60.0
"""Seconds of the wall clock after which a runner of real robots counts as progress."""


class CrashHistory:
    """The crashes of one run without progress between them.

    The progress of a simulated world is its clock. The clock of real robots always advances, so there the time
    that a runner has lived counts.
    """

    def __init__(self, *, real: bool, clock: Callable[[], float] = time.monotonic) -> None:
        self.count = 0
        self._real, self._clock = real, clock
        self._furthest_s = -1.0
        self._born_s = clock()

    def started(self) -> None:
        """Note that a runner starts."""
        self._born_s = self._clock()

    def too_often(self, reached_s: float, *, killed: bool) -> bool:
        """Note that a runner has ended at a mission time; returns whether to give up."""
        lived_s = self._clock() - self._born_s
        further = lived_s >= _LONG_S if self._real else reached_s > self._furthest_s
        self._furthest_s = max(self._furthest_s, reached_s)
        self.count = 1 if further else self.count + 1
        return self.count >= (MOST_KILLS if killed else MOST_CRASHES)
