"""The mission's clock: seconds since its beginning, without pauses."""

from __future__ import annotations

import threading
import time
from collections.abc import Callable


class MissionClock:
    """Goes on by itself, and never back.

    Parameters
    ----------
    now
        seconds of any clock that never goes back.
    """

    def __init__(self, now: Callable[[], float] = time.monotonic) -> None:
        self._now = now
        self._lock = threading.Lock()
        self._began = now()
        self._stopped: float | None = None

    @property
    def time_s(self) -> float:
        with self._lock:
            return (self._now() if self._stopped is None else self._stopped) - self._began

    @property
    def unpaused_s(self) -> float:
        """Seconds that go on in pauses too, to monitor robots then."""
        return self._now()

    @property
    def paused(self) -> bool:
        return self._stopped is not None

    def pause(self) -> None:
        """Stand still from now on."""
        with self._lock:
            if self._stopped is None:
                self._stopped = self._now()

    def resume(self) -> None:
        """Go on as if no time had gone by."""
        with self._lock:
            if self._stopped is not None:
                self._began += self._now() - self._stopped
                self._stopped = None
