"""The fleet's clock: seconds since its beginning, in pauses too."""

from __future__ import annotations

import threading
import time
from collections.abc import Callable


class Forward:
    """A clock that may stand still or jump back, such as a simulator's, as one that never goes back.

    Parameters
    ----------
    read
        its seconds; 0 until it has begun.
    """

    def __init__(self, read: Callable[[], float]) -> None:
        self._read = read
        self._lock = threading.Lock()
        self._last = 0.0
        self._gone_s = 0.0

    @property
    def has_begun(self) -> bool:
        return self._read() > 0

    def __call__(self) -> float:
        """Seconds since the first message; a jump back takes none of them."""
        with self._lock:
            said = self._read()
            if self._last > 0:
                self._gone_s += max(0.0, said - self._last)
            self._last = said
            return self._gone_s


class MissionClock:
    """Goes on by itself, also while the mission pauses, and never back.

    Parameters
    ----------
    now
        seconds of any clock that never goes back.
    """

    def __init__(self, now: Callable[[], float] = time.monotonic) -> None:
        self._now = now
        self._began = now()

    @property
    def time_s(self) -> float:
        return self._now() - self._began
