"""Handling of Ctrl-C and other signals to end, where a program must not end at once."""

from __future__ import annotations

import signal
import threading
from collections.abc import Callable, Iterable, Iterator
from contextlib import contextmanager

CTRL_C = (signal.SIGINT,)
TO_END = tuple(getattr(signal, name) for name in ("SIGINT", "SIGTERM", "SIGHUP") if hasattr(signal, name))
"""What a terminal that is closed, a service manager and a container send, too."""


@contextmanager
def on_ctrl_c(do: Callable[[], None], signals: Iterable[signal.Signals] = CTRL_C) -> Iterator[None]:
    """Do something at Ctrl-C, in place of KeyboardInterrupt; to be used in the main thread."""
    before = {number: signal.signal(number, lambda signum, frame: do()) for number in signals}
    try:
        yield
    finally:
        for number, handler in before.items():
            signal.signal(number, handler)


@contextmanager
def ctrl_c_halts(signals: Iterable[signal.Signals] = CTRL_C) -> Iterator[threading.Event]:
    """The event that the first Ctrl-C sets, or another of these signals; the second raises KeyboardInterrupt."""
    halt = threading.Event()

    def interrupt() -> None:
        if halt.is_set():
            raise KeyboardInterrupt
        halt.set()

    with on_ctrl_c(interrupt, signals):
        yield halt


@contextmanager
def signals_interrupt() -> Iterator[None]:
    """Raise KeyboardInterrupt at each of `TO_END`: what is to be said at Ctrl-C is said at the others, too."""

    def interrupt() -> None:
        raise KeyboardInterrupt

    with on_ctrl_c(interrupt, TO_END):
        yield


@contextmanager
def ctrl_c_held_back() -> Iterator[None]:
    """Keep Ctrl-C for later. Processes started here never see it, not even before their first line of Python.

    Windows has no signals that can be kept: there they see it.
    """
    if not hasattr(signal, "pthread_sigmask"):
        yield
        return
    before = signal.pthread_sigmask(signal.SIG_BLOCK, {signal.SIGINT})
    try:
        yield
    finally:
        signal.pthread_sigmask(signal.SIG_SETMASK, before)
