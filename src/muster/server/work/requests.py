"""What a worker is asked, read beside its work, so that a wish to stop reaches what is under way.

A stop is meant for the request before it in the pipe, which keeps their order: it never reaches the next one.
"""

from __future__ import annotations

import threading
from collections.abc import Iterable, Iterator
from queue import SimpleQueue

from muster.allocation.stop import Stop
from muster.server.work.process import STOP

_STACK = 2**18  # of the reading thread, which does little; the memory of a worker counts what is reserved
_Asked = tuple[bytes, Stop]


def requests(lines: Iterable[bytes]) -> Iterator[_Asked]:
    """Each request in turn, until there are no more lines, with what interrupts it when that is wished."""
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
    finally:  # also where a line does not fit into the memory
        asked.put(None)
