"""Runs and jobs on either database, and what becomes of them when a database's server is gone for a while."""

import asyncio
import json
import os
import signal
from itertools import pairwise

import pytest
from tests.muster_control.databases import postgresql, postgresql_url
from tests.muster_control.runs.process import kill, serving, until
from tests.muster_control.runs.store import ADA, planned
from tests.muster_control.services.opened import TINY

import muster
from muster_control.services.services import open_services
from muster_control.settings import Settings
from muster_control.store.store import Store

__all__ = ["postgresql", "postgresql_url"]


async def watched(runs, run, holds=lambda said: False):
    """All that watchers are told, until something holds."""
    said = []
    async for text in runs.subscribers(run).watch(0):
        said.append(json.loads(text))
        if holds(said[-1]):
            break
    return said


def going_at(time_s):
    return lambda said: said["type"] == "states" and said["time_s"] > time_s


async def gone(runs, run):
    while runs.subscribers(run) is not None:
        await asyncio.sleep(0.01)


def judge(store, run, tasks, resumed):
    """It ended, and all of it is kept once."""
    found, log = store.runs.get(run), store.log.entries(run)
    assert (found.state, found.resumed, found.remark) == ("ended", resumed, "")
    assert found.report == log[-1].data
    assert [entry.seq for entry in log] == list(range(1, len(log) + 1))
    told = [*found.report["tasks_done"], *(lost["task"] for lost in found.report["tasks_lost"])]
    assert sorted(told) == sorted(tasks)
    stretches = list(store.log.stretches(run))
    assert all(a.until_s < b.from_s for a, b in pairwise(stretches))
    return log


@pytest.mark.long
def test_a_run_and_a_job_outlive_the_databases_server(postgresql, postgresql_url):
    mission = muster.load("31T-6R50")

    async def story():
        async with open_services(Settings(database=postgresql_url, workers=1)) as services:
            services.store.missions.create("tiny", TINY, {}, {"name": "tiny"}, "ada")
            run = (await services.runs.start(ADA, planned(services.store, mission), speed=10.0)).id
            await watched(services.runs, run, going_at(5))
            job = await services.jobs.ask_plan(ADA, "tiny", time_limit=1.0)
            await asyncio.to_thread(postgresql.stop)
            try:
                pause = await services.runs.act(ADA, run, "pause")
                await watched(services.runs, run, lambda said: said["type"] == "action" and said["id"] == pause.id)
                during = await services.runs.get(run)
                os.kill(services.runs.pid(run), signal.SIGKILL)
                await services.runs.act(ADA, run, "resume")
                await services.runs.act(ADA, run, "speed", {"speed": None})
                messages = await watched(services.runs, run, lambda said: said.get("kind") == "report")
            finally:
                await asyncio.to_thread(postgresql.start)
            await gone(services.runs, run)
            *_, last = [each async for each in services.jobs.follow(job.id)]
            judge(services.store, run, [task.id for task in mission.tasks], 1)
            plans = [plan.id for plan in services.store.plans.list("tiny")]
            asked = [(action.verb, action.outcome) for action in services.store.actions.list(run=run)]
            return during, messages, last, plans, asked

    during, messages, job, plans, asked = asyncio.run(story())
    assert during.state == "paused"
    assert during.remark.startswith("not all of this run is in the database yet: PostgreSQL")
    assert "start it" in during.remark
    assert [said["seq"] for said in messages if said["type"] == "entry"][-1] > 100
    assert (job.state, [job.result["plan"]]) == ("done", plans)
    assert asked == [(f"run.{verb}", "done") for verb in ("speed", "resume", "pause", "start")]


@pytest.mark.long
def test_a_run_and_then_its_server_are_killed_and_another_goes_on(postgresql_url):
    """On SQLite see test_runs and the campaign."""
    with serving(postgresql_url) as first:
        job = first.http.post("/missions/6T-2R/plans", json={"iterations": 10}).json()["id"]
        plan = until(lambda: first.http.get(f"/jobs/{job}").json()["result"])["plan"]
        run = first.http.post("/runs", json={"plan": plan, "speed": 10}).json()["id"]
        actions, events = f"/runs/{run}/actions", f"/runs/{run}/events"
        until(lambda: len(first.http.get(events).json()) > 5)
        fails = {"verb": "event", "data": {"robot_fails": "r_0"}}
        assert first.http.post(actions, json=fails).status_code == 202
        (runner,) = first.children("muster_control.runs.runner.main")
        kill(runner)
        until(lambda: "resumed" in {entry["kind"] for entry in first.http.get(events).json()})
        waits = first.http.post("/missions/6T-2R/plans", json={"time_limit": 1}).json()["id"]
        first.kill()
    with serving(postgresql_url) as again:
        assert again.http.post(actions, json={"verb": "speed", "data": {"speed": None}}).status_code == 202
        until(lambda: again.http.get(f"/runs/{run}").json()["state"] == "ended")
        assert again.http.get(f"/records/{run}/record.mcap").content.startswith(b"\x89MCAP")
        assert "<html" in again.http.get(f"/records/{run}/page.html").text
        until(lambda: again.http.get(f"/jobs/{waits}").json()["state"] == "done")
        again.end()
    store = Store.open(postgresql_url)
    log = judge(store, run, [task.id for task in muster.load("6T-2R").tasks], 2)
    assert [entry.data["verb"] for entry in log if entry.kind == "command"] == ["event", "speed"]
    asked = {(action.verb, action.outcome) for action in store.actions.list(run=run)}
    assert asked == {(f"run.{verb}", "done") for verb in ("start", "event", "speed")}
    assert sorted(plan.id for plan in store.plans.list()) == sorted(one.result["plan"] for one in store.jobs.list())
    store.close()
