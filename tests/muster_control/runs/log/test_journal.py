"""The journal of a server: what is synced is read again, also after a power cut, and folded into the database."""

import asyncio
import errno
import os
import threading
from dataclasses import replace

import pytest
from tests.muster_control.runs.played import PLAN, entry, play
from tests.muster_control.runs.store import ADA, planned, settings_of

import muster
from muster_control.contract import Entry, StoreError, Tick
from muster_control.runs.log.journal import Journal
from muster_control.runs.log.journal_replay import replay
from muster_control.services.database_lock import journal_of
from muster_control.services.runs import Runs
from muster_control.store.actions import new_action


@pytest.fixture
def path(tmp_path):
    return tmp_path / "server" / "muster.journal"


@pytest.fixture
def run(store):
    plan = store.plans.get(planned(store, muster.load("31T-6R50"), iterations=1))
    return store.runs.add(plan.mission, plan.mission_version, plan.id, "kinematic", {}, None, "ada").id


def action(run=1, verb="pause", **data):
    return new_action(ADA, f"run.{verb}", data, run)


def logged(run, *said):
    return [Entry(run=run, **{key: one[key] for key in ("seq", "time_s", "kind", "data")}) for one in said]


def written(path, *groups):
    """Append groups of items, all at once; returns what became of each."""

    async def story():
        journal = Journal(path)
        try:
            return await asyncio.gather(*(journal.append(group) for group in groups), return_exceptions=True)
        finally:
            await journal.close()

    return asyncio.run(story())


def read(path):
    journal = Journal(path)
    items = journal.read()
    asyncio.run(journal.close())
    return items


def test_what_was_synced_is_read_again_in_order(path):
    actions, entries = [action(n=n) for n in range(3)], logged(1, PLAN)
    assert written(path, actions[:2], entries, actions[2:]) == [None] * 3
    assert read(path) == [*actions[:2], *entries, actions[2]]
    assert path.stat().st_mode & 0o777 == 0o600


def test_what_comes_while_others_are_synced_is_synced_together(path, monkeypatch):
    syncs, sync, goes_on = [], os.fdatasync, threading.Event()

    def slow(file):
        syncs.append(file)
        assert goes_on.wait(10)
        sync(file)

    monkeypatch.setattr(os, "fdatasync", slow)

    async def story():
        journal, done = Journal(path), []
        first = journal.append([action()])
        while not syncs:
            await asyncio.sleep(0.001)
        rest = [journal.append([action(n=n)]) for n in range(1000)]
        for k, synced in enumerate((first, *rest)):
            synced.add_done_callback(lambda _, k=k: done.append(k))
        assert not first.done()
        goes_on.set()
        await asyncio.gather(first, *rest)
        await journal.close()
        return done

    assert asyncio.run(story()) == list(range(1001))
    assert len(syncs) == 2
    assert len(read(path)) == 1001


@pytest.mark.parametrize("cut", [1, 20])
def test_after_a_power_cut_it_is_read_up_to_the_last_whole_line_and_says_so(path, caplog, cut):
    actions = [action(n=n) for n in range(3)]
    written(path, actions)
    os.truncate(path, path.stat().st_size - cut)
    assert read(path) == actions[:2]
    assert f"{path}: its last line is incomplete and left out; the 2 before it are read" in caplog.text
    assert [file.name for file in path.parent.iterdir()] == [path.name]


def test_of_another_damaged_line_a_copy_is_kept(path, caplog):
    actions = [action(n=n) for n in range(3)]
    written(path, actions)
    data = bytearray(path.read_bytes())
    data[data.index(b"\n") + 30] ^= 1
    path.write_bytes(data)
    assert read(path) == [actions[0], actions[2]]
    assert f"{path}: line 2 is damaged and left out, of 3" in caplog.text
    (copy,) = set(path.parent.iterdir()) - {path}
    assert copy.read_bytes() == data


def test_a_full_disk_refuses_and_leaves_what_was_there(path, monkeypatch):
    before, refused, after = action(), action(), action()
    written(path, [before])
    with monkeypatch.context() as full:
        full.setattr(os, "fdatasync", lambda _: (_ for _ in ()).throw(OSError(errno.ENOSPC, os.strerror(errno.ENOSPC))))
        (error,) = written(path, [refused])
    assert isinstance(error, StoreError)
    assert str(error) == f"{path}: No space left on device; free some space, or make the folder writable"
    written(path, [after])
    assert read(path) == [before, after]


def test_one_server_has_it(path):
    journal = Journal(path)
    with pytest.raises(StoreError, match="in use by another server; expected one server a database"):
        Journal(path)
    asyncio.run(journal.close())
    assert read(path) == []


def test_who_asks_while_the_server_ends_is_refused(path):
    async def story():
        journal = Journal(path)
        await journal.close()
        with pytest.raises(StoreError, match="is closed, as the server ends"):
            await asyncio.wait_for(journal.append([action()]), 10)

    asyncio.run(story())


def test_the_next_server_waits_for_one_that_ends(path):
    before = Journal(path)

    async def story():
        following = asyncio.create_task(asyncio.to_thread(Journal, path, 60.0))
        await before.append([action()])
        await before.close()
        return await following

    journal = asyncio.run(story())
    assert len(journal.read()) == 1
    asyncio.run(journal.close())


def test_it_is_emptied_when_the_database_has_all_of_every_run(path):
    async def story():
        journal = Journal(path)
        await asyncio.gather(journal.append([action(1)]), journal.append([action(2)]))
        for run in (3, 1):
            journal.release(run)
        await journal.append([action(2)])
        assert len(journal.read()) == 3
        journal.release(2)
        await journal.append([last := action(1)])
        assert journal.read() == [last]
        await journal.close()

    asyncio.run(story())


def folded(store, *items):
    """What the database has of a run when the journal with these items is folded in, twice."""
    path = journal_of(settings_of(store))
    for _ in range(2):
        written(path, items)
        journal = Journal(path)
        replay(journal, store)
        assert journal.read() == []
        asyncio.run(journal.close())


def test_the_database_takes_each_item_once_and_in_order(store, run):
    has, outcome = action(run), action(run, "resume")
    store.actions.keep([has])
    store.log.append(run, 0.0, logged(run, PLAN))
    later = entry(2, "command", action=outcome.id, verb="resume", data={}, who="ada", outcome="done")
    settled = replace(outcome, outcome="done", applied_s=2.0)
    folded(store, outcome, has, *logged(run, PLAN, later), settled)
    assert [one.seq for one in store.log.entries(run)] == [1, 2]
    assert store.runs.get(run).time_s == later["time_s"]
    assert [(one.id, one.outcome) for one in store.actions.list(run)] == [(outcome.id, "done"), (has.id, "")]


def test_an_action_of_a_run_that_is_over_has_the_outcome_of_its_log(store, run):
    done, late = action(run), action(run)
    said = entry(2, "command", action=done.id, verb="pause", data={}, who="ada", outcome="done")
    store.log.append(run, 0.0, logged(run, PLAN, said))
    store.runs.set(run, state="ended")
    folded(store, done, late)
    outcomes = {one.id: (one.outcome, one.applied_s) for one in store.actions.list(run)}
    assert outcomes == {done.id: ("done", said["time_s"]), late.id: ("the run was over before", None)}


def test_a_log_with_which_another_server_has_gone_on_stays_and_the_rest_is_kept_beside(store, run, caplog):
    store.log.append(run, 0.0, logged(run, PLAN, entry(2, "resumed", how="there")))
    ours = action(run)
    path = journal_of(settings_of(store))
    written(path, [*logged(run, entry(2, "resumed", how="here")), ours, action(99)])
    journal = Journal(path)
    replay(journal, store)
    asyncio.run(journal.close())
    assert store.log.entries(run)[1].data == {"how": "there"}
    assert [one.id for one in store.actions.list(run)] == [ours.id]
    assert "entry 2 is resumed" in caplog.text
    assert "1 actions: no run 99" in caplog.text
    (copy,) = path.parent.glob(f"{path.name}-*")
    assert copy.stat().st_size > 0


async def stays(runner, begin):
    yield {"type": "mission", "mission": {}}
    yield PLAN
    yield {"type": "going"}
    await runner.gone.wait()


@pytest.mark.parametrize(("verb", "obeyed"), [("pause", True), ("resume", False)])
def test_what_neither_database_nor_journal_takes_is_refused_and_robots_stop_all_the_same(
    store, run, monkeypatch, verb, obeyed
):
    started = play(monkeypatch, stays)

    def refuse(*_):
        raise StoreError("the database is gone; start it")

    def full(*_):
        raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC))

    async def story():
        runs = Runs(store, settings_of(store))
        await runs.start_up()
        while not started:
            await asyncio.sleep(0.01)
        with monkeypatch.context() as away:
            away.setattr(store.actions, "keep", refuse)
            away.setattr(os, "fdatasync", full)
            with pytest.raises(StoreError, match=r"neither the database nor the journal takes it: .*No space left"):
                await runs.act(ADA, run, verb)
        assert started[0].told.qsize() == obeyed
        await runs.kept(run)
        await runs.close()

    asyncio.run(asyncio.wait_for(story(), 30))
    (asked,) = store.actions.list(run)
    assert asked.outcome.startswith("refused: ") != obeyed


def test_of_a_tick_that_a_power_cut_halved_nothing_is_replayed(path, store, run):
    first, second, third = [Entry(run=run, seq=k, time_s=0.0, kind="sets_out", data={}) for k in (1, 2, 3)]
    written(path, [first, second, Tick(run=run, seq=2, bodies={"seq": 2, "time_s": 0.0})], [third])
    journal = Journal(path)
    replay(journal, store)
    asyncio.run(journal.close())
    assert [entry.seq for entry in store.log.entries(run)] == [1, 2]
    assert store.log.bodies(run) == {"seq": 2, "time_s": 0.0}


def test_bodies_that_the_database_has_newer_are_kept(path, store, run):
    entries = [Entry(run=run, seq=k, time_s=0.0, kind="sets_out", data={}) for k in (1, 2)]
    store.log.append(run, 0.0, entries, (), {"seq": 2, "time_s": 0.2})
    written(path, [entries[0], Tick(run=run, seq=1, bodies={"seq": 1, "time_s": 0.1})])
    journal = Journal(path)
    replay(journal, store)
    asyncio.run(journal.close())
    assert store.log.bodies(run) == {"seq": 2, "time_s": 0.2}
