"""Jobs: planning requests that are queued, done by a worker, and kept across restarts of the server."""

from __future__ import annotations

import asyncio
import logging
from collections.abc import AsyncIterator, Callable, Coroutine, Mapping
from dataclasses import replace
from functools import partial
from itertools import count
from typing import Any

from muster.mission.errors import MusterError
from muster_control.contract import (
    JOB_OVER,
    PAGE_ROWS,
    BusyError,
    ConflictError,
    Job,
    JobState,
    NotFoundError,
    StoreError,
    User,
)
from muster_control.services.actions import Actions, Refused, ignore_refusal
from muster_control.services.missions import Missions
from muster_control.services.plan_requests import PLANS, checked_request
from muster_control.services.repeated_requests import made_once
from muster_control.services.uploads import mission_input
from muster_control.settings import Settings
from muster_control.store import Store
from muster_control.store.request_keys import RequestKey
from muster_control.work import Pool, StopRequest, WorkerDied, WorkError

_AGAIN_S = 2.0  # between two attempts to write to a database that fails
_TOLD_EVERY_S = 0.1  # at most

_log = logging.getLogger(__name__)


class Jobs:
    """The queue of jobs. It is kept in the database: unfinished jobs continue after a restart of the server."""

    def __init__(self, store: Store, pool: Pool, settings: Settings, refused: Refused = ignore_refusal) -> None:
        self._store = store
        self._pool = pool
        self._settings = settings
        self._missions = Missions(store, pool)
        self._actions = Actions(store, refused)
        self._arrivals = asyncio.Semaphore(0)  # one release per queued job
        self._queued: dict[int, str] = {}  # the authors of queued jobs, in order
        self._last_turn: dict[str, int] = {}
        self._numbers = count(1)
        self._newest: dict[int, Job] = {}  # states that are newer than the database's
        self._at_work: dict[int, asyncio.Task[None]] = {}
        self._stop_requests: dict[int, StopRequest] = {}  # of running jobs
        self._followers: dict[int, set[asyncio.Event]] = {}
        self._tasks: set[asyncio.Task[None]] = set()
        self._hands: list[asyncio.Task[None]] = []
        self._closing = False

    async def start(self) -> None:
        """Queue the unfinished jobs of the database in order."""
        for job in await asyncio.to_thread(self._store.jobs.requeue):
            self._enqueue(job)
        self._hands = [asyncio.create_task(self._work()) for _ in range(self._settings.workers)]

    async def close(self) -> None:
        """Stop working. Running jobs stay `running` in the database and begin anew when the server starts again."""
        self._closing = True
        for task in (*self._hands, *self._at_work.values()):
            task.cancel()
        await asyncio.gather(*self._hands, *self._tasks, return_exceptions=True)

    async def list(
        self,
        state: JobState | None = None,
        mission: str | None = None,
        limit: int = PAGE_ROWS,
        before: int | None = None,
    ) -> list[Job]:
        """Jobs of one state and mission or of all, newest first."""
        found = await asyncio.to_thread(self._store.jobs.list, state, mission, limit, before)
        return [self._newest.get(job.id, job) for job in found]

    async def get(self, job: int) -> Job:
        """A job with its newest progress.

        Raises
        ------
        NotFoundError
            if there is none.
        """
        newest = self._newest.get(job)
        return newest if newest is not None else await asyncio.to_thread(self._store.jobs.get, job)

    async def ask_plan(
        self,
        who: User,
        mission: str,
        version: int | None = None,
        *,
        request: RequestKey | None = None,
        **options: Any,
    ) -> Job:
        """Queue a planning request for a version of a mission, by default the newest.

        Parameters
        ----------
        request
            its key; a repeated request returns the job of the first.
        options
            the options of a planning request, by the names of `PlanningOptions`; and `start` and `fixed`, the ids of
            plans.

        Raises
        ------
        ParameterError
            if an option is unknown, or out of its range.
        BusyError
            if too many jobs wait.
        ConflictError
            if another request had the key.
        NotFoundError, ForbiddenError
        """
        ask = partial(self._ask_plan, who, mission, version, options, request)
        return await made_once(self._store, request, ask, self.get)

    async def _ask_plan(
        self, who: User, mission: str, version: int | None, options: Mapping[str, Any], request: RequestKey | None
    ) -> Job:
        async with self._actions.of(who, "plan.ask", {"mission": mission, "version": version, **options}):
            checked_request(options, self._settings.job_s)
            if len(self._queued) >= self._settings.queue:
                raise BusyError(f"{len(self._queued)} jobs wait, the most that may; expected to be asked again later")
            found = await (self._missions.get(mission, version) if version else self._missions.stored(mission))
            await self._require_known(options)
            for name in PLANS:
                if options.get(name) is not None:
                    await asyncio.to_thread(self._store.plans.get, options[name])
            add = partial(self._store.jobs.add, "plan", mission, found.version, options, who.name, request)
            job = await asyncio.to_thread(add)
            self._enqueue(job)
            return job

    async def _require_known(self, options: Mapping[str, Any]) -> None:
        """Refuse an unknown allocator, or parameters that it does not take; a worker knows which there are."""
        if options.get("allocator") is not None or options.get("parameters"):
            checked = {name: value for name, value in options.items() if name not in PLANS}
            await self._pool.run("check_request", checked)

    async def cancel(self, who: User, job: int) -> Job:
        """Cancel a job that is not over; its process is killed.

        Raises
        ------
        ConflictError
            if it is over.
        NotFoundError, ForbiddenError
        """
        async with self._actions.of(who, "job.cancel", {"job": job}):
            return await self._cancelled(job)

    async def stop(self, who: User, job: int) -> Job:
        """End a running job with the best plan so far, or with the first one; a queued job is cancelled.

        A second call also leaves out the reasons for unassigned tasks.

        Raises
        ------
        ConflictError
            if it is over.
        NotFoundError, ForbiddenError
        """
        async with self._actions.of(who, "job.stop", {"job": job}):
            stop_request = self._stop_requests.get(job)
            if stop_request is None:
                return await self._cancelled(job)
            stop_request.ask()
            return await self.get(job)

    async def _cancelled(self, job: int) -> Job:
        at_work = self._at_work.pop(job, None)
        if at_work is not None:
            at_work.cancel()
        self._stop_requests.pop(job, None)
        self._queued.pop(job, None)
        try:
            ended = await asyncio.to_thread(self._store.jobs.end, job, "cancelled")
        except StoreError:  # its process has ended; write that later
            self._see_to(self._end(job, "cancelled"))
            raise
        self._forget(job)
        return ended

    async def follow(self, job: int) -> AsyncIterator[Job]:
        """Yield a job now and after each change, at most ten times a second, until it is over.

        Raises
        ------
        NotFoundError
            if there is none.
        """
        changed = asyncio.Event()
        followers = self._followers.setdefault(job, set())
        followers.add(changed)
        try:
            while True:
                changed.clear()
                newest = await self.get(job)
                yield newest
                if newest.state in JOB_OVER:
                    return
                await asyncio.sleep(_TOLD_EVERY_S)
                await changed.wait()
        finally:
            followers.discard(changed)
            if not followers:
                self._followers.pop(job, None)

    def _enqueue(self, job: Job) -> None:
        self._queued[job.id] = job.author
        self._arrivals.release()

    def _take_next(self) -> int | None:
        """The first job of the author whose last turn is longest ago; None if it was cancelled."""
        if not self._queued:
            self._last_turn.clear()
            return None
        author = min(self._queued.values(), key=lambda each: self._last_turn.get(each, 0))
        self._last_turn[author] = next(self._numbers)
        job = next(number for number, of in self._queued.items() if of == author)
        del self._queued[job]
        return job

    async def _work(self) -> None:
        """Do one job after the other; authors take turns."""
        while True:
            await self._arrivals.acquire()
            job = self._take_next()
            if job is None:
                continue
            stop_request = self._stop_requests[job] = StopRequest()
            task = self._at_work[job] = self._see_to(self._do(job, stop_request))
            await asyncio.wait([task])
            self._at_work.pop(job, None)
            self._stop_requests.pop(job, None)

    def _see_to(self, what: Coroutine[Any, Any, None]) -> asyncio.Task[None]:
        task = asyncio.create_task(what)
        self._tasks.add(task)
        task.add_done_callback(self._tasks.discard)
        return task

    async def _do(self, number: int, stop_request: StopRequest) -> None:
        """Do a job and write its result."""
        try:
            job = await self._moved(self._store.jobs.begin, number)
            if job is not None:
                self._learn(job)
                done = await self._planned(job, stop_request)
                self._at_work.pop(number, None)  # cancelling must not interrupt what is being written
                progress = self._newest[number].progress
                await self._moved(self._store.jobs.end_with_plan, number, done["plan"], done["why"], progress)
            self._forget(number)
        except StoreError as why:  # the server closes: the job begins anew at the next start
            _log.error("job %d: %s", number, why)
        except MusterError as error:
            await self._end(number, "failed", " ".join(str(error).split()))
        except Exception:
            _log.exception("job %d", number)
            await self._end(number, "failed", "internal error; the server's log says more")

    async def _planned(self, job: Job, stop_request: StopRequest) -> dict[str, Any]:
        """The answer of a worker. If the worker dies, the job is tried once more."""
        mission = await self._patiently(job.id, self._store.missions.get, job.mission, job.mission_version)
        arguments = {**job.arguments, "mission": mission_input(mission.text, mission.files, job.mission)}
        for name in PLANS:
            if arguments.get(name) is not None:
                arguments[name] = (await self._patiently(job.id, self._store.plans.get, arguments[name])).plan

        def hear(progress: dict[str, Any]) -> None:
            self._learn(replace(job, progress=progress))

        ask = partial(
            self._pool.run, "plan", arguments, on_progress=hear, limit_s=self._settings.job_s, stop_request=stop_request
        )
        try:
            return await ask()
        except WorkerDied as error:
            _log.warning("job %d: %s; it is done once more", job.id, error)
        try:
            return await ask()
        except WorkerDied as error:
            raise WorkError(f"{error}, for the second time") from None

    async def _end(self, number: int, state: JobState, error: str = "") -> None:
        """Write how a job ended, with its last progress; a job that was cancelled meanwhile stays cancelled."""
        self._at_work.pop(number, None)  # cancelling must not interrupt what is being written
        newest = self._newest.get(number)
        if newest is not None and newest.progress is not None:
            await self._patiently(number, self._store.jobs.progress, number, newest.progress)
        await self._moved(self._store.jobs.end, number, state, None, error)
        self._forget(number)

    async def _moved(self, move: Callable[..., Job], number: int, *arguments: Any) -> Job | None:
        """The job in its next state; None if it was cancelled meanwhile."""
        try:
            moved: Job = await self._patiently(number, move, number, *arguments)
        except (ConflictError, NotFoundError):
            return None
        return moved

    async def _patiently(self, number: int, ask: Callable[..., Any], *arguments: Any) -> Any:
        """Call the database until it answers; the job's `error` says meanwhile that it waits."""
        while True:
            try:
                return await asyncio.to_thread(ask, *arguments)
            except StoreError as why:
                if self._closing:
                    raise
                _log.warning("job %d: %s", number, why)
                newest = self._newest.get(number)
                if newest is not None:
                    self._learn(replace(newest, error=f"this job waits: {why}"))
                await asyncio.sleep(_AGAIN_S)

    def _learn(self, job: Job) -> None:
        """Keep a state of a job that is newer than the database's, and notify its followers."""
        self._newest[job.id] = job
        self._tell(job.id)

    def _forget(self, job: int) -> None:
        """Drop the state of a job that the database has now."""
        self._newest.pop(job, None)
        self._tell(job)

    def _tell(self, job: int) -> None:
        for changed in self._followers.get(job, ()):
            changed.set()
