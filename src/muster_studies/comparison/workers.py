"""Jobs spread over processes of their own, each a fresh interpreter.

A fresh interpreter has none of the threads and locks of this one, and does not run the program that began it again; a
process that is lost costs its job alone. What it is to do is sent to it: functions of a notebook or script need
cloudpickle.
"""

from __future__ import annotations

import contextlib
import math
import os
import subprocess
import sys
import time
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from multiprocessing import Pipe
from multiprocessing.connection import Connection, wait
from pathlib import Path
from types import TracebackType
from typing import Any, Generic, TypeVar

from muster.mission.errors import MusterError
from muster_studies.comparison.by_value import packed

Job = TypeVar("Job")
Found = TypeVar("Found")

_MODULE = "muster_studies.comparison.worker"
_ENDING_S = 5.0
"""A process that has closed its pipe ends by itself in less."""
_ONE_THREAD = dict.fromkeys(("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS"), "1")


@dataclass(frozen=True)
class Lost:
    """A job that came to nothing, because its process ended, was given up or would have been left; and why."""

    reason: str


@dataclass(frozen=True)
class Raised:
    """What a job raised."""

    error: BaseException


def in_processes(
    do: Callable[[Job], Found], jobs: Sequence[Job], workers: int, give_up_s: float | None = None
) -> Iterator[tuple[Job, Found | Lost]]:
    """Do jobs in so many processes; each is given out as it is done. What a job raises is raised.

    Parameters
    ----------
    do
        what is done with each job; it is sent once to each process.
    give_up_s
        a job is given up, with its process, after so many seconds.

    Raises
    ------
    ParameterError, MissingExtraError
        if `do` cannot be sent.
    """
    payload, left = packed(do), list(reversed(jobs))
    with contextlib.ExitStack() as stack:
        idle = [stack.enter_context(_Worker[Job](payload, give_up_s)) for _ in range(min(workers, len(jobs)))]
        busy: dict[Connection[Any, Any], _Worker[Job]] = {}
        while left or busy:
            while left and idle:
                worker = idle.pop()
                busy[worker.begin(left.pop())] = worker
            for link in _settled(busy):
                if busy[link].has_begun():
                    continue
                worker = busy.pop(link)
                job, found = worker.end()
                if isinstance(found, Raised):
                    raise found.error
                yield job, found
                idle.append(worker)


def _settled(busy: dict[Connection[Any, Any], _Worker[Job]]) -> list[Connection[Any, Any]]:
    """The links of workers that say something, are lost or over their time; one at least."""
    while True:
        until = min(worker.until for worker in busy.values())
        ready = wait(list(busy), None if until == math.inf else max(0.0, until - time.monotonic()))
        now = time.monotonic()
        settled = [link for link, worker in busy.items() if link in ready or worker.until <= now]
        if settled:
            return settled


class _Worker(Generic[Job]):
    """A process for one job after the other; a new one after it is lost."""

    def __init__(self, payload: bytes, give_up_s: float | None) -> None:
        self._payload, self._give_up_s = payload, math.inf if give_up_s is None else give_up_s
        self._process: subprocess.Popen[bytes] | None = None
        self._job: Job | None = None
        self._ready = False
        self.until = math.inf

    def __enter__(self) -> _Worker[Job]:
        self._start()
        return self

    def __exit__(self, kind: type[BaseException] | None, error: BaseException | None, at: TracebackType | None) -> None:
        self._stop()

    def begin(self, job: Job) -> Connection[Any, Any]:
        """Give it a job; returns the link on which it answers."""
        if self._process is None:
            self._start()
        self._job = job
        self.until = time.monotonic() + self._give_up_s if self._ready else math.inf
        with contextlib.suppress(BrokenPipeError, ConnectionResetError):  # then its end says so
            self._link.send(job)
        return self._link

    def has_begun(self) -> bool:
        """Whether all that it says is that it has started, and begins with its job now."""
        if self._ready or not self._link.poll():
            return False
        try:
            self._link.recv_bytes()
        except (EOFError, OSError):
            return False
        self._ready, self.until = True, time.monotonic() + self._give_up_s
        return True

    def end(self) -> tuple[Job, Any]:
        """The job and what came of it."""
        job = self._job
        assert job is not None
        if not self._link.poll() and time.monotonic() >= self.until:
            self._stop()
            return job, Lost(f"given up after {self._give_up_s:g} s")
        try:
            return job, self._link.recv()
        except (EOFError, OSError):
            return job, Lost(f"its process ended: {self._stop(_ENDING_S)}")
        except Exception as error:  # what an answer holds may not be there in this process
            return job, Lost(f"its answer cannot be read: {type(error).__name__}: {error}")

    def _start(self) -> None:
        self._link, theirs = Pipe()
        lifeline, self._lifeline = os.pipe()
        # What is printed goes to standard error: standard output is for data. Ctrl-C is for this process alone.
        self._process = subprocess.Popen(
            [sys.executable, "-m", _MODULE, str(theirs.fileno()), str(lifeline)],
            stdin=subprocess.DEVNULL,
            stdout=2,
            pass_fds=(theirs.fileno(), lifeline),
            env={
                **os.environ,
                **_ONE_THREAD,
                "PYTHONPATH": os.pathsep.join(path or str(Path.cwd()) for path in sys.path),
            },
            start_new_session=True,
        )
        theirs.close()
        os.close(lifeline)
        with contextlib.suppress(BrokenPipeError, ConnectionResetError):
            self._link.send_bytes(self._payload)

    def _stop(self, grace_s: float = 0.0) -> str:
        """End the process, if it does not end by itself in so many seconds; how it ended."""
        if self._process is None:
            return ""
        with contextlib.suppress(subprocess.TimeoutExpired):
            self._process.wait(grace_s)
        self._process.kill()
        code = self._process.wait()
        self._process, self._ready = None, False
        self._link.close()
        os.close(self._lifeline)
        return f"signal {-code}" if code < 0 else f"exit code {code}"


def require_done(found: Found | Lost, job: object) -> Found:
    """What came of a job that must not be lost.

    Raises
    ------
    MusterError
    """
    if isinstance(found, Lost):
        raise MusterError(f"{job}: {found.reason}")
    return found
