"""One runner a run of real robots: the next waits until the one before has told robots to stand, and ended.

Each run has a byte of one file (https://pubs.opengroup.org/onlinepubs/9799919799/functions/fcntl.html), so that nothing
is left of runs that are over. Such a lock ends with its process, however that ends.
"""

from __future__ import annotations

import fcntl
import os
import time
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from muster.mission.errors import NetworkError
from muster_control.contract import StoreError

_WITHIN_S = 30.0


@contextmanager
def alone(lock: Path, run: int) -> Iterator[None]:
    """As long as no other runner commands the robots of a run.

    Parameters
    ----------
    lock
        a file of this user, which is made if it is not there.

    Raises
    ------
    NetworkError
        if another does so for long.
    StoreError
        if the file cannot be opened, or its name leads to another.
    """
    descriptor = _opened(lock)
    try:
        _wait_for(descriptor, run)
        yield
    finally:
        os.close(descriptor)


def _opened(lock: Path) -> int:
    try:
        lock.parent.mkdir(mode=0o700, parents=True, exist_ok=True)
        return os.open(lock, os.O_RDWR | os.O_CREAT | os.O_NOFOLLOW | os.O_CLOEXEC, 0o600)
    except OSError as error:
        raise StoreError(f"{lock}: {error.strerror}; expected a file that can be written") from None


def _wait_for(descriptor: int, run: int) -> None:
    until = time.monotonic() + _WITHIN_S
    while True:
        try:
            fcntl.lockf(descriptor, fcntl.LOCK_EX | fcntl.LOCK_NB, 1, run)
            return
        except OSError:
            if time.monotonic() > until:
                raise NetworkError(
                    "another process still commands the robots of this run; expected it to end"
                ) from None
            time.sleep(0.1)
