"""The services's services that need workers, opened for a test."""

from contextlib import asynccontextmanager
from types import SimpleNamespace

from muster_control.contract import User
from muster_control.services.jobs import Jobs
from muster_control.services.plans import Plans
from muster_control.settings import Settings
from muster_control.store import Store
from muster_control.work import Pool

WHO = User("ann", "command", "127.0.0.1")
WATCHER = User("bob", "watch")
TINY = """
schema: muster/1
name: tiny
robots:
  - {id: r_0, position: [0, 0]}
  - {id: r_1, position: [10, 0], skills: [gripper]}
tasks:
  - {id: a, position: [1, 0]}
  - {id: b, position: [9, 0], prerequisites: [a]}
  - {id: c, position: [5, 1], requires: [crane]}
"""


@asynccontextmanager
async def opened(folder, pool=None, **settings):
    """The services, on one database in the folder; what this opens may be opened again afterwards."""
    settings = Settings(database=f"sqlite:///{folder / 'm.db'}", **{"workers": 1, "memory_mb": 1024, **settings})
    store = Store.open(settings.database)
    own = pool is None
    pool = Pool(workers=settings.workers, memory_mb=settings.memory_mb) if own else pool
    jobs = Jobs(store, pool, settings)
    try:
        await jobs.start()
        yield SimpleNamespace(jobs=jobs, plans=Plans(store, pool), store=store, pool=pool)
    finally:
        await jobs.close()
        if own:
            await pool.close()
        store.close()


async def told(folder, story, **settings):
    """Run `story(services)` to its end, with the mission `tiny` in the database."""
    async with opened(folder, **settings) as services:
        services.store.missions.create("tiny", TINY, {}, {"name": "tiny"}, "ann")
        return await story(services)


async def over(jobs, job):
    """All that is told of a job until it is over."""
    return [each async for each in jobs.follow(job.id)]
