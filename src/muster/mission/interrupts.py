"""Ctrl-C where it must not end a program at once."""

from __future__ import annotations

import signal
from collections.abc import Callable, Iterator
from contextlib import contextmanager


@contextmanager
def on_ctrl_c(do: Callable[[], None]) -> Iterator[None]:
    """Do something at Ctrl-C, in place of KeyboardInterrupt; to be used in the main thread."""
    before = signal.signal(signal.SIGINT, lambda signum, frame: do())
    try:
        yield
    finally:
        signal.signal(signal.SIGINT, before)


@contextmanager
def ctrl_c_held_back() -> Iterator[None]:
    """Keep Ctrl-C for later. Processes started here never see it, not even before their first line of Python."""
    before = signal.pthread_sigmask(signal.SIG_BLOCK, {signal.SIGINT})
    try:
        yield
    finally:
        signal.pthread_sigmask(signal.SIG_SETMASK, before)
