"""Copies: whole, of one moment, and back into either database."""

import sqlite3
from contextlib import closing
from threading import Event, Thread

import pytest
from sqlalchemy import select, text
from tests.muster_control.store.conftest import SUMMARY, Filled

from muster.mission.errors import ParameterError
from muster_control.contract import StoreError, User
from muster_control.store import Store
from muster_control.store.backup import backup, restore
from muster_control.store.database_info import database_info
from muster_control.store.schema import metadata


@pytest.fixture(params=["sqlite", "postgresql"])
def other_url(request, tmp_path):
    """A second database, into which a copy goes."""
    if request.param == "sqlite":
        return f"sqlite:///{tmp_path}/other/muster.db"
    return request.getfixturevalue("postgresql").new()


@pytest.fixture
def full(filled):
    """Something in every table."""
    store = filled.store
    store.missions.save("Yard", "b: ü\n", {"map.png": b"\x00\x89", "t.csv": b"1"}, SUMMARY, "bo", "more", 1)
    job = store.jobs.add("plan", "Yard", 2, {"iterations": 3}, "ann")
    store.jobs.begin(job.id)
    store.jobs.end(job.id, "done", {"plan": filled.plan})
    store.jobs.add("plan", "Yard", 1, {}, "ann")
    store.actions.settle(store.actions.add(User("bo", "command"), "run.pause", {}, filled.run).id, "done", 1.25)
    entries = [filled.entry(k, text="x" * k) for k in range(1, 501)]
    store.log.append(filled.run, 250.0, entries, [filled.stretch(k) for k in range(1, 4)])
    store.log.append(filled.run, 251.0, [filled.entry(501, "report", done=3)])
    store.runs.set(filled.run, state="ended")
    return filled


def rows(store):
    with store.database.snapshot() as connection:
        return {
            table.name: [tuple(row) for row in connection.execute(select(table).order_by(*table.primary_key))]
            for table in metadata.sorted_tables
        }


@pytest.mark.long(keep=2)
def test_a_copy_goes_into_either_database(full, database_url, other_url, tmp_path):
    file = tmp_path / "copy.db"
    backup(database_url, file)
    restore(file, other_url)
    with closing(Store.open(other_url)) as other:
        assert rows(other) == rows(full.store)
        again = other.plans.add("Yard", 2, "planned", "ann", {})  # numbers go on
        assert (again.id, again.version) == (full.plan + 1, 2)
        assert other.jobs.add("plan", "Yard", 1, {}, "ann").id == 3
        with pytest.raises(StoreError, match="only grows"), other.database.writing() as connection:
            connection.execute(text("DELETE FROM entries"))


def test_a_copy_is_one_file_for_its_owner(full, database_url, tmp_path):
    file = tmp_path / "copies" / "copy.db"
    file.parent.mkdir()
    backup(database_url, file)
    assert [f.name for f in file.parent.iterdir()] == ["copy.db"]
    assert file.stat().st_mode & 0o777 == 0o600
    with closing(sqlite3.connect(file)) as plain:
        assert plain.execute("SELECT count(*) FROM entries").fetchone() == (501,)
        assert plain.execute("PRAGMA integrity_check").fetchone() == ("ok",)
    before = file.read_bytes()
    with pytest.raises(ParameterError, match=r"copy\.db: exists; expected the name of a new file"):
        backup(database_url, file)
    assert file.read_bytes() == before


def test_a_copy_while_a_server_writes_is_of_one_moment(filled, database_url, tmp_path):
    """A writer keeps run and log in step; each copy has them in step, without a gap."""
    stop = Event()

    def write():
        seq = 0
        while not stop.is_set():
            seq += 1
            filled.store.log.append(filled.run, float(seq), [filled.entry(seq)], [filled.stretch(seq, b"x" * 5000)])

    writer = Thread(target=write)
    writer.start()
    try:
        for k in range(3):
            backup(database_url, tmp_path / f"{k}.db")
    finally:
        stop.set()
        writer.join()
    lasts = []
    for k in range(3):
        with closing(Store.open(f"sqlite:///{tmp_path}/{k}.db")) as copy:
            last = len(copy.log.entries(filled.run))
            assert copy.runs.get(filled.run).time_s == last == copy.log.last_stretch(filled.run)
            assert [entry.seq for entry in copy.log.entries(filled.run)] == list(range(1, last + 1))
            lasts.append(last)
    assert lasts == sorted(lasts)


@pytest.mark.long(keep=2)
def test_only_an_empty_database_takes_a_copy(full, database_url, other_url, tmp_path):
    file = tmp_path / "copy.db"
    backup(database_url, file)
    with closing(Store.open(other_url)) as other:
        Filled(other)
        before = rows(other)
        with pytest.raises(ParameterError, match=r"holds .* already; expected an empty database"):
            restore(file, other_url)
        assert rows(other) == before


def test_files_that_are_no_copies(tmp_path):
    url = f"sqlite:///{tmp_path}/new.db"
    empty, words = tmp_path / "empty.db", tmp_path / "words.db"
    sqlite3.connect(empty).close()
    words.write_text("words\n" * 1000)
    with pytest.raises(ParameterError, match=r"empty\.db: no backup of mission control"):
        restore(empty, url)
    with pytest.raises(StoreError, match=r"words\.db: is no database of SQLite"):
        restore(words, url)
    with pytest.raises(StoreError, match=r"absent\.db: no such file"):
        restore(tmp_path / "absent.db", url)
    assert not (tmp_path / "new.db").exists()


def test_a_copy_of_a_newer_muster(full, database_url, tmp_path):
    file = tmp_path / "copy.db"
    backup(database_url, file)
    with closing(sqlite3.connect(file)) as plain:
        plain.execute("UPDATE alembic_version SET version_num = '9999'")
        plain.commit()
    with pytest.raises(StoreError, match=r"copy\.db: made by a newer Muster"):
        restore(file, f"sqlite:///{tmp_path}/new.db")


def test_databases_that_are_not_there(tmp_path, postgresql_url):
    with pytest.raises(StoreError, match=r"absent\.db: no such file"):
        backup(f"sqlite:///{tmp_path}/absent.db", tmp_path / "copy.db")
    with pytest.raises(StoreError, match="no tables of mission control"):
        backup(postgresql_url, tmp_path / "copy.db")
    Store.open(postgresql_url).close()
    with pytest.raises(StoreError, match=r"no/copy\.db: No such file or directory; expected a file that"):
        backup(postgresql_url, tmp_path / "no" / "copy.db")
    assert list(tmp_path.iterdir()) == []


def test_contents(full, database_url):
    found = database_info(database_url)
    few = {"missions": 1, "mission_versions": 2, "plans": 1, "jobs": 2, "runs": 1, "stretches": 3, "actions": 1}
    assert found.rows == {**few, "entries": 501}
    assert found.bytes > 100_000
