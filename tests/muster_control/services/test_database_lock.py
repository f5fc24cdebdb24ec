"""One server a database: a second one is refused, also by another process, and a crash frees it."""

import asyncio
import os
import signal
import subprocess
import sys
import threading
import time
from concurrent.futures import ThreadPoolExecutor
from contextlib import contextmanager

import psycopg
import pytest
from tests.muster_control.databases import *  # noqa: F403 - fixtures
from tests.muster_control.runs.store import ADA, planned

import muster
from muster_control.contract import StoreError
from muster_control.services.database_lock import TakenError, alone_with
from muster_control.services.services import open_services
from muster_control.settings import Settings
from muster_control.store import Store

_WRITING = 0x6D757374657201  # the lock of those who write
_HOLD = """
import sys, time
from muster_control.services.database_lock import alone_with
with alone_with(sys.argv[1]):
    print("held", flush=True)
    time.sleep(600)
"""


def _free(url):
    """PostgreSQL needs a moment to see that the other process is gone."""
    until = time.monotonic() + 30
    while True:
        try:
            with alone_with(url):
                return
        except StoreError:
            assert time.monotonic() < until
            time.sleep(0.05)


def _refused(url, said):
    with pytest.raises(StoreError, match=said), alone_with(url):
        pass


def _hold_and_crash(url, said):
    with alone_with(url):
        _refused(url, said)
    with subprocess.Popen([sys.executable, "-c", _HOLD, url], stdout=subprocess.PIPE, text=True) as other:
        assert other.stdout.readline() == "held\n"
        _refused(url, said)
        other.send_signal(signal.SIGKILL)
        other.wait()
    _free(url)


def test_of_sqlite(tmp_path):
    _hold_and_crash(f"sqlite:///{tmp_path}/new/muster.db", "in use by process [0-9]+; expected one server a database")
    with alone_with(f"sqlite:///{tmp_path}/a.db"), alone_with(f"sqlite:///{tmp_path}/b.db"):
        assert (tmp_path / "a.db.lock").read_text() == f"{os.getpid()}\n"


def test_of_sqlite_by_another_name(tmp_path):
    """SQLite writes the same file by it."""
    (tmp_path / "there").mkdir()
    (tmp_path / "b.db").symlink_to(tmp_path / "a.db")
    with alone_with(f"sqlite:///{tmp_path}/a.db"):
        for name in ("b.db", "there/../a.db"):
            _refused(f"sqlite:///{tmp_path}/{name}", "in use by process")


@pytest.mark.long
def test_of_postgresql(postgresql_url):
    _hold_and_crash(postgresql_url, "in use by another server; expected one server a database")


def test_a_server_that_is_not_there():
    url = "postgresql://u:secret@localhost:1/x"
    said = r"PostgreSQL x at localhost:1: the server is gone; start it, or look at the network"
    with pytest.raises(StoreError, match=said) as raised, alone_with(url):
        pass
    assert "secret" not in str(raised.value)


def test_a_folder_that_cannot_be_written():
    _refused("sqlite:////proc/x/muster.db", "/proc/x/muster.db.lock: .*expected a folder that can be written")


@contextmanager
def _store(url, lock):
    store = Store.open(url)
    store.database.require = lock.require
    try:
        yield store
    finally:
        store.close()


def _end_session(url):
    """As an administrator, a fail-over or a network does; the connections that write live on."""
    with psycopg.connect(url, autocommit=True) as connection:
        ended = connection.execute(
            "SELECT pg_terminate_backend(pid, 5000) FROM pg_stat_activity"
            " WHERE application_name = 'muster lock' AND datname = current_database()"
        ).fetchall()
    assert ended == [(True,)]


@contextmanager
def _next_in_line(url):
    """Another server, which gets the lock in the moment in which it is free."""
    with psycopg.connect(url, autocommit=True, application_name="next") as other:
        yield lambda: other.execute("SELECT pg_advisory_lock(%s)", (0x6D757374657200,))


def _until_somebody_waits(url):
    """For a lock that another has."""
    until = time.monotonic() + 30
    with psycopg.connect(url) as connection:
        while not connection.execute("SELECT 1 FROM pg_locks WHERE NOT granted").fetchall():
            assert time.monotonic() < until
            time.sleep(0.02)


def _until_nobody_writes(url):
    """What was begun before the lock was lost has ended: the lock of those who write is free."""
    with psycopg.connect(url, autocommit=True) as connection:
        connection.execute("SELECT pg_advisory_lock(%s)", (_WRITING,))


@pytest.mark.long
def test_a_lock_that_was_lost_is_taken_anew_and_nothing_is_written_before(postgresql_url):
    with alone_with(postgresql_url) as lock, _store(postgresql_url, lock) as store:
        lock.look()
        store.check()
        _end_session(postgresql_url)
        with pytest.raises(StoreError, match="another server may have it"):
            store.check()
        lock.look()
        store.check()
        _refused(postgresql_url, "in use by another server")


def test_after_an_outage_one_of_two_servers_has_the_database(postgresql, postgresql_url):
    with alone_with(postgresql_url) as first, _store(postgresql_url, first) as old:
        postgresql.stop()
        first.look()  # which goes on looking
        postgresql.start()
        with alone_with(postgresql_url) as second, _store(postgresql_url, second) as new:
            with pytest.raises(StoreError):
                old.check()
            new.check()
            with pytest.raises(TakenError, match="in use by another server"):
                first.look()
            with pytest.raises(StoreError):
                old.check()
            new.check()


def test_what_one_server_has_begun_to_write_ends_before_the_next_one_reads(postgresql_url):
    with alone_with(postgresql_url) as lock, _store(postgresql_url, lock) as store:
        with store.database.writing():
            _end_session(postgresql_url)
            with psycopg.connect(postgresql_url, autocommit=True) as other:
                other.execute("SET lock_timeout = '200ms'")
                with pytest.raises(psycopg.errors.LockNotAvailable):
                    other.execute("SELECT pg_advisory_lock(%s)", (_WRITING,))
        lock.look()


async def _under_way(services):
    """A run of which something has happened."""
    plan = await asyncio.to_thread(planned, services.store, muster.load("31T-6R50"))
    run = await services.runs.start(ADA, plan, speed=1.0)
    while not await services.runs.entries(run.id):
        await asyncio.sleep(0.05)
    return run


@pytest.mark.long
def test_a_server_whose_database_another_takes_carries_nothing_out_any_more(postgresql_url, monkeypatch):
    monkeypatch.setattr("muster_control.services.services._LOOK_S", 0.1)

    async def story():
        async with open_services(Settings(database=postgresql_url, workers=1)) as services:
            run = await _under_way(services)
            with _next_in_line(postgresql_url) as take:
                taking = asyncio.create_task(asyncio.to_thread(take))
                await asyncio.to_thread(_until_somebody_waits, postgresql_url)
                await asyncio.to_thread(_end_session, postgresql_url)
                await taking
                await asyncio.to_thread(_until_nobody_writes, postgresql_url)
                last = len(services.store.log.entries(run.id))
                with pytest.raises(TakenError, match="in use by another server; expected one server a database"):
                    await asyncio.wait_for(asyncio.shield(services.taken), 20)
                assert (services.runs.under_way, services.runs.pid(run.id)) == (0, None)
                with pytest.raises(StoreError):
                    await services.runs.start(ADA, run.plan)
                assert len(services.store.log.entries(run.id)) == last
                assert services.store.runs.get(run.id).state in ("starting", "running")

    asyncio.run(story())


@pytest.mark.long
def test_the_command_ends_when_another_server_takes_its_database(postgresql_url, tmp_path):
    environment = {**os.environ, "XDG_DATA_HOME": str(tmp_path), "MUSTER_DB": postgresql_url}
    command = [sys.executable, "-m", "muster.cli", "serve", "--port", "0"]
    with (
        subprocess.Popen(
            command, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, env=environment, cwd=tmp_path
        ) as server,
        _next_in_line(postgresql_url) as take,
        ThreadPoolExecutor(1) as other,
    ):
        assert server.stdout.readline().startswith("mission control: ")
        taken = other.submit(take)
        _until_somebody_waits(postgresql_url)
        _end_session(postgresql_url)
        taken.result()
        _, said = server.communicate(timeout=60)
    assert server.returncode == 2
    assert said.splitlines()[-1].endswith(
        "in use by another server; expected one server a database (--db names another)"
    )
    assert "Traceback" not in said


@pytest.mark.long
def test_closing_waits_for_no_look_that_hangs_with_the_database(postgresql_url, monkeypatch):
    monkeypatch.setattr("muster_control.services.services._LOOK_S", 0.1)
    looking, answer, ended = threading.Event(), threading.Event(), threading.Event()

    def look(_):
        looking.set()
        answer.wait(60)
        ended.set()

    monkeypatch.setattr("muster_control.services.database_lock._SessionLock._look", look)

    async def story():
        async with open_services(Settings(database=postgresql_url, workers=1)) as services:
            run = await _under_way(services)
            await asyncio.to_thread(looking.wait, 60)
        assert (services.runs.under_way, services.runs.pid(run.id)) == (0, None)
        assert not ended.is_set()

    try:
        asyncio.run(story())
        assert not ended.is_set()
        _refused(postgresql_url, "in use by another server")  # the look has the session yet
    finally:
        answer.set()
    _free(postgresql_url)


_HANG = """
import sys, threading
from muster.cli.main import run
from muster_control.services.database_lock import _SessionLock
def look(_):
    print("looks", flush=True)
    threading.Event().wait()
_SessionLock._look = look
sys.exit(run(["serve", "--port", "0"]))
"""


@pytest.mark.long
def test_the_command_ends_while_a_look_hangs(postgresql_url, tmp_path):
    environment = {**os.environ, "XDG_DATA_HOME": str(tmp_path), "MUSTER_DB": postgresql_url}
    with subprocess.Popen(
        [sys.executable, "-c", _HANG], stdout=subprocess.PIPE, text=True, env=environment, cwd=tmp_path
    ) as server:
        try:
            while server.stdout.readline() not in ("looks\n", ""):
                pass
            server.send_signal(signal.SIGTERM)
            assert server.wait(60) == 0
        finally:
            server.kill()
