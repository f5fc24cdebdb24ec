"""The workers of a server: started on demand, reused, and limited in number."""

from __future__ import annotations

import asyncio
import os
import shutil
import tempfile
from collections.abc import AsyncIterator, Callable, Mapping, Sequence
from contextlib import asynccontextmanager
from pathlib import Path
from typing import Any

from muster_control.work.errors import TimedOut, WorkError
from muster_control.work.process import PROGRAM, Progress, Worker
from muster_control.work.stop_request import StopRequest
from muster_control.work.tasks import TASKS, Task
from muster_control.work.temporary_folders import OF_WORK, sweep
from muster_control.work.turns import CURRENT_USER, Turns

MOST_WAITING, MOST_WAITING_OF_ONE = 64, 24
"""Short tasks that may wait, in all and of one user; their arguments are held in memory."""
_ANY = Task("", limit_s=None)

Arguments = Mapping[str, Any] | Callable[[], Mapping[str, Any]]


class Pool:
    """Gives tasks to worker processes; users take turns.

    Long tasks (plans) and short tasks (checks, explanations) have separate places.

    Parameters
    ----------
    workers
        the most processes with long tasks; as many more do short tasks of one user, and one more those of others.
    memory_mb
        the memory of each process.
    idle_s
        seconds after which an idle process ends.
    program
        the command of a process; its arguments are the memory and the id of this process.
    """

    def __init__(self, *, workers: int, memory_mb: int, idle_s: float = 60.0, program: Sequence[str] = PROGRAM) -> None:
        self._memory_mb = memory_mb
        self._idle_s = idle_s
        self._program = program
        short = Turns(workers + 1, workers, waiting=MOST_WAITING, waiting_of_one=MOST_WAITING_OF_ONE)
        self._turns = {False: short, True: Turns(workers, workers)}
        self._idle: list[Worker] = []
        self._alarms: dict[Worker, asyncio.TimerHandle] = {}
        self._workers: set[Worker] = set()
        self._leaving: set[asyncio.Task[None]] = set()
        self._closed = False
        self._folder: Path | None = None

    @property
    def busy(self) -> int:
        """How many tasks are running."""
        return sum(turns.taken for turns in self._turns.values())

    @property
    def waiting(self) -> int:
        """How many tasks wait for their turn."""
        return sum(turns.waiting for turns in self._turns.values())

    async def run(
        self,
        task: str,
        arguments: Arguments,
        *,
        on_progress: Progress | None = None,
        limit_s: float | None = None,
        stop_request: StopRequest | None = None,
        user: str | None = None,
    ) -> dict[str, Any]:
        """Run a task in a worker; cancelling the caller kills the worker.

        Parameters
        ----------
        task
            one of TASKS.
        arguments
            plain data; or a function that reads them in a thread at the task's turn, so that nothing large waits.
        on_progress
            receives the progress.
        limit_s
            the longest time of the task once it runs; by default the task's own.
        stop_request
            ends the task early with its best result; tasks that are not stoppable ignore it.
        user
            whose turn the task takes; by default the user of the present request (`CURRENT_USER`).

        Raises
        ------
        WorkError
            OutOfMemory, TimedOut, WorkerDied; with `.findings` of wrong arguments.
        BusyError
            if too many short tasks wait, in all or of this user.
        """
        known = TASKS.get(task, _ANY)
        limit_s = known.limit_s if limit_s is None else limit_s
        async with self._turns[known.long].turn(CURRENT_USER.get() if user is None else user):
            given = arguments if isinstance(arguments, Mapping) else await asyncio.to_thread(arguments)
            async with self._worker() as worker:
                try:
                    async with asyncio.timeout(limit_s):
                        return await worker.ask(task, given, on_progress, stop_request or StopRequest())
                except TimeoutError:
                    raise TimedOut(f"it took longer than {limit_s:g} s, and was stopped") from None

    async def close(self) -> None:
        """End all processes; callers of running tasks get WorkerDied."""
        self._closed = True
        for worker in list(self._idle):
            self._dismiss(worker)
        for worker in list(self._workers):
            worker.kill()
            await worker.gone.wait()
        if self._folder is not None:
            await asyncio.to_thread(shutil.rmtree, self._folder, ignore_errors=True)

    @asynccontextmanager
    async def _worker(self) -> AsyncIterator[Worker]:
        """A process within the block, kept for the next task if it has answered."""
        if self._closed:
            raise WorkError("the server is closing; expected to be asked again when it is back")
        worker = self._idle_worker() or await self._new_worker()
        try:
            yield worker
        finally:
            if worker.alive and not self._closed:
                self._keep(worker)
            else:
                self._dismiss(worker)

    def _idle_worker(self) -> Worker | None:
        while self._idle:
            worker = self._idle.pop()
            self._alarms.pop(worker).cancel()
            if worker.alive:
                return worker
            self._dismiss(worker)
        return None

    async def _new_worker(self) -> Worker:
        if self._folder is None:
            self._folder = await asyncio.to_thread(_new_folder)
        worker = await Worker.start(self._program, self._folder, self._memory_mb)
        self._workers.add(worker)
        return worker

    def _keep(self, worker: Worker) -> None:
        self._idle.append(worker)
        self._alarms[worker] = asyncio.get_running_loop().call_later(self._idle_s, self._dismiss, worker)

    def _dismiss(self, worker: Worker) -> None:
        """Kill a process and clean up after it."""
        if worker in self._idle:
            self._idle.remove(worker)
            self._alarms.pop(worker).cancel()
        worker.kill()
        leaving = asyncio.create_task(self._see_off(worker))
        self._leaving.add(leaving)  # the event loop holds only weak references to tasks
        leaving.add_done_callback(self._leaving.discard)

    async def _see_off(self, worker: Worker) -> None:
        await worker.see_off()
        self._workers.discard(worker)


def _new_folder() -> Path:
    """A folder for temporary files of this pool; removes those of servers that were killed."""
    sweep(OF_WORK)
    return Path(tempfile.mkdtemp(prefix=f"{OF_WORK}{os.getpid()}-"))
