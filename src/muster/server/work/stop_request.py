"""A wish that a piece of work ends with what it has."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import contextmanager


class StopRequest:
    """Asks a piece of work to end with the best that it has, whether it has begun or not; not safe for threads."""

    def __init__(self) -> None:
        self._times = 0
        self._tell: Callable[[], None] | None = None

    def ask(self) -> None:
        """Ask it; a second time: also to leave out what would still take long."""
        self._times += 1
        if self._tell is not None:
            self._tell()

    @contextmanager
    def reaching(self, tell: Callable[[], None]) -> Iterator[None]:
        """Within, each asking is told to whoever does the work, those before it included."""
        for _ in range(self._times):
            tell()
        self._tell = tell
        try:
            yield
        finally:
            self._tell = None
