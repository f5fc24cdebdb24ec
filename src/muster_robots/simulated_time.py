"""A simulator's clock (`/clock`) as one that never goes back."""

from __future__ import annotations

import threading
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
