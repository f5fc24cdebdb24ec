"""The log of runs, with the time that each write takes measured."""

from __future__ import annotations

import time
from collections.abc import Callable, Mapping, Sequence
from typing import Any

from muster.exchange.mission_control import Entry, Stretch
from muster.server.store.database import Database
from muster.server.store.log import LogTable


class TimedLog(LogTable):
    """A log whose `observe` receives the seconds of each `append`, also of one that failed."""

    def __init__(self, database: Database, observe: Callable[[float], None]) -> None:
        super().__init__(database)
        self._observe = observe

    def append(
        self,
        run: int,
        time_s: float,
        entries: Sequence[Entry],
        stretches: Sequence[Stretch] = (),
        bodies: Mapping[str, Any] | None = None,
    ) -> int:
        began = time.perf_counter()
        try:
            return super().append(run, time_s, entries, stretches, bodies)
        finally:
            self._observe(time.perf_counter() - began)
