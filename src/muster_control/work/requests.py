"""Reads a worker's requests in a separate thread, so that a stop reaches the running task.

A stop belongs to the request before it in the pipe and never reaches the next one.
"""

from __future__ import annotations

import threading
from collections.abc import Iterable, Iterator
from queue import SimpleQueue

from muster.allocation.stop import Stop
from muster_control.work.process import STOP

_STACK = 2**18  # of the reading thread; the limit of memory counts reserved address space
_Asked = tuple[bytes, Stop]


def requests(lines: Iterable[bytes]) -> Iterator[_Asked]:
    """Yield each request with the Stop that interrupts it, until the lines end."""
    asked: SimpleQueue[_Asked | None] = SimpleQueue()
    before = threading.stack_size(_STACK)
    threading.Thread(target=_read, args=(lines, asked), daemon=True).start()
    threading.stack_size(before)
    while (next_one := asked.get()) is not None:
        yield next_one


def _read(lines: Iterable[bytes], asked: SimpleQueue[_Asked | None]) -> None:
    stop = Stop()
    try:
        for line in lines:
            if line == STOP:
                stop.interrupt()
            else:
                stop = Stop()
                asked.put((line, stop))
    finally:  # also if a line does not fit into memory
        asked.put(None)
