"""Processor time of this process, by which solvers are stopped: other programs on the machine do not shorten a run."""

from __future__ import annotations

import time


class ProcessorStop:
    """Due when so many seconds of processor time are used. PyVRP calls it with the cost of its best plan."""

    def __init__(self, seconds: float) -> None:
        self._end = time.process_time() + seconds

    def due(self) -> bool:
        return time.process_time() >= self._end

    def __call__(self, best_cost: int) -> bool:
        return self.due()
