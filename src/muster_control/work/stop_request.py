"""A request to end a task with its best result so far."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import contextmanager


class StopRequest:
    """A request to end a task early, before or after it has begun; not safe for threads."""

    def __init__(self) -> None:
        self._times = 0
        self._tell: Callable[[], None] | None = None

    def ask(self) -> None:
        """Request the end; a second call also skips what would still take long."""
        self._times += 1
        if self._tell is not None:
            self._tell()

    @contextmanager
    def reaching(self, tell: Callable[[], None]) -> Iterator[None]:
        """Call `tell` for each request within the block, and for those made before it."""
        for _ in range(self._times):
            tell()
        self._tell = tell
        try:
            yield
        finally:
            self._tell = None
