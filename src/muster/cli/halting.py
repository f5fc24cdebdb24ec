"""Ctrl-C as a wish to stop, not as an exception."""

from __future__ import annotations

import threading
from collections.abc import Iterator
from contextlib import contextmanager

from muster.mission.interrupts import on_ctrl_c


@contextmanager
def ctrl_c_halts() -> Iterator[threading.Event]:
    """The event that the first Ctrl-C sets; the second ends everything."""
    halt = threading.Event()

    def interrupt() -> None:
        if halt.is_set():
            raise KeyboardInterrupt
        halt.set()

    with on_ctrl_c(interrupt):
        yield halt
