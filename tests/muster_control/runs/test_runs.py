"""Runs as the API and the pages have them: with their own processes, a real database, and what may go wrong with it."""

import asyncio
import json
import os
import signal
import sqlite3
from contextlib import asynccontextmanager, closing
from dataclasses import replace
from itertools import pairwise
from threading import Event
from types import SimpleNamespace

import pytest
from sqlalchemy import create_engine, event
from tests.muster_control.runs.stage import performed
from tests.muster_control.runs.store import ADA, EVE, planned, settings_of

import muster
from muster.mission.errors import ParameterError
from muster.mission.reading.plan_reader import plan_from
from muster.mission.yaml_writer import yaml_text
from muster_control.contract import BusyError, ConflictError, Entry, ForbiddenError, NotFoundError, StoreError
from muster_control.services.records import Records
from muster_control.services.runs import Runs
from muster_control.work.pool import Pool


@asynccontextmanager
async def opened(store, **settings):
    runs = Runs(store, settings_of(store, **settings))
    await runs.start_up()
    try:
        yield runs
    finally:
        await runs.close()


async def watched(runs, run, until=lambda message: False, after=0):
    messages = []
    async for text in runs.subscribers(run).watch(after):
        messages.append(json.loads(text))
        if until(messages[-1]):
            break
    return messages


async def gone(runs, run):
    while runs.subscribers(run) is not None:
        await asyncio.sleep(0.01)


@pytest.mark.long
def test_a_run_is_told_to_watchers_as_it_is_logged_and_becomes_a_record(store):
    mission = muster.load("31T-6R50")
    plan = planned(store, mission)

    async def story():
        async with opened(store) as runs:
            run = await runs.start(ADA, plan, speed=None)
            one, other = await asyncio.gather(watched(runs, run.id), watched(runs, run.id))
            pool = Pool(workers=1, memory_mb=2048)
            records = Records(store, pool, runs)
            assert [one.id for one in await runs.over()] == [run.id]  # as soon as watchers know that it is over
            made = [await records.flown(run.id), await records.page(run.id), await records.mcap(run.id)]
            made += [await records.export(run.id, "csv"), await records.export(run.id, "json")]
            await pool.close()
            return run.id, one, other, made

    run, one, other, (flown, page, mcap, tables, log) = asyncio.run(story())
    for messages in (one, other):
        assert messages[0]["type"] == "hello"
        assert [robot["id"] for robot in messages[0]["mission"]["robots"]] == [r.id for r in mission.robots]
        entries = [message for message in messages if message["type"] == "entry"]
        kept = store.log.entries(run)
        assert [(e["seq"], e["kind"], e["data"]) for e in entries] == [(e.seq, e.kind, e.data) for e in kept]
        assert {message["type"] for message in messages} == {"hello", "entry", "states", "status", "run"}
    assert messages[-1] == {
        "type": "run",
        "state": "ended",
        "speed": None,
        "time_s": kept[-1].time_s,
        "remark": "",
        "share": None,
    }
    found = store.runs.get(run)
    assert (found.state, found.report) == ("ended", kept[-1].data)
    assert {row["task"] for row in flown["tasks"]} == {task.id for task in mission.tasks}
    for row in flown["robots"]:
        assert row["travelled_m"] <= row["usage_flown"] + 0.1
    assert "<html" in page
    assert mcap.startswith(b"\x89MCAP0")
    assert set(tables) == {"tracks.csv", "events.csv"}
    assert set(log) == {"log.json"}


def test_a_record_that_is_refused_reads_nothing(store, monkeypatch):
    run = store.runs.add("6T-2R", 1, planned(store, muster.load("6T-2R")), "kinematic", {}, 1.0, "ada").id
    store.runs.set(run, state="ended")
    monkeypatch.setattr(store.log, "entries", lambda *_: pytest.fail("a log is read"))

    async def busy(*_, **__):
        raise BusyError("64 requests wait")

    with pytest.raises(BusyError):
        asyncio.run(Records(store, SimpleNamespace(run=busy), Runs(store, settings_of(store))).page(run))


def test_a_record_is_found_behind_many_runs(store):
    plan = planned(store, muster.load("6T-2R"))
    first, *others = (store.runs.add("6T-2R", 1, plan, "kinematic", {}, 1.0, "ada").id for _ in range(3))
    store.runs.set(first, state="ended")
    runs = Runs(store, settings_of(store))
    assert [run.id for run in asyncio.run(runs.over(limit=1))] == [first]
    store.runs.set(others[0], state="failed")
    assert [run.id for run in asyncio.run(runs.over())] == [others[0], first]


@pytest.mark.long
def test_a_runner_that_is_killed_goes_on_where_it_was(store):
    plan = planned(store, muster.load("31T-6R50"))

    async def story():
        async with opened(store) as runs:
            run = (await runs.start(ADA, plan, speed=20.0)).id
            await watched(runs, run, lambda m: m["type"] == "states" and m["time_s"] > 5)
            await runs.act(ADA, run, "pause")
            await watched(runs, run, lambda m: m["type"] == "run" and m["state"] == "paused")
            os.kill(runs.pid(run), signal.SIGKILL)
            await runs.act(ADA, run, "event", {"robot_fails": "r_0"})
            await runs.act(ADA, run, "speed", {"speed": None})
            await runs.act(ADA, run, "resume")
            await watched(runs, run)
            await gone(runs, run)
            return run

    run = asyncio.run(story())
    found, log = store.runs.get(run), store.log.entries(run)
    assert (found.state, found.resumed, found.speed) == ("ended", 1, None)
    assert [entry.data["verb"] for entry in log if entry.kind == "command"] == ["pause", "event", "speed", "resume"]
    (pause, fails) = [entry.time_s for entry in log if entry.kind == "command"][:2]
    assert pause == fails
    assert {action.outcome for action in store.actions.list(run=run)} == {"done"}


def test_a_runner_that_dies_of_itself_again_and_again_fails_the_run(store, monkeypatch):
    plan = planned(store, muster.load("31T-6R50"))
    monkeypatch.setenv("PYTHONHOME", "/nowhere")

    async def story():
        async with opened(store) as runs:
            run = (await runs.start(ADA, plan)).id
            await gone(runs, run)
            return run

    found = store.runs.get(asyncio.run(story()))
    assert found.state == "failed"
    assert "its process ended 3 times in a row, at 0.0 s" in found.remark


class Pragma:
    """Statements that each connection of a store is given before it is used."""

    def __init__(self, store):
        self.statements = ()
        event.listen(store.database._engine, "checkout", self._checked_out)

    def _checked_out(self, connection, *_):
        for statement in self.statements:
            connection.execute(statement).close()


FULL = ("PRAGMA max_page_count = 1",)
READ_ONLY = ("PRAGMA query_only = ON",)
WORKS = ("PRAGMA max_page_count = 1000000", "PRAGMA query_only = OFF")


@pytest.mark.long
@pytest.mark.parametrize(("refuses", "why"), [(FULL, "the disk is full"), (READ_ONLY, "may only be read")])
def test_while_the_database_refuses_the_run_goes_on_in_memory_and_is_written_later(store, refuses, why):
    plan, pragma = planned(store, muster.load("31T-6R50")), Pragma(store)

    async def story():
        async with opened(store) as runs:
            run = (await runs.start(ADA, plan, speed=10.0)).id
            await watched(runs, run, lambda m: m["type"] == "states" and m["time_s"] > 1)
            await runs.act(ADA, run, "pause")
            await watched(runs, run, lambda m: m["type"] == "run" and m["state"] == "paused")
            pragma.statements = refuses
            action = await runs.act(ADA, run, "speed", {"speed": None})
            await runs.act(ADA, run, "resume")
            messages = await watched(runs, run)
            during = await runs.get(run), len(await runs.entries(run)), len(store.log.entries(run))
            with pytest.raises(StoreError, match="is not kept yet"):
                await Records(store, None, runs).mcap(run)
            pragma.statements = WORKS
            await gone(runs, run)
            return run, messages, during, action

    run, messages, (during, said, kept), action = asyncio.run(story())
    assert during.state == "ended"
    assert during.remark.startswith("not all of this run is in the database yet: ")
    assert why in during.remark
    assert any(m["type"] == "run" and m["remark"] == during.remark for m in messages)
    assert kept < 60 < 100 < said
    assert [e.seq for e in store.log.entries(run)] == [m["seq"] for m in messages if m["type"] == "entry"]
    assert (store.runs.get(run).state, store.runs.get(run).remark) == ("ended", "")
    assert store.log.last_stretch(run) > 50
    assert not action.kept or refuses is FULL  # which may have room for a few bytes
    asked = {action.verb: (action.outcome, action.who) for action in store.actions.list(run=run)}
    assert asked == dict.fromkeys(("run.start", "run.pause", "run.speed", "run.resume"), ("done", "ada"))


@pytest.mark.long
def test_commands_take_effect_in_the_order_in_which_they_were_given(store, monkeypatch):
    """The database writes the first one after it was asked for the second; robots that were paused last stay paused."""
    plan = planned(store, muster.load("31T-6R50"))
    keep, second = store.actions.keep, Event()

    def slowly(actions):
        if actions[0].verb == "run.resume":
            second.wait(0.3)
        else:
            second.set()
        return keep(actions)

    async def story():
        async with opened(store) as runs:
            run = (await runs.start(ADA, plan, speed=10.0)).id
            monkeypatch.setattr(store.actions, "keep", slowly)
            actions = await asyncio.gather(runs.act(ADA, run, "resume"), runs.act(ADA, run, "pause"))
            told = await watched(runs, run, lambda m: m.get("id") == actions[-1].id)
            await runs.act(ADA, run, "cancel")
            await gone(runs, run)
            return [action.id for action in actions], [one["id"] for one in told if one["type"] == "action"]

    asked, done = asyncio.run(story())
    assert done == asked


@pytest.mark.long
def test_a_pause_does_not_wait_for_a_locked_database_and_is_written_once(store):
    plan = planned(store, muster.load("31T-6R50"))

    async def story():
        async with opened(store) as runs:
            run = (await runs.start(ADA, plan, speed=10.0)).id
            await watched(runs, run, lambda m: m["type"] == "states" and m["time_s"] > 1)
            lock = sqlite3.connect(store.database.file, isolation_level=None)
            lock.execute("BEGIN IMMEDIATE")
            begun = asyncio.get_running_loop().time()
            paused = await runs.act(ADA, run, "pause")
            took = asyncio.get_running_loop().time() - begun
            again = await runs.act(ADA, run, "resume")
            await watched(runs, run, lambda m: m["type"] == "action" and m["id"] == again.id)
            told = asyncio.get_running_loop().time() - begun
            os.kill(runs.pid(run), signal.SIGKILL)  # the next runner obeys neither a second time
            lock.execute("COMMIT")
            lock.close()
            await runs.act(ADA, run, "speed", {"speed": None})
            await watched(runs, run)
            await gone(runs, run)
            return run, (took, told), (paused, again)

    run, took, unsaved = asyncio.run(story())
    assert 0.5 < took[0] < took[1] < 8  # of the database's own patience of 10 s
    assert not any(action.kept for action in unsaved)
    asked = [(action.verb, action.outcome) for action in store.actions.list(run=run)]
    assert asked == [(f"run.{verb}", "done") for verb in ("speed", "resume", "pause", "start")]
    ids = {action.verb: action.id for action in store.actions.list(run=run)}
    assert (ids["run.pause"], ids["run.resume"]) == tuple(action.id for action in unsaved)
    commands = [entry.data["verb"] for entry in store.log.entries(run) if entry.kind == "command"]
    assert commands == ["pause", "resume", "speed"]


@pytest.mark.long
def test_what_the_database_took_late_is_not_done_again_after_a_crash(store):
    """Logs of older Musters name such an action by the negative moment of its request."""
    plan = store.plans.get(planned(store, muster.load("31T-6R50")))
    run = store.runs.add(plan.mission, plan.mission_version, plan.id, "kinematic", {}, None, "ada").id
    late = store.actions.add(ADA, "run.pause", {}, run)
    store.actions.keep([late])  # once is enough
    data = {"action": -late.id, "verb": "pause", "data": {}, "who": "ada", "outcome": "done"}
    asked = ((0.0, "pause", {}), (9e9, "resume", {}))
    job = muster.load("31T-6R50"), plan_from(plan.plan, "plan"), asked
    pause, resume = (k for k, one in enumerate(performed(*job).log) if one["kind"] == "command")
    kept = performed(*job, killed_after=resume)
    log = [Entry(run=run, **one) for one in kept.log]
    log[pause] = replace(log[pause], data=data)
    store.log.append(run, 0.0, log, bodies=kept.bodies)

    async def story():
        async with opened(store) as runs:
            await runs.act(ADA, run, "resume")
            await gone(runs, run)

    asyncio.run(story())
    commands = [entry.data["action"] for entry in store.log.entries(run) if entry.kind == "command"]
    assert commands[0] == -late.id
    assert len(commands) == 2
    assert [action.outcome for action in store.actions.list(run=run)] == ["done", "done"]


@pytest.mark.long
def test_a_runner_is_started_again_while_the_database_is_gone(store, monkeypatch):
    plan = planned(store, muster.load("31T-6R50"))

    async def story():
        async with opened(store) as runs:
            run = (await runs.start(ADA, plan, speed=10.0)).id
            await watched(runs, run, lambda m: m["type"] == "states" and m["time_s"] > 5)
            with monkeypatch.context() as gone_database:
                gone_database.setattr(store.database, "_engine", create_engine("sqlite:////nowhere/muster.db"))
                os.kill(runs.pid(run), signal.SIGKILL)
                await runs.act(ADA, run, "speed", {"speed": None})
                messages = await watched(runs, run, lambda m: m["type"] == "run" and m["state"] == "ended", after=10**6)
            await gone(runs, run)
            return run, messages[-1]

    run, last = asyncio.run(story())
    assert last["remark"].startswith("not all of this run is in the database yet: ")
    log, found = store.log.entries(run), store.runs.get(run)
    assert (found.state, found.resumed, found.remark) == ("ended", 1, "")
    assert [entry.seq for entry in log] == list(range(1, len(log) + 1))
    stretches = list(store.log.stretches(run))
    assert all(a.until_s < b.from_s for a, b in pairwise(stretches))


@pytest.mark.long
def test_who_asks_for_what_cannot_be_is_told(store):
    plan = planned(store, muster.load("yard"))  # in space, which only the runner finds out

    async def story():
        async with opened(store, runs=1) as runs:
            with pytest.raises(ForbiddenError):
                await runs.start(EVE, plan)
            with pytest.raises(NotFoundError):
                await runs.start(ADA, 99)
            wrong = (
                ({"world": "ros1"}, "world: ros1; expected kinematic, physics"),
                ({"speed": 0}, "speed: 0; expected a finite number, at least 0.001"),
                ({"settings": {"colour": "red"}}, "colour: unknown"),
                ({"settings": {"dt_s": 7}}, "dt_s: 7; expected"),
                ({"settings": {"avoidance": "no such"}}, 'avoidance: "no such"; expected auto or orca'),
            )
            for how, why in wrong:
                with pytest.raises(ParameterError, match=why):
                    await runs.start(ADA, plan, **how)
            run = (await runs.start(ADA, plan, speed=1.0, settings={"avoidance": "rvo"})).id
            with pytest.raises(BusyError, match="expected fewer than 1"):
                await runs.start(ADA, plan)
            await gone(runs, run)
            with pytest.raises(ConflictError, match="is over: failed"):
                await runs.act(ADA, run, "pause")
            with pytest.raises(ParameterError, match="verb: stop"):
                await runs.act(ADA, run, "stop")
            return await runs.get(run)

    found = asyncio.run(story())
    assert (found.state, "the mission is in space" in found.remark) == ("failed", True)


def test_what_is_refused_is_written_down(store):
    plan, told = planned(store, muster.load("31T-6R50")), []

    async def story():
        runs = Runs(store, settings_of(store), lambda *what: told.append(what))
        for start in ({"world": "mavlink"}, {"speed": float("inf")}, {"plan": 99}):
            with pytest.raises((ParameterError, NotFoundError)):
                await runs.start(ADA, **{"plan": plan, **start})
        for verb, data in (("cancel", None), ("stop", None), ("event", {"robot_fails": "\ud800"})):
            with pytest.raises((ParameterError, NotFoundError)):
                await runs.act(ADA, 99, verb, data)
        for call in (runs.start(EVE, plan), runs.act(EVE, 99, "pause")):
            with pytest.raises(ForbiddenError):
                await call

    asyncio.run(story())
    found = [(action.verb, action.outcome, action.applied_s) for action in reversed(store.actions.list())]
    assert found == [
        ("run.start", "world: mavlink; expected kinematic, physics: muster serve has no --bridge mavlink", None),
        # infinity is no JSON: it cannot be written down
        ("run.start", "no plan 99", None),
        ("run.cancel", "no run 99", None),
        ("run.stop", "verb: stop; expected pause, resume, speed, cancel, event, orders", None),
        ("run.event", "data: half a character; expected text in UTF-8", None),
    ]
    assert [action.data for action in store.actions.list() if action.verb == "run.cancel"] == [{"run": 99, "data": {}}]
    assert [(who, verb) for who, verb, _ in told] == [(EVE, "run.start"), (EVE, "run.pause")]


def test_who_is_refused_does_not_wait_for_a_locked_database(store):
    async def story():
        runs = Runs(store, settings_of(store))
        with closing(sqlite3.connect(store.database.file, isolation_level=None)) as lock:
            lock.execute("BEGIN IMMEDIATE")
            begun = asyncio.get_running_loop().time()
            with pytest.raises(NotFoundError):
                await runs.act(ADA, 99, "cancel")
            took = asyncio.get_running_loop().time() - begun
        await runs.close()
        return took

    assert asyncio.run(story()) < 8  # of the database's own patience of 10 s
    assert [action.outcome for action in store.actions.list()] == ["no run 99"]


@pytest.mark.long
@pytest.mark.parametrize("world", ["kinematic", "mavlink"])
def test_a_plan_that_was_cut_short_is_not_carried_out_unless_that_is_accepted(store, world):
    mission = muster.load("6T-2R")
    version = store.missions.create(mission.name, yaml_text(mission), {}, {"name": mission.name}, "ada")
    cut = replace(muster.solve(mission, iterations=10), cut_short=True).as_dict()
    plan = store.plans.add(version.mission, version.version, "planned", "ada", cut).id
    own = {} if world == "kinematic" else {"endpoints": {"r_0": "udp:127.0.0.1:14550"}}

    async def story():
        async with opened(store, bridges=("mavlink",)) as runs:
            words = f"^plan {plan}: planning was cut short; expected a whole plan, or accept_partial: true$"
            with pytest.raises(ConflictError, match=words):
                await runs.start(ADA, plan, world, settings=own)
            with pytest.raises(ConflictError, match=words):
                await runs.start(ADA, plan, world, settings={**own, "accept_partial": False})
            assert store.runs.list() == []
            if world != "kinematic":
                return None
            run = (await runs.start(ADA, plan, speed=None, settings={"accept_partial": True})).id
            await watched(runs, run)
            return await runs.get(run)

    found = asyncio.run(story())
    assert found is None or len(found.report["tasks_done"]) == 6
