"""What is thrown away, and what stays."""

import time
from concurrent.futures import ThreadPoolExecutor
from dataclasses import astuple
from datetime import UTC, datetime, timedelta

import pytest
from sqlalchemy import select, text, update
from tests.muster_control.store.conftest import SUMMARY

from muster_control.contract import NotFoundError, StoreError, User
from muster_control.store import Store
from muster_control.store.prune import Pruned, _delete, prune
from muster_control.store.schema import actions, jobs, mission_files, mission_versions, plans, pruning, runs

LONG_AGO = datetime.now(UTC) - timedelta(days=100)


def age(store, table, *columns):
    """All that is in a table now was written long ago."""
    with store.database.writing() as connection:
        connection.execute(update(table).values(dict.fromkeys(columns, LONG_AGO)))


def make_old(store):
    for table, *columns in ((runs, "at"), (jobs, "asked_at"), (actions, "at"), (plans, "at"), (mission_versions, "at")):
        age(store, table, *columns)
    with store.database.writing() as connection:
        for table in (runs, jobs):
            connection.execute(update(table).where(table.c.ended_at.is_not(None)).values(ended_at=LONG_AGO))


@pytest.fixture
def old(filled):
    """An old run that is over, an old one that is not, jobs, actions, versions; then the same anew."""
    store = filled.store
    store.log.append(filled.run, 1.0, [filled.entry(1), filled.entry(2)], [filled.stretch(1)])
    store.actions.add(User("bo", "command"), "run.pause", {}, filled.run)
    store.actions.add(User("bo", "command"), "login", {})
    store.runs.set(filled.run, state="ended")
    store.jobs.end(store.jobs.add("plan", "Yard", 1, {}, "ann").id, "failed")
    filled.start = store.plans.add("Yard", 1, "planned", "ann", {}).id
    store.jobs.add("plan", "Yard", 1, {"start": filled.start}, "ann")  # queued
    filled.unused = store.plans.add("Yard", 1, "planned", "ann", {}).id
    store.jobs.end(store.jobs.add("plan", "Yard", 1, {"start": filled.unused}, "ann").id, "cancelled")
    filled.under_way_plan = store.plans.add("Yard", 1, "planned", "ann", {}).id
    filled.under_way = store.runs.add("Yard", 1, filled.under_way_plan, "kinematic", {}, 1.0, "ann").id
    store.missions.save("Yard", "2", {"old.png": b"old"}, SUMMARY, "ann", "", 1)
    store.missions.save("Yard", "3", {}, SUMMARY, "ann", "", 2)
    filled.newest_plan = store.plans.add("Yard", 3, "planned", "ann", {}).id
    store.missions.create("Forgotten", "", {"map.png": b"gone"}, SUMMARY, "ann")
    store.missions.delete("Forgotten")
    make_old(store)
    store.actions.add(User("bo", "command"), "login", {})
    return filled


GONE = Pruned(
    runs=1, entries=2, stretches=1, actions=2, jobs=2, plans=2, mission_versions=2, missions=1, files=2
)  # plans: of the run, and the unused; versions: 2 of Yard, 1 of Forgotten; files: old.png, gone


def test_what_goes_and_what_stays(old, database_url):
    store = old.store
    assert prune(database_url, 30, dry_run=True) == GONE
    assert [run.id for run in store.runs.list()] == [old.under_way, old.run]  # nothing went yet
    assert prune(database_url, 30) == GONE
    assert [run.id for run in store.runs.list()] == [old.under_way]
    assert store.log.entries(old.run) == []
    assert [plan.id for plan in store.plans.list()] == [old.newest_plan, old.under_way_plan, old.start]
    assert [version.version for version in store.missions.versions("Yard")] == [3, 1]
    assert dict(store.missions.get("Yard", 1).files) == {"map.png": b"\x00\x89"}
    with pytest.raises(NotFoundError):
        store.missions.versions("Forgotten")
    assert [job.state for job in store.jobs.list()] == ["queued"]
    assert [action.verb for action in store.actions.list()] == ["login"]
    assert set(astuple(prune(database_url, 30))) == {0}


def test_what_is_young_stays(old, database_url):
    assert set(astuple(prune(database_url, 200))) == {0}
    assert len(old.store.runs.list()) == 2


def test_a_version_stays_whose_plan_a_job_goes_on_from(filled, database_url):
    store = filled.store
    start = store.plans.add("Yard", 1, "planned", "ann", {}).id
    store.missions.save("Yard", "2", {}, SUMMARY, "ann", "", 1)
    store.plans.add("Yard", 2, "planned", "ann", {})
    store.jobs.begin(store.jobs.add("plan", "Yard", 2, {"start": start}, "ann").id)
    make_old(store)
    prune(database_url, 30)
    assert store.plans.get(start).mission_version == store.missions.get("Yard", 1).version == 1


def test_numbers_are_not_given_again(old, database_url):
    last = old.store.runs.add("Yard", 3, old.newest_plan, "kinematic", {}, 1.0, "ann").id
    old.store.runs.set(last, state="cancelled")
    make_old(old.store)
    prune(database_url, 30)
    assert old.store.runs.add("Yard", 3, old.newest_plan, "kinematic", {}, 1.0, "ann").id == last + 1
    assert old.store.plans.add("Yard", 3, "planned", "ann", {}).version == 6


def test_only_pruning_may_delete_of_the_log_and_it_leaves_no_door_open(old, database_url):
    store = old.store
    old.run = old.under_way
    store.log.append(old.under_way, 1.0, [old.entry(1)])
    prune(database_url, 30)
    with store.database.reading() as connection:
        assert connection.execute(select(pruning)).all() == []
    with pytest.raises(StoreError, match="only grows"), store.database.writing() as connection:
        connection.execute(text("DELETE FROM entries"))
    assert len(store.log.entries(old.under_way)) == 1


def test_a_server_at_work_goes_on(old, database_url):
    """Pruning has a connection of its own: a store that is open sees what is left, and writes on."""
    server = Store.open(database_url)
    prune(database_url, 0)
    old.run = old.under_way
    assert server.log.append(old.under_way, 1.0, [old.entry(1)]) == 1
    server.close()


def _until_over_or_waiting(store, writing):
    """For pruning, which has a lock."""
    until = time.monotonic() + 30
    while not writing.done():
        with store.database.reading() as connection:
            if connection.execute(text("SELECT 1 FROM pg_locks WHERE NOT granted")).first():
                return
        assert time.monotonic() < until
        time.sleep(0.02)


def test_a_version_is_pruned_whole_or_not_at_all_when_a_server_writes_of_it_meanwhile(postgresql_url, monkeypatch):
    """SQLite has one writer, so nobody can."""
    store = Store.open(postgresql_url)
    store.missions.create("Yard", "1", {"old.png": b"old"}, SUMMARY, "ann")
    store.missions.save("Yard", "2", {}, SUMMARY, "ann", "", 1)
    make_old(store)
    writings = []

    def delete(connection, table, condition):
        deleted = _delete(connection, table, condition)
        if table is mission_files:
            writings.append(other.submit(store.jobs.add, "plan", "Yard", 1, {}, "ann"))
            _until_over_or_waiting(store, writings[0])
        return deleted

    monkeypatch.setattr("muster_control.store.prune._delete", delete)
    with ThreadPoolExecutor(1) as other:
        pruned = prune(postgresql_url, 30)
    assert (pruned.mission_versions, pruned.files) == (1, 1)
    with pytest.raises(StoreError):
        writings[0].result()
    with pytest.raises(NotFoundError):
        store.missions.get("Yard", 1)
    store.close()
