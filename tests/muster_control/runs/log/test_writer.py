"""What a log writer keeps while the database is slow or refuses, and what it says of what it cannot keep."""

import asyncio
import logging
import threading

import pytest
from tests.muster_control.runs.store import planned

import muster
from muster_control.contract import Entry, StoreError, Tick
from muster_control.runs.log import writer as module
from muster_control.runs.log.journal import Journal
from muster_control.runs.log.journal_replay import replay
from muster_control.runs.log.writer import LogWriter

PIECE = b"x" * 100


@pytest.fixture
def run(store, monkeypatch):
    """The id of a run; three stretches fit into memory, and a database that says nothing is slow at once."""
    monkeypatch.setattr(module, "TRACKS_MOST", 3 * len(PIECE))
    monkeypatch.setattr(module, "PATIENCE_S", 0.0)
    monkeypatch.setattr(module, "AGAIN_S", 0.05)
    return store.runs.add(
        "6T-2R", 1, planned(store, muster.load("6T-2R"), iterations=1), "kinematic", {}, 1.0, "ada"
    ).id


def journalled(store, run, story):
    """Run a story with a log writer, to the end of both; returns whether all was written."""

    async def whole():
        journal = Journal(store.database.file.with_name("journal"))
        told = {"on_entries": len, "on_actions": len, "on_trouble": len, "on_lost": pytest.fail}
        log_writer = LogWriter(store, run, journal, **told)
        await story(log_writer)
        written = await log_writer.close()
        await journal.close()
        return written

    return asyncio.run(asyncio.wait_for(whole(), 60))


def add(log_writer, numbers):
    for k in numbers:
        log_writer.add_stretch(k - 1.0, float(k), PIECE)


async def until(condition):
    while not condition():
        await asyncio.sleep(0.01)


def kept(store, run):
    return [(one.seq, one.until_s) for one in store.log.stretches(run)]


def test_a_slow_database_loses_no_tracks_but_those_that_do_not_fit(store, run, monkeypatch, caplog):
    writing, goes_on, append = threading.Event(), threading.Event(), store.log.append

    def slow(*arguments):
        writing.set()
        assert goes_on.wait(30)
        return append(*arguments)

    monkeypatch.setattr(store.log, "append", slow)

    async def story(log_writer):
        add(log_writer, [1, 2])
        await until(lambda: writing.is_set() and log_writer.trouble)
        add(log_writer, [3, 4, 5, 6, 7])  # two too many
        goes_on.set()
        await log_writer.drained()

    with caplog.at_level(logging.WARNING, "muster.runs"):
        assert journalled(store, run, story)
    assert kept(store, run) == [(1, 1.0), (2, 2.0), (3, 5.0), (4, 6.0), (5, 7.0)]
    said = [record.getMessage() for record in caplog.records]
    assert said[:3] == [
        f"run {run}: the database takes its time",
        f"run {run}: more than 300 bytes of tracks wait; the oldest are lost",
        f"run {run}: the database works again; all is kept but 2 stretches of tracks",
    ]
    assert sum("are lost" in message for message in said) == 1


def test_tracks_that_the_database_refused_are_written_in_order(store, run, monkeypatch):
    refusals, append = [0, 0], store.log.append

    def refusing(*arguments):
        if refusals:
            refusals.pop()
            raise StoreError("m.db: full")
        return append(*arguments)

    monkeypatch.setattr(store.log, "append", refusing)

    async def story(log_writer):
        add(log_writer, [1])
        await until(lambda: len(refusals) < 2)
        add(log_writer, [2, 3])
        await log_writer.drained()

    assert journalled(store, run, story)
    assert kept(store, run) == [(1, 1.0), (2, 2.0), (3, 3.0)]


def test_the_journal_has_where_bodies_are_when_the_database_has_nothing_yet(store, run, monkeypatch):
    def refusing(*_):
        raise StoreError("the server is gone")

    monkeypatch.setattr(store.log, "append", refusing)
    entries = [Entry(run=run, seq=k, time_s=0.0, kind="sets_out", data={}) for k in (1, 2, 3)]

    async def story(log_writer):
        log_writer.add(entries[:2], {"seq": 2, "time_s": 0.0})
        await until(lambda: log_writer.trouble)
        log_writer.add(entries[2:], {"seq": 3, "time_s": 0.1})

    assert not journalled(store, run, story)
    journal = Journal(store.database.file.with_name("journal"))
    assert [one for one in journal.read() if isinstance(one, Tick)] == [
        Tick(run=run, seq=2, bodies={"seq": 2, "time_s": 0.0}),
        Tick(run=run, seq=3, bodies={"seq": 3, "time_s": 0.1}),
    ]
    monkeypatch.undo()
    replay(journal, store)
    assert [entry.seq for entry in store.log.entries(run)] == [1, 2, 3]
    assert store.log.bodies(run) == {"seq": 3, "time_s": 0.1}


def test_entries_are_written_with_where_bodies_were_after_them_though_they_move_on_meanwhile(store, run, monkeypatch):
    writing, goes_on, append = threading.Event(), threading.Event(), store.log.append
    seen = []

    def slow(*arguments):
        writing.set()
        assert goes_on.wait(30)
        result = append(*arguments)
        seen.append(([entry.seq for entry in store.log.entries(run)], store.log.bodies(run)))
        return result

    monkeypatch.setattr(store.log, "append", slow)

    async def story(log_writer):
        log_writer.add([Entry(run=run, seq=1, time_s=0.0, kind="sets_out", data={})], {"seq": 1})
        await until(writing.is_set)
        log_writer.add([Entry(run=run, seq=2, time_s=0.0, kind="sets_out", data={})], {"seq": 2})
        goes_on.set()
        await log_writer.drained()

    assert journalled(store, run, story)
    assert seen == [([1], {"seq": 1}), ([1, 2], {"seq": 2})]
