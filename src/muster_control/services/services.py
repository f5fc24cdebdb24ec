"""All services of mission control, opened and closed together."""

from __future__ import annotations

import asyncio
from collections.abc import AsyncIterator, Callable
from concurrent.futures import Future, ThreadPoolExecutor
from contextlib import AsyncExitStack, asynccontextmanager
from dataclasses import dataclass, replace
from threading import Thread

from muster_control.services.actions import Actions, Refused, ignore_refusal
from muster_control.services.database_lock import Lock, TakenError, alone_with
from muster_control.services.jobs import Jobs
from muster_control.services.missions import Missions
from muster_control.services.plans import Plans
from muster_control.services.records import Records
from muster_control.services.runs import Runs
from muster_control.settings import Settings
from muster_control.store.store import Store
from muster_control.work.pool import Pool

_THREADS = 12
"""Threads for the database, fewer than its connections: pages can be read while some threads wait for a lock."""

_LOOK_S = 1.0
"""Between two checks of the database lock."""


@dataclass(frozen=True)
class Services:
    """The services that the API and the pages call; `store` and `pool` are for health and metrics only."""

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
async def open_services(
    settings: Settings, appended: Callable[[float], None] = lambda _: None, refused: Refused = ignore_refusal
) -> AsyncIterator[Services]:
    """Open the services: queued jobs and unfinished runs go on, and are left where they are at the end.

    Parameters
    ----------
    appended
        receives the seconds that each write of a run's log took.
    refused
        receives each command that a watcher tries.

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
        store.log.observe = appended
        pool = Pool(workers=settings.workers, memory_mb=settings.memory_mb)
        closing.push_async_callback(pool.close)
        runs = Runs(store, settings, refused)
        services = Services(
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
        await services.jobs.start()
        closing.push_async_callback(services.jobs.close)
        closing.push_async_callback(services.runs.close)
        await services.runs.start_up()
        watch = asyncio.create_task(_until_taken(lock, runs))
        closing.callback(watch.cancel)
        yield replace(services, taken=watch)


async def _until_taken(lock: Lock, runs: Runs) -> None:
    """Check the lock every second, in separate threads: the pool's threads may all wait for the database.

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
    """Run in a daemon thread: the interpreter would join the threads of an executor at its end."""
    done: Future[None] = Future()
    done.set_running_or_notify_cancel()  # the future may be cancelled, the thread cannot

    def go() -> None:
        try:
            work()
        except BaseException as error:
            done.set_exception(error)
        else:
            done.set_result(None)

    Thread(target=go, name="muster-lock", daemon=True).start()
    return asyncio.wrap_future(done)
