"""The desk: every service of mission control, opened and closed together."""

from __future__ import annotations

import asyncio
from collections.abc import AsyncIterator, Callable
from concurrent.futures import Future, ThreadPoolExecutor
from contextlib import AsyncExitStack, asynccontextmanager
from dataclasses import dataclass, replace
from threading import Thread

from muster.server.services.actions import Actions, Refused, unheard
from muster.server.services.database_lock import Lock, TakenError, alone_with
from muster.server.services.jobs import Jobs
from muster.server.services.missions import Missions
from muster.server.services.plans import Plans
from muster.server.services.records import Records
from muster.server.services.runs import Runs
from muster.server.settings import Settings
from muster.server.store.store import Store
from muster.server.store.timed_log import TimedLog
from muster.server.work.pool import Pool

_THREADS = 12
"""That wait for the database, fewer than its connections: while some wait for a lock pages can still be read."""

_LOOK_S = 1.0
"""Until it is looked again whether the database is still this server's own."""


@dataclass(frozen=True)
class Desk:
    """What the API and the pages call; `store` and `pool` are for health and metrics alone."""

    missions: Missions
    plans: Plans
    jobs: Jobs
    runs: Runs
    records: Records
    actions: Actions
    settings: Settings
    store: Store
    pool: Pool
    taken: asyncio.Task[None] | None = None
    """Raises when another server has the database: this one is to end then."""


@asynccontextmanager
async def open_desk(
    settings: Settings, appended: Callable[[float], None] = lambda _: None, refused: Refused = unheard
) -> AsyncIterator[Desk]:
    """The desk; queued jobs and unfinished runs go on, and are left where they are when it closes.

    Parameters
    ----------
    appended
        is told how many seconds each writing of a run's log took.
    refused
        is told of everybody who may only watch and wanted to command.

    Raises
    ------
    StoreError
        if the database cannot be used, or another server uses it.
    """
    asyncio.get_running_loop().set_default_executor(ThreadPoolExecutor(_THREADS, "muster"))
    async with AsyncExitStack() as closing:
        lock = closing.enter_context(alone_with(settings.database))
        store = await asyncio.to_thread(Store.open, settings.database)
        closing.push_async_callback(asyncio.to_thread, store.close)
        store.database.require = lock.require
        store = replace(store, log=TimedLog(store.database, appended))
        pool = Pool(workers=settings.workers, memory_mb=settings.memory_mb)
        closing.push_async_callback(pool.close)
        runs = Runs(store, settings, refused)
        desk = Desk(
            missions=Missions(store, pool, refused),
            plans=Plans(store, pool, refused),
            jobs=Jobs(store, pool, settings, refused),
            runs=runs,
            records=Records(store, pool, runs),
            actions=Actions(store, refused),
            settings=settings,
            store=store,
            pool=pool,
        )
        await desk.jobs.start()
        closing.push_async_callback(desk.jobs.close)
        await desk.runs.start_up()
        closing.push_async_callback(desk.runs.close)
        watch = asyncio.create_task(_until_taken(lock, runs))
        closing.callback(watch.cancel)
        yield replace(desk, taken=watch)


async def _until_taken(lock: Lock, runs: Runs) -> None:
    """Look after the lock, by threads of its own as others may all wait for the database.

    Raises
    ------
    TakenError
        if another server has the database; nothing is carried out any more then.
    """
    while True:
        await asyncio.sleep(_LOOK_S)
        try:
            await _aside(lock.look)
        except TakenError:
            await runs.close()
            raise


def _aside(work: Callable[[], None]) -> asyncio.Future[None]:
    """What a thread does for which nobody waits at the end: no executor's, whose threads the interpreter joins."""
    done: Future[None] = Future()
    done.set_running_or_notify_cancel()  # whoever waits may be cancelled, the thread cannot

    def go() -> None:
        try:
            work()
        except BaseException as error:
            done.set_exception(error)
        else:
            done.set_result(None)

    Thread(target=go, name="muster-lock", daemon=True).start()
    return asyncio.wrap_future(done)
