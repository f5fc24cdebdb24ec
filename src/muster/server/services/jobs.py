"""Jobs: planning that is asked for, waits its turn, is done by a worker, and survives the server."""

from __future__ import annotations

import asyncio
import logging
from collections.abc import AsyncIterator, Callable, Coroutine, Mapping
from dataclasses import replace
from functools import partial
from typing import Any

from muster.exchange.mission_control import (
    JOB_OVER,
    BusyError,
    ConflictError,
    Job,
    JobState,
    NotFoundError,
    StoreError,
    Who,
)
from muster.mission.errors import MusterError
from muster.server.services.actions import Actions, Refused, unheard
from muster.server.services.missions import Missions
from muster.server.services.plan_requests import PLANS, checked_request
from muster.server.services.repeated_requests import made_once
from muster.server.services.uploads import for_work
from muster.server.settings import Settings
from muster.server.store import Store
from muster.server.store.request_keys import RequestKey
from muster.server.work import Halt, Pool, WorkerDied, WorkError

_AGAIN_S = 2.0  # until a database that refuses is asked again
_TOLD_EVERY_S = 0.1  # followers, at most

_log = logging.getLogger(__name__)


class Jobs:
    """The queue, kept in the database: what waited or was under way when the server ended goes on when it is back."""

    def __init__(self, store: Store, pool: Pool, settings: Settings, refused: Refused = unheard) -> None:
        self._store = store
        self._pool = pool
        self._settings = settings
        self._missions = Missions(store, pool)
        self._actions = Actions(store, refused)
        self._queue: asyncio.Queue[int] = asyncio.Queue()
        self._queued: set[int] = set()
        self._newest: dict[int, Job] = {}  # jobs of which more is known here than in the database
        self._at_work: dict[int, asyncio.Task[None]] = {}
        self._halts: dict[int, Halt] = {}  # of jobs at work
        self._followers: dict[int, set[asyncio.Event]] = {}
        self._tasks: set[asyncio.Task[None]] = set()
        self._hands: list[asyncio.Task[None]] = []
        self._closing = False

    async def start(self) -> None:
        """Go on with what is in the database, in order."""
        for job in await asyncio.to_thread(self._store.jobs.requeue):
            self._enqueue(job.id)
        self._hands = [asyncio.create_task(self._work()) for _ in range(self._settings.workers)]

    async def close(self) -> None:
        """Stop; what is under way stays so in the database, and begins anew when the server is back."""
        self._closing = True
        for task in (*self._hands, *self._at_work.values()):
            task.cancel()
        await asyncio.gather(*self._hands, *self._tasks, return_exceptions=True)

    async def list(self, state: JobState | None = None, mission: str | None = None, limit: int = 200) -> list[Job]:
        """Jobs, of one state and one mission or of all, the newest first."""
        found = await asyncio.to_thread(self._store.jobs.list, state, mission, limit)
        return [self._newest.get(job.id, job) for job in found]

    async def get(self, job: int) -> Job:
        """One job, with its newest progress.

        Raises
        ------
        NotFoundError
            if there is none.
        """
        newest = self._newest.get(job)
        return newest if newest is not None else await asyncio.to_thread(self._store.jobs.get, job)

    async def ask_plan(
        self,
        who: Who,
        mission: str,
        version: int | None = None,
        *,
        request: RequestKey | None = None,
        **options: Any,
    ) -> Job:
        """Ask for a plan of a mission, of its newest version if none is named.

        Parameters
        ----------
        request
            one that came before gives the job that it made then.
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
        self, who: Who, mission: str, version: int | None, options: Mapping[str, Any], request: RequestKey | None
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
            self._enqueue(job.id)
            return job

    async def _require_known(self, options: Mapping[str, Any]) -> None:
        """Refuse an unknown allocator, or parameters that it does not take; a worker knows which there are."""
        if options.get("allocator") is not None or options.get("parameters"):
            checked = {name: value for name, value in options.items() if name not in PLANS}
            await self._pool.run("check_request", checked)

    async def cancel(self, who: Who, job: int) -> Job:
        """End a job that is not over; its process is gone at once.

        Raises
        ------
        ConflictError
            if it is over.
        NotFoundError, ForbiddenError
        """
        async with self._actions.of(who, "job.cancel", {"job": job}):
            return await self._cancelled(job)

    async def stop(self, who: Who, job: int) -> Job:
        """Ask a job under way to end with the best plan that it has, or the first; one that waits is cancelled.

        Asked once more, it leaves out the reasons for tasks that are not in the plan.

        Raises
        ------
        ConflictError
            if it is over.
        NotFoundError, ForbiddenError
        """
        async with self._actions.of(who, "job.stop", {"job": job}):
            halt = self._halts.get(job)
            if halt is None:
                return await self._cancelled(job)
            halt.ask()
            return await self.get(job)

    async def _cancelled(self, job: int) -> Job:
        at_work = self._at_work.pop(job, None)
        if at_work is not None:
            at_work.cancel()
        self._halts.pop(job, None)
        self._queued.discard(job)
        try:
            ended = await asyncio.to_thread(self._store.jobs.end, job, "cancelled")
        except StoreError:  # nobody works on it any more, which the database is to know later
            self._see_to(self._end(job, "cancelled"))
            raise
        self._forget(job)
        return ended

    async def follow(self, job: int) -> AsyncIterator[Job]:
        """A job as it is and at each change, at most ten times a second, until it is over.

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

    def _enqueue(self, job: int) -> None:
        self._queued.add(job)
        self._queue.put_nowait(job)

    async def _work(self) -> None:
        """Have one job after the other done."""
        while True:
            job = await self._queue.get()
            if job not in self._queued:  # cancelled meanwhile
                continue
            self._queued.discard(job)
            halt = self._halts[job] = Halt()
            task = self._at_work[job] = self._see_to(self._do(job, halt))
            await asyncio.wait([task])
            self._at_work.pop(job, None)
            self._halts.pop(job, None)

    def _see_to(self, what: Coroutine[Any, Any, None]) -> asyncio.Task[None]:
        task = asyncio.create_task(what)
        self._tasks.add(task)
        task.add_done_callback(self._tasks.discard)
        return task

    async def _do(self, number: int, halt: Halt) -> None:
        """Do a job, and say what came of it."""
        try:
            job = await self._moved(self._store.jobs.begin, number)
            if job is not None:
                self._learn(job)
                done = await self._planned(job, halt)
                self._at_work.pop(number, None)  # what is written down now is not to be broken off
                progress = self._newest[number].progress
                await self._moved(self._store.jobs.end_with_plan, number, done["plan"], done["why"], progress)
            self._forget(number)
        except StoreError as why:  # the server closes: it begins anew when that is back
            _log.error("job %d: %s", number, why)
        except MusterError as error:
            await self._end(number, "failed", " ".join(str(error).split()))
        except Exception:
            _log.exception("job %d", number)
            await self._end(number, "failed", "internal error; the server's log says more")

    async def _planned(self, job: Job, halt: Halt) -> dict[str, Any]:
        """What a worker answers; one that dies under it may be chance, a second one is not."""
        mission = await self._patiently(job.id, self._store.missions.get, job.mission, job.mission_version)
        wishes = {**job.arguments, "mission": for_work(mission.text, mission.files, job.mission)}
        for name in PLANS:
            if wishes.get(name) is not None:
                wishes[name] = (await self._patiently(job.id, self._store.plans.get, wishes[name])).plan

        def hear(progress: dict[str, Any]) -> None:
            self._learn(replace(job, progress=progress))

        ask = partial(self._pool.run, "plan", wishes, on_progress=hear, limit_s=self._settings.job_s, halt=halt)
        try:
            return await ask()
        except WorkerDied as error:
            _log.warning("job %d: %s; it is done once more", job.id, error)
        try:
            return await ask()
        except WorkerDied as error:
            raise WorkError(f"{error}, for the second time") from None

    async def _end(self, number: int, state: JobState, error: str = "") -> None:
        """Write down how a job ended, with its last progress; one that was cancelled meanwhile stays so."""
        self._at_work.pop(number, None)  # what is written down now is not to be broken off
        newest = self._newest.get(number)
        if newest is not None and newest.progress is not None:
            await self._patiently(number, self._store.jobs.progress, number, newest.progress)
        await self._moved(self._store.jobs.end, number, state, None, error)
        self._forget(number)

    async def _moved(self, move: Callable[..., Job], number: int, *arguments: Any) -> Job | None:
        """A job in its next state; None where it was cancelled meanwhile."""
        try:
            moved: Job = await self._patiently(number, move, number, *arguments)
        except (ConflictError, NotFoundError):
            return None
        return moved

    async def _patiently(self, number: int, ask: Callable[..., Any], *arguments: Any) -> Any:
        """Ask the database for something of a job, however long it refuses; the job says so meanwhile."""
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
        """What is known of a job beyond the database."""
        self._newest[job.id] = job
        self._tell(job.id)

    def _forget(self, job: int) -> None:
        """The database knows all of it."""
        self._newest.pop(job, None)
        self._tell(job)

    def _tell(self, job: int) -> None:
        for changed in self._followers.get(job, ()):
            changed.set()
