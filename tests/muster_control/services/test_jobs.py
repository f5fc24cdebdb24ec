"""Jobs: all that is asked for is done in order or says why not; what is cancelled is gone; a restart loses nothing."""

import asyncio
import os
import signal
import subprocess
import sys
import threading
from pathlib import Path

import pytest
from sqlalchemy import delete
from tests.muster_control.services.opened import TINY, WATCHER, WHO, opened, over, told

from muster.mission.errors import MusterError, ParameterError
from muster_control.contract import (
    BusyError,
    ConflictError,
    ForbiddenError,
    NotFoundError,
    StoreError,
    User,
)
from muster_control.store.schema import plans
from muster_control.work import WorkerDied

LONG = {"time_limit": 300.0}
SHORT = {"iterations": 1}


@pytest.fixture
def with_services(tmp_path):
    """Runs a story of the services to its end."""
    return lambda story, **settings: asyncio.run(told(tmp_path, story, **settings))


@pytest.fixture
def children():
    """Finds the processes that this one has started in the test, and that live; earlier tests may have left some."""
    before = _living_children()
    return lambda: [child for child in _living_children() if child not in before]


def _living_children():
    found = []
    for status in Path("/proc").glob("[0-9]*/stat"):
        try:
            name, rest = status.read_text(encoding="utf-8").rsplit(")", 1)
        except (FileNotFoundError, ProcessLookupError):
            continue
        state, parent = rest.split()[:2]
        if int(parent) == os.getpid() and state != "Z" and "python" in name:
            found.append(int(status.parent.name))
    return found


async def under_way(services, job):
    """Wait until there is progress."""
    async for each in services.jobs.follow(job.id):
        if each.progress is not None:
            return each
    raise AssertionError("it is over")


def test_a_plan_is_asked_for_and_made(with_services):
    async def story(services):
        asked = await services.jobs.ask_plan(WHO, "tiny", iterations=5, seed=3, bound="quick")
        assert (asked.kind, asked.state, asked.author, asked.mission_version) == ("plan", "queued", "ann", 1)
        *_, last = await over(services.jobs, asked)
        assert last == await services.jobs.get(asked.id)
        assert (last.state, last.error) == ("done", "")
        plan = await services.plans.get(last.result["plan"])
        assert (plan.origin, plan.author, plan.plan["seed"], plan.plan["tasks_completed"]) == ("planned", "ann", 3, 2)
        (action,) = services.store.actions.list()
        assert (action.verb, action.outcome, action.data["iterations"]) == ("plan.ask", "done", 5)

    with_services(story)


def test_a_shipped_mission_is_stored_when_it_is_planned(with_services):
    async def story(services):
        job = await services.jobs.ask_plan(WHO, "6T-2R", **SHORT)
        assert (await over(services.jobs, job))[-1].state == "done"
        assert services.store.missions.get("6T-2R").version == 1

    with_services(story)


@pytest.mark.long
def test_a_plan_to_go_on_from(with_services):
    async def story(services):
        first = (await over(services.jobs, await services.jobs.ask_plan(WHO, "tiny", allocator="greedy")))[-1].result[
            "plan"
        ]
        last = (await over(services.jobs, await services.jobs.ask_plan(WHO, "tiny", start=first, iterations=0)))[-1]
        assert (await services.plans.get(last.result["plan"])).plan["routes"] == (await services.plans.get(first)).plan[
            "routes"
        ]
        with pytest.raises(NotFoundError):
            await services.jobs.ask_plan(WHO, "tiny", start=99)

    with_services(story)


@pytest.mark.long
def test_a_job_whose_start_is_gone_fails_with_a_line(with_services):
    async def story(services):
        first = (await over(services.jobs, await services.jobs.ask_plan(WHO, "tiny", **SHORT)))[-1].result["plan"]
        holds = await services.jobs.ask_plan(WHO, "tiny", **LONG)
        waits = await services.jobs.ask_plan(WHO, "tiny", start=first, **SHORT)
        with services.store.database.writing() as connection:
            connection.execute(delete(plans).where(plans.c.id == first))
        await services.jobs.cancel(WHO, holds.id)
        last = (await over(services.jobs, waits))[-1]
        assert (last.state, last.error) == ("failed", f"no plan {first}")

    with_services(story)


@pytest.mark.long
def test_sixty_requests_are_queued_and_done_in_order(with_services):
    async def story(services):
        asked = [await services.jobs.ask_plan(WHO, "tiny", allocator="greedy") for _ in range(60)]
        assert (await over(services.jobs, asked[-1]))[-1].state == "done"
        done = services.store.jobs.list(state="done", limit=300)
        assert [job.id for job in done] == [job.id for job in reversed(asked)]
        ends = [job.ended_at for job in done]
        assert ends == sorted(ends, reverse=True)
        assert len({job.result["plan"] for job in done}) == 60

    with_services(story)


@pytest.mark.long
def test_a_job_is_found_behind_many_others(with_services):
    async def story(services):
        running = await services.jobs.ask_plan(WHO, "tiny", **LONG)
        seen = await under_way(services, running)
        services.store.missions.create("other", TINY, {}, {"name": "other"}, "ann")
        for _ in range(210):
            services.store.jobs.add("plan", "other", 1, {}, "ann")
        assert [(job.id, job.progress is None) for job in await services.jobs.list("running")] == [(seen.id, False)]
        assert [job.id for job in await services.jobs.list(mission="tiny")] == [seen.id]
        assert [len(await services.jobs.list(limit=limit)) for limit in (1000, 10)] == [211, 10]

    with_services(story)


def test_the_queue_has_an_end(with_services):
    async def story(services):
        running = await services.jobs.ask_plan(WHO, "tiny", **LONG)
        await under_way(services, running)
        for _ in range(2):
            await services.jobs.ask_plan(WHO, "tiny", **LONG)
        with pytest.raises(BusyError, match=r"^2 jobs wait, the most that may; expected [^\n]*$"):
            await services.jobs.ask_plan(WHO, "tiny", **LONG)

    with_services(story, queue=2)


@pytest.mark.long
def test_a_job_that_is_cancelled_is_over_within_a_second(with_services, children):
    async def story(services):
        job = await services.jobs.ask_plan(WHO, "tiny", **LONG)
        await under_way(services, job)
        (worker,) = children()
        async with asyncio.timeout(1.0):
            assert (await services.jobs.cancel(WHO, job.id)).state == "cancelled"
            assert (await over(services.jobs, job))[-1].state == "cancelled"
        async with asyncio.timeout(10.0):  # a process that gives way to others gets to its end late
            while worker in children():
                await asyncio.sleep(0.01)
        with pytest.raises(ConflictError):
            await services.jobs.cancel(WHO, job.id)
        assert (await over(services.jobs, await services.jobs.ask_plan(WHO, "tiny", **SHORT)))[-1].state == "done"
        assert len(await services.plans.list()) == 1

    with_services(story)


@pytest.mark.long
def test_a_job_that_waits_can_be_cancelled(with_services):
    async def story(services):
        first = await services.jobs.ask_plan(WHO, "tiny", **LONG)
        await under_way(services, first)
        waits = await services.jobs.ask_plan(WHO, "tiny", **SHORT)
        following = asyncio.create_task(over(services.jobs, waits))
        await asyncio.sleep(0)
        await services.jobs.cancel(WHO, waits.id)
        assert (await following)[-1].state == "cancelled"
        last = await services.jobs.ask_plan(WHO, "tiny", **SHORT)
        await services.jobs.cancel(WHO, first.id)
        assert (await over(services.jobs, last))[-1].state == "done"
        assert len(await services.plans.list()) == 1

    with_services(story)


def test_a_job_that_is_stopped_keeps_its_best_plan(with_services, children):
    async def story(services):
        job = await services.jobs.ask_plan(WHO, "tiny", **LONG)
        await under_way(services, job)
        (worker,) = children()
        waits = await services.jobs.ask_plan(WHO, "tiny", **SHORT)
        assert (await services.jobs.stop(WHO, waits.id)).state == "cancelled"
        assert (await services.jobs.stop(WHO, job.id)).state == "running"
        last = (await over(services.jobs, job))[-1]
        assert (last.state, last.error) == ("done", "")
        assert (await services.plans.get(last.result["plan"])).plan["tasks_completed"] == 2
        with pytest.raises(ConflictError):
            await services.jobs.stop(WHO, job.id)
        with pytest.raises(ForbiddenError):
            await services.jobs.stop(WATCHER, job.id)
        assert children() == [worker]
        stops = [action.outcome for action in services.store.actions.list() if action.verb == "job.stop"]
        assert stops.count("done") == 2

    with_services(story)


@pytest.mark.long
def test_a_job_whose_worker_is_killed_is_done_once_more(with_services, children):
    async def story(services):
        job = await services.jobs.ask_plan(WHO, "tiny", time_limit=1.5)
        await under_way(services, job)
        (worker,) = children()
        os.kill(worker, signal.SIGKILL)
        assert (await over(services.jobs, job))[-1].state == "done"
        assert len(await services.plans.list()) == 1

    with_services(story)


def test_a_job_whose_workers_always_die_fails_with_a_line(with_services, monkeypatch):
    async def story(services):
        async def dies(*_, **__):
            raise WorkerDied("the process that worked on it ended with SIGSEGV")

        monkeypatch.setattr(services.pool, "run", dies)
        last = (await over(services.jobs, await services.jobs.ask_plan(WHO, "tiny", **SHORT)))[-1]
        assert (last.state, last.error) == (
            "failed",
            "the process that worked on it ended with SIGSEGV, for the second time",
        )

    with_services(story)


@pytest.mark.long
def test_a_fault_of_the_server_fails_the_job_alone(with_services, monkeypatch):
    async def story(services):
        with monkeypatch.context() as broken:
            broken.setattr(services.store.jobs.__class__, "end_with_plan", lambda *_: 1 / 0)
            last = (await over(services.jobs, await services.jobs.ask_plan(WHO, "tiny", **SHORT)))[-1]
            assert (last.state, last.error) == ("failed", "internal error; the server's log says more")
        assert (await over(services.jobs, await services.jobs.ask_plan(WHO, "tiny", **SHORT)))[-1].state == "done"

    with_services(story)


def refused(monkeypatch, table, method, refusals):
    """The database refuses a method as long as there are refusals in the list."""
    kept = getattr(table, method)

    def refusing(*arguments):
        if refusals:
            refusals.pop()
            raise StoreError("m.db: full")
        return kept(*arguments)

    monkeypatch.setattr(table, method, refusing)


@pytest.mark.long(keep=1)
@pytest.mark.parametrize("what", ["begin", "end_with_plan"])
def test_a_database_that_refuses_for_a_while_keeps_jobs_waiting(with_services, monkeypatch, what):
    monkeypatch.setattr("muster_control.services.jobs._AGAIN_S", 0.2)

    async def story(services):
        refusals = [0] * 10**6
        refused(monkeypatch, services.store.jobs, what, refusals)
        job = await services.jobs.ask_plan(WHO, "tiny", **SHORT)
        while len(refusals) > 10**6 - 2:
            await asyncio.sleep(0.05)
        error = (await services.jobs.get(job.id)).error
        assert error == ("" if what == "begin" else "this job waits: m.db: full")
        refusals.clear()
        last = (await over(services.jobs, job))[-1]
        assert (last.state, last.error, last.result["plan"]) == ("done", "", 1)
        assert len(await services.plans.list()) == 1

    with_services(story)


@pytest.mark.long
def test_who_closes_does_not_wait_for_a_database_that_refuses(tmp_path, monkeypatch):
    monkeypatch.setattr("muster_control.services.jobs._AGAIN_S", 0.2)

    async def story():
        async with opened(tmp_path) as services:
            services.store.missions.create("tiny", TINY, {}, {"name": "tiny"}, "ann")
            refused(monkeypatch, services.store.jobs, "end_with_plan", [0] * 10**6)
            job = await services.jobs.ask_plan(WHO, "tiny", **SHORT)
            while not (await services.jobs.get(job.id)).error:
                await asyncio.sleep(0.05)
            return job

    async def again(job):
        async with opened(tmp_path) as services:
            assert (await over(services.jobs, job))[-1].result["plan"] == 1
            assert len(await services.plans.list()) == 1

    asyncio.run(again(asyncio.run(asyncio.wait_for(story(), 60))))


def test_a_job_that_is_cancelled_while_its_plan_is_written_has_none(with_services):
    async def story(services):
        job = services.store.jobs.add("plan", "tiny", 1, {}, "ann")
        services.store.jobs.begin(job.id)
        services.store.jobs.end(job.id, "cancelled")
        with pytest.raises(ConflictError, match="is cancelled"):
            services.store.jobs.end_with_plan(job.id, {"routes": []}, "", None)
        assert services.store.plans.list() == []

    with_services(story)


@pytest.mark.long
def test_a_job_that_is_cancelled_just_when_it_has_failed_is_over(with_services, monkeypatch):
    written, go_on = threading.Event(), threading.Event()

    async def story(services):
        end = services.store.jobs.end

        def end_slowly(job, state, *more):
            ended = end(job, state, *more)
            if state == "failed":
                written.set()
                go_on.wait(60)
            return ended

        monkeypatch.setattr(services.store.jobs, "end", end_slowly)
        foreign = {"schema": "muster-plan/1", "routes": [{"robot": "ghost", "tasks": []}]}
        start = services.store.plans.add("tiny", 1, "uploaded", "ann", foreign)
        job = await services.jobs.ask_plan(WHO, "tiny", start=start.id)
        await asyncio.to_thread(written.wait, 60)
        with pytest.raises(ConflictError):
            await services.jobs.cancel(WHO, job.id)
        go_on.set()
        async with asyncio.timeout(30):
            assert (await over(services.jobs, job))[-1].state == "failed"

    with_services(story)


def test_authors_take_turns(tmp_path):
    """Many jobs of one do not keep the first of another waiting; each one's own jobs stay in order."""
    bob = User("bob", "command")
    begun, go_on = [], asyncio.Event()

    class Slow:
        async def run(self, task, arguments, **_):
            begun.append(arguments["seed"])
            await go_on.wait()
            return {"plan": {"schema": "muster-plan/1", "routes": []}, "why": ""}

    async def story():
        async with opened(tmp_path, pool=Slow()) as services:
            services.store.missions.create("tiny", TINY, {}, {"name": "tiny"}, "ann")
            jobs = [await services.jobs.ask_plan(WHO, "tiny", seed=seed) for seed in (1, 2, 3, 4)]
            jobs += [await services.jobs.ask_plan(bob, "tiny", seed=seed) for seed in (11, 12)]
            await services.jobs.cancel(WHO, jobs[2].id)
            go_on.set()
            for job in jobs:
                await over(services.jobs, job)

    asyncio.run(story())
    assert begun == [1, 11, 2, 12, 4]


@pytest.mark.long
def test_queued_and_running_jobs_go_on_after_a_restart(tmp_path):
    async def before():
        async with opened(tmp_path) as services:
            services.store.missions.create("tiny", TINY, {}, {"name": "tiny"}, "ann")
            first = await services.jobs.ask_plan(WHO, "tiny", time_limit=2.0)
            await under_way(services, first)
            others = [await services.jobs.ask_plan(WHO, "tiny", **SHORT) for _ in range(3)]
            return [first, *others]

    async def after(asked):
        async with opened(tmp_path) as services:
            ended = [(await over(services.jobs, job))[-1] for job in asked]
            assert [job.state for job in ended] == ["done"] * 4
            assert [job.result["plan"] for job in ended] == [1, 2, 3, 4]

    asyncio.run(after(asyncio.run(before())))


@pytest.mark.long
def test_progress_is_told_at_most_ten_times_a_second(with_services):
    async def story(services):
        begun = asyncio.get_running_loop().time()
        job = await services.jobs.ask_plan(WHO, "tiny", time_limit=1.0)
        heard = await over(services.jobs, job)
        with_progress = [each.progress["elapsed_s"] for each in heard if each.progress]
        assert with_progress == sorted(with_progress)
        assert 3 <= len(heard) <= 10 * (asyncio.get_running_loop().time() - begun) + 2
        assert heard[-1].progress["history"]

    with_services(story)


def test_a_follower_of_a_job_that_is_over_hears_that(with_services):
    async def story(services):
        job = await services.jobs.ask_plan(WHO, "tiny", **SHORT)
        await over(services.jobs, job)
        assert [each.state for each in await over(services.jobs, job)] == ["done"]
        with pytest.raises(NotFoundError):
            await over(services.jobs, type(job)(**{**vars(job), "id": 99}))

    with_services(story)


def test_whoever_watches_asks_for_nothing(with_services):
    async def story(services):
        with pytest.raises(ForbiddenError):
            await services.jobs.ask_plan(WATCHER, "tiny")
        job = await services.jobs.ask_plan(WHO, "tiny", **SHORT)
        with pytest.raises(ForbiddenError):
            await services.jobs.cancel(WATCHER, job.id)

    with_services(story)


@pytest.mark.parametrize(
    "wish",
    [
        {"magic": 1},
        {"allocator": 3},
        {"objective": "fun"},
        {"time_limit": -1},
        {"time_limit": float("nan")},
        {"time_limit": 1e9},
        {"iterations": 1.5},
        {"seed": -1},
        {"seed": True},
        {"ignore": "capacity"},
        {"ignore": ["gravity"]},
        {"bound": "maybe"},
        {"start": "1"},
        {"parameters": {"threads": [1]}},
    ],
)
def test_a_wish_that_cannot_be_met_is_refused_at_once(with_services, wish):
    async def story(services):
        with pytest.raises(ParameterError, match=r"^[^\n]*; expected [^\n]*$"):
            await services.jobs.ask_plan(WHO, "tiny", **wish)
        assert await services.jobs.list() == []

    with_services(story)


def test_a_mission_that_is_not_there(with_services):
    async def story(services):
        for version in (None, 7):
            with pytest.raises(NotFoundError):
                await services.jobs.ask_plan(WHO, "nowhere", version)
        with pytest.raises(NotFoundError):
            await services.jobs.cancel(WHO, 99)

    with_services(story)


@pytest.mark.long(keep=3)
@pytest.mark.parametrize(
    ("asked", "said"),
    [
        ({"allocator": "serch"}, r"allocator: serch; expected .*; did you mean 'search'\?"),
        ({"parameters": {"treads": 1}}, r"search has no parameter treads; did you mean 'threads'\?"),
        ({"allocator": "greedy", "parameters": {"threads": 1}}, "greedy has no parameter threads"),
        ({"parameters": {"threads": "many"}}, "threads: .*; expected a number"),
        ({"parameters": {"threads": 10_000}}, "threads: 10000; expected at most"),
        ({"objective": "totl"}, r"objective: .*; did you mean 'total'\?"),
        ({"bound": "quik"}, r"bound: .*; did you mean 'quick'\?"),
        ({"ignore": ["capacty"]}, r"ignore: .*; did you mean 'capacity'\?"),
        ({"time_limt": 1}, r"time_limt.*did you mean 'time_limit'\?"),
    ],
)
def test_a_request_that_nothing_can_meet_is_refused_at_once(with_services, asked, said):
    async def story(services):
        with pytest.raises(MusterError, match=said):
            await services.jobs.ask_plan(WHO, "tiny", **asked)
        assert await services.jobs.list() == []

    with_services(story)


@pytest.mark.long
def test_the_server_loads_nothing_heavy():
    code = """
import sys
import muster_control.services.jobs, muster_control.services.plans
heavy = ("numpy", "scipy", "shapely", "matplotlib", "muster.allocation.", "muster.simulation", "muster.verification",
         "muster_files.", "muster.report", "muster.mission.reading.yaml_reader")
light = {"muster_control.contract", "muster.allocation.parameter_types",
         "muster_files.sites", "muster_files.sites.readers", "muster_files.mission_readers",
         "muster_files.qgc", "muster_files.qgc.plan_format"}
print([name for name in sys.modules if name.startswith(heavy) and name not in light])
"""
    ended = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert ended.stdout == "[]\n"
