"""One runner a run of real robots: the next waits until the one before has told robots to stand, and ended."""

from __future__ import annotations

import fcntl
import time
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from muster.mission.errors import NetworkError

_WITHIN_S = 30.0


@contextmanager
def alone(lock: str) -> Iterator[None]:
    """As long as no other runner commands the robots of a run.

    Raises
    ------
    NetworkError
        if another does so for long.
    """
    until = time.monotonic() + _WITHIN_S
    with Path(lock).open("w") as file:
        while True:
            try:
                fcntl.flock(file, fcntl.LOCK_EX | fcntl.LOCK_NB)
                break
            except OSError:
                if time.monotonic() > until:
                    raise NetworkError(
                        "another process still commands the robots of this run; expected it to end"
                    ) from None
                time.sleep(0.1)
        yield
