"""A worker seen from the server: a process with its own group and folder, which answers requests one by one."""

from __future__ import annotations

import asyncio
import json
import logging
import os
import shutil
import signal
import sys
import tempfile
from collections import deque
from collections.abc import AsyncIterator, Callable, Mapping, Sequence
from contextlib import suppress
from functools import partial
from pathlib import Path
from typing import Any

from muster.mission.errors import Finding
from muster_control.work.environment import without_secrets
from muster_control.work.errors import OutOfMemory, WorkerDied, WorkError
from muster_control.work.stop_request import StopRequest

PROGRAM = (sys.executable, "-P", "-m", "muster_control.work.worker")
STOP = b'{"stop": true}\n'
"""What asks a worker to end the piece of work under way with what it has."""
_PIECE = 2**16
_LAST_WORDS = 20  # lines of standard error that are kept for the log
_ONE_THREAD = dict.fromkeys(("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS"), "1")
_FEW_ARENAS = {"MALLOC_ARENA_MAX": "2"}  # each arena reserves address space

Progress = Callable[[dict[str, Any]], None]

_log = logging.getLogger(__name__)


class Worker:
    """A worker process, started by `start`.

    Attributes
    ----------
    alive
        whether it takes requests: it runs, has answered all requests, and has not used too much memory.
    gone
        set when the process has ended and its folder is removed.
    """

    def __init__(self, process: asyncio.subprocess.Process, folder: Path, memory_mb: int) -> None:
        self._process = process
        self._folder = folder
        self._memory_mb = memory_mb
        self._last_words: deque[str] = deque(maxlen=_LAST_WORDS)
        self._hearing = asyncio.create_task(self._hear())
        self._lines = self._answers()
        self._spent = False
        self.gone = asyncio.Event()

    @classmethod
    async def start(cls, program: Sequence[str], folder: Path, memory_mb: int) -> Worker:
        """Start a process with `memory_mb`, and a folder within `folder` for temporary files."""
        own = Path(tempfile.mkdtemp(prefix="worker-", dir=folder))
        process = await asyncio.create_subprocess_exec(
            *program,
            str(memory_mb),
            str(os.getpid()),
            stdin=asyncio.subprocess.PIPE,
            stdout=asyncio.subprocess.PIPE,
            stderr=asyncio.subprocess.PIPE,
            cwd=own,
            env={**without_secrets(os.environ), **_ONE_THREAD, **_FEW_ARENAS, "TMPDIR": str(own)},
            start_new_session=True,
        )
        return cls(process, own, memory_mb)

    @property
    def pid(self) -> int:
        return self._process.pid

    @property
    def alive(self) -> bool:
        return self._process.returncode is None and not self._spent

    async def ask(
        self, task: str, arguments: Mapping[str, Any], on_progress: Progress | None, stop_request: StopRequest
    ) -> dict[str, Any]:
        """Run a task, which `stop_request` ends early.

        Raises
        ------
        WorkError
            OutOfMemory, WorkerDied, or an error of the arguments.
        """
        assert self._process.stdin is not None
        self._spent = True  # until it has answered
        request = json.dumps({"task": task, "arguments": arguments}).encode() + b"\n"
        with suppress(BrokenPipeError, ConnectionResetError):  # its last messages are still read
            self._process.stdin.write(request)
            await self._process.stdin.drain()
        with stop_request.reaching(partial(self._process.stdin.write, STOP)):
            return await self._answer(on_progress)

    async def _answer(self, on_progress: Progress | None) -> dict[str, Any]:
        async for message in self._lines:
            if "progress" in message:
                if on_progress is not None:
                    on_progress(message["progress"])
                continue
            self._spent = message["spent"]
            if "failed" in message:
                raise self._error(**message["failed"])
            done: dict[str, Any] = message["done"]
            return done
        raise await self._died()

    async def _answers(self) -> AsyncIterator[dict[str, Any]]:
        """The messages of the process; a line may be of any length."""
        assert self._process.stdout is not None
        pieces: list[bytes] = []
        while piece := await self._process.stdout.read(_PIECE):
            *ends, rest = piece.split(b"\n")
            for end in ends:
                yield json.loads(b"".join([*pieces, end]))
                pieces = []
            pieces.append(rest)

    async def _hear(self) -> None:
        """Keep the last lines of standard error, for the log."""
        assert self._process.stderr is not None
        rest = b""
        while piece := await self._process.stderr.read(_PIECE):
            *lines, rest = (rest + piece)[-_PIECE:].split(b"\n")
            for line in lines:
                self._last_words.append(line.decode("utf-8", "replace"))
                _log.debug("worker %d: %s", self.pid, self._last_words[-1])

    def _error(self, kind: str, error: str, findings: Sequence[Mapping[str, Any]]) -> WorkError:
        if kind == "memory":
            self._spent = True
            return self._out_of_memory()
        if kind == "internal":
            _log.error("worker %d: %s\n%s", self.pid, error, "\n".join(self._last_words))
        return WorkError(error, [Finding(**finding) for finding in findings])

    def _out_of_memory(self) -> OutOfMemory:
        return OutOfMemory(f"it needs more than {self._memory_mb} MB of memory; expected less of it, or a higher limit")

    async def _died(self) -> WorkError:
        await self._hearing
        code = await self._process.wait()
        said = "\n".join(self._last_words)
        if "bad_alloc" in said or "MemoryError" in said:
            return self._out_of_memory()
        how = signal.Signals(-code).name if code < 0 else f"code {code}"
        _log.error("worker %d ended with %s\n%s", self.pid, how, said)
        return WorkerDied(f"the process that worked on it ended with {how}")

    def kill(self) -> None:
        """Kill the process and its children."""
        self._spent = True
        if self._process.returncode is None:
            with suppress(ProcessLookupError):
                os.killpg(self.pid, signal.SIGKILL)

    async def see_off(self) -> None:
        """Wait until the process has ended, and remove its folder; call it after the last request."""
        assert self._process.stdin is not None
        assert self._process.stdout is not None
        self._process.stdin.close()
        while await self._process.stdout.read(_PIECE):
            pass  # a pipe is closed only after it was read to its end
        await self._process.wait()
        await self._hearing
        await asyncio.to_thread(shutil.rmtree, self._folder, ignore_errors=True)
        self.gone.set()
