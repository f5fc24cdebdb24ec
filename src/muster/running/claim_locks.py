"""Claims on real robots between processes: two runs of this machine never command the same ones.

A claim names robots in words, such as `UDP port 14550`. Each has a byte of one file of the user, which the process that
commands them locks (https://pubs.opengroup.org/onlinepubs/9799919799/functions/fcntl.html): a lock ends with its
process, however that ends. Runs of other users and other machines are not known here.
"""

from __future__ import annotations

import os
import time
from collections.abc import Collection, Iterator
from contextlib import contextmanager, suppress
from hashlib import sha256

from muster.mission.errors import MusterError, ParameterError
from muster.mission.system.platforms import data_folder

_POLL_S = 0.1


@contextmanager
def robots_claimed(claims: Collection[str], wait_s: float = 0.0) -> Iterator[None]:
    """Hold claims while the block runs.

    Parameters
    ----------
    claims : collection of str
        What is claimed.
    wait_s : float
        Seconds to wait for another process that ends.

    Raises
    ------
    ParameterError
        If another process holds one of them.
    MusterError
        If the file of claims cannot be opened.
    """
    try:
        import fcntl
    except ImportError:  # not a POSIX system: no bridge but MAVLink's runs here, and a port of UDP has one owner
        yield
        return
    file = data_folder() / "robots.lock"
    try:
        file.parent.mkdir(mode=0o700, parents=True, exist_ok=True)
        descriptor = os.open(file, os.O_RDWR | os.O_CREAT | os.O_NOFOLLOW | os.O_CLOEXEC, 0o600)
    except OSError as error:
        expected = "a file that can be written: by it other runs know which robots are taken"
        raise MusterError(f"{file}: {error.strerror}; expected {expected}") from None
    try:
        until = time.monotonic() + wait_s
        for claim in sorted(claims):
            while True:
                with suppress(OSError):
                    fcntl.lockf(descriptor, fcntl.LOCK_EX | fcntl.LOCK_NB, 1, _place(claim))
                    break
                if time.monotonic() >= until:
                    raise ParameterError(
                        f"{claim}: another run on this machine commands its robots; expected others, or that it is over"
                    )
                time.sleep(_POLL_S)
        yield
    finally:
        os.close(descriptor)


def _place(claim: str) -> int:
    """The byte of a claim in the file, which stays empty."""
    return int.from_bytes(sha256(claim.encode()).digest()[:6], "big")
