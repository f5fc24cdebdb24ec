"""Ctrl-C as a wish to stop, not as an exception."""

from __future__ import annotations

import signal
import threading
from collections.abc import Iterable, Iterator
from contextlib import contextmanager

from muster.mission.interrupts import CTRL_C, on_ctrl_c


@contextmanager
def ctrl_c_halts(signals: Iterable[signal.Signals] = CTRL_C) -> Iterator[threading.Event]:
    """The event that the first Ctrl-C sets, or another of these signals; the second ends everything."""
    halt = threading.Event()

    def interrupt() -> None:
        if halt.is_set():
            raise KeyboardInterrupt
        halt.set()

    with on_ctrl_c(interrupt, signals):
        yield halt
