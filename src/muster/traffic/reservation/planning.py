"""Planning of traffic while robots go on by the plan before: in the mission's own time, or in a thread."""

from __future__ import annotations

import math
import time
from collections.abc import Callable
from concurrent.futures import Future, ThreadPoolExecutor
from dataclasses import dataclass, field
from typing import Protocol

from muster.traffic.journeys.travellers import PlannedMoves

PLANNING_S = 0.4
"""Seconds of a simulated mission from when a plan is asked for until it is there."""
_THREAD_S = 2.0
"""Seconds that planning in a thread is expected to take at most, on a slow machine."""
_ROUNDING_S = 1e-9

Planned = Callable[[], PlannedMoves]


class Planning(Protocol):
    """One plan at a time that is being made.

    Attributes
    ----------
    takes_s : float
        Seconds from when a plan is asked for until it is there, at most; robots go on for so long by the plan before.
    """

    takes_s: float

    def begin(self, plan: Planned, now: float) -> None:
        """Begin to make a plan, instead of any that is being made."""
        ...

    def result(self, now: float) -> PlannedMoves | None:
        """Return the plan, None where it is not there yet."""
        ...


@dataclass
class DelayedPlanning:
    """Planning whose plans are there after a fixed time of the mission, however long the machine works on them.

    The first plan is there at once: it is made before the mission begins.
    """

    takes_s: float = PLANNING_S
    _plan: PlannedMoves | None = None
    _ready_s: float = -math.inf

    def begin(self, plan: Planned, now: float) -> None:
        """See `Planning`."""
        self._ready_s = now if self._plan is None else now + self.takes_s
        self._plan = plan()

    def result(self, now: float) -> PlannedMoves | None:
        """See `Planning`."""
        return self._plan if now >= self._ready_s - _ROUNDING_S else None


@dataclass
class ThreadedPlanning:
    """Planning in a thread of its own, which ends when nobody refers to the planning any more.

    A plan that is asked for instead of another is begun when the thread has ended that one. Where the time of a mission
    goes faster than that of the machine, the plan is waited for when planning was to have ended.
    """

    takes_s: float = _THREAD_S
    clock: Callable[[], float] = time.monotonic
    _asked_s: tuple[float, float] = (-math.inf, -math.inf)  # by the mission's time, and by the clock
    _thread: ThreadPoolExecutor = field(default_factory=lambda: ThreadPoolExecutor(1, "traffic-planning"))
    _plan: Future[PlannedMoves] | None = None

    def begin(self, plan: Planned, now: float) -> None:
        """See `Planning`."""
        if self._plan is not None:
            self._plan.cancel()
        self._asked_s = now, self.clock()
        self._plan = self._thread.submit(plan)

    def result(self, now: float) -> PlannedMoves | None:
        """See `Planning`."""
        asked_s, clock_s = self._asked_s
        is_overdue = now - asked_s >= self.takes_s > self.clock() - clock_s
        return self._plan.result() if self._plan is not None and (is_overdue or self._plan.done()) else None
