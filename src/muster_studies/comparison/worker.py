"""A process that does jobs for another, which gives them through a pipe (`workers`)."""

from __future__ import annotations

import os
import pickle
import sys
import threading
from contextlib import suppress
from multiprocessing.connection import Connection
from typing import Any

from muster_studies.comparison.workers import Lost, Raised


def main(link_fd: int, lifeline_fd: int) -> None:
    """Do jobs until there are no more, or the other process has ended."""
    threading.Thread(target=_end_with_parent, args=(lifeline_fd,), daemon=True).start()
    link: Connection[Any, Any] = Connection(link_fd)
    try:
        do = pickle.loads(link.recv_bytes())  # noqa: S301  (of the process that began this one)
    except Exception as error:
        do = _raising(error)
    with suppress(EOFError, BrokenPipeError, ConnectionResetError):  # the other process has ended, or has no more jobs
        link.send_bytes(b"ready")
        while True:
            _answer(link, _done(do, link.recv()))


def _done(do: Any, job: Any) -> Any:
    try:
        return do(job)
    except Exception as error:
        return Raised(error)
    except BaseException as error:  # of the job: Ctrl-C does not come to this process, and nothing else ends it
        return Lost(_line(error))


def _answer(link: Connection[Any, Any], answer: Any) -> None:
    try:
        data = pickle.dumps(answer)
    except Exception as error:
        said = answer.error if isinstance(answer, Raised) else error
        data = pickle.dumps(Raised(RuntimeError(f"{type(said).__name__}: {said}")))
    link.send_bytes(data)


def _line(error: BaseException) -> str:
    said = " ".join(str(error).split())
    return f"{type(error).__name__}: {said}" if said else type(error).__name__


def _raising(error: Exception) -> Any:
    from muster.mission.errors import MusterError

    def do(job: Any) -> Any:
        raise MusterError(f"what is to be done cannot be loaded in another process: {type(error).__name__}: {error}")

    return do


def _end_with_parent(lifeline_fd: int) -> None:
    """End this process when the other end of the pipe is closed: when the other process has ended, however it did."""
    os.read(lifeline_fd, 1)
    os._exit(1)


if __name__ == "__main__":
    main(int(sys.argv[1]), int(sys.argv[2]))
