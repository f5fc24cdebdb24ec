"""Ctrl-C as a wish to stop, not as an exception."""

from __future__ import annotations

import signal
import threading
from collections.abc import Iterator
from contextlib import contextmanager
from types import FrameType


@contextmanager
def ctrl_c_halts() -> Iterator[threading.Event]:
    """The event that the first Ctrl-C sets; the second ends everything."""
    halt = threading.Event()

    def interrupt(signum: int, frame: FrameType | None) -> None:
        if halt.is_set():
            raise KeyboardInterrupt
        halt.set()

    before = signal.signal(signal.SIGINT, interrupt)
    try:
        yield halt
    finally:
        signal.signal(signal.SIGINT, before)
