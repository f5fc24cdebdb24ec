"""What fails is told in one line that says what to do, and never tells a password."""

import os
import shutil
import sqlite3
import subprocess
import sys
from concurrent.futures import ThreadPoolExecutor
from contextlib import closing
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st
from sqlalchemy import text
from tests.muster_control.store.conftest import Filled

from muster.mission.errors import MusterError, ParameterError
from muster_control.contract import StoreError, User
from muster_control.store import Store
from muster_control.store.database import Database
from muster_control.store.schema import HEAD
from muster_control.store.urls import database_url, shown

ANN = User("ann", "command")


@pytest.fixture
def file(tmp_path):
    """A database of SQLite that a server has used."""
    file = tmp_path / "muster.db"
    Store.open(f"sqlite:///{file}").close()
    return file


def says(error, *words):
    message = str(error.value)
    assert "\n" not in message
    for word in words:
        assert word in message
    return message


def test_a_full_disk(file):
    """As SQLite meets it: no page more. What was there before stays readable, and room makes it writable again."""
    limited = Store.open(f"sqlite:///{file}")
    filled = Filled(limited)
    limited.log.append(filled.run, 1.0, [filled.entry(1)])
    with limited.database.reading() as connection:  # the one connection of the pool keeps the limit
        pages = connection.execute(text("PRAGMA page_count")).scalar()
        connection.execute(text(f"PRAGMA max_page_count={pages}"))
    large = filled.entry(2, text="x" * 10**6)
    with pytest.raises(StoreError) as error:
        limited.log.append(filled.run, 2.0, [large])
    says(error, str(file), "disk is full", "free some space", "muster db prune")
    assert len(limited.log.entries(filled.run)) == 1
    with limited.database.reading() as connection:
        connection.execute(text("PRAGMA max_page_count=100000"))
    assert limited.log.append(filled.run, 2.0, [large]) == 1
    limited.close()


@pytest.mark.skipif(os.geteuid() != 0 or not shutil.which("mount"), reason="only root can make a small disk")
def test_a_disk_that_is_really_full(tmp_path):
    small = tmp_path / "small"
    small.mkdir()
    mount = ["mount", "-t", "tmpfs", "-o", "size=600k", "tmpfs", str(small)]
    if subprocess.run(mount, capture_output=True).returncode != 0:
        pytest.skip("no small disk can be mounted here")
    try:
        store = Store.open(f"sqlite:///{small}/muster.db")
        with pytest.raises(StoreError) as error:
            store.missions.create("any", "x" * 10**6, {}, {}, "ann")
        says(error, "disk is full")
        assert store.missions.list() == []
        store.close()
    finally:
        subprocess.run(["umount", "-l", str(small)], check=True)


ONLY_READ = """
import os, sys
from muster_control.store import Store
from muster.mission.errors import MusterError
if os.geteuid() == 0:
    os.setgroups([]); os.setgid(65534); os.setuid(65534)
try:
    store = Store.open(sys.argv[1])
    print("opened", len(store.missions.list()))
    store.check()
except MusterError as error:
    print(error)
"""


def tried_by_another(url):
    """What a user says to whom the files do not belong."""
    done = subprocess.run([sys.executable, "-c", ONLY_READ, url], capture_output=True, text=True)
    assert done.stderr == ""
    return done.stdout.splitlines()


ONE_PROCESS = pytest.mark.xdist_group("open folder")
"""As they open folders that processes of tests have in common, and close them again."""


@pytest.fixture
def open_folder(tmp_path):
    """A folder that others may enter, and its parents."""
    folder = tmp_path / "open"
    folder.mkdir()
    changed = []
    for parent in (tmp_path, *tmp_path.parents):
        if parent.stat().st_mode & 0o055 != 0o055 and parent != Path("/"):
            changed.append((parent, parent.stat().st_mode))
            parent.chmod(0o755)
    yield folder
    folder.chmod(0o755)
    for parent, mode in changed:
        parent.chmod(mode)


@ONE_PROCESS
def test_a_file_that_may_only_be_read(open_folder):
    file = open_folder / "muster.db"
    Store.open(f"sqlite:///{file}").close()
    file.chmod(0o444)
    open_folder.chmod(0o555)
    lines = tried_by_another(f"sqlite:///{file}")
    assert lines[-1].startswith(f"{file}: ")
    assert "writable for this user" in lines[-1]


@ONE_PROCESS
def test_a_folder_that_may_only_be_read(open_folder):
    open_folder.chmod(0o555)
    assert "writable for this user" in tried_by_another(f"sqlite:///{open_folder}/muster.db")[-1]
    [line] = tried_by_another(f"sqlite:///{open_folder}/new/muster.db")
    assert line == f"{open_folder}/new: Permission denied; expected a folder that can be made for the database"


def test_a_database_that_is_locked(file, monkeypatch):
    monkeypatch.setattr("muster_control.store.database._PATIENCE_S", 0.05)
    store = Store.open(f"sqlite:///{file}")
    with closing(sqlite3.connect(file, isolation_level=None)) as other:
        other.execute("BEGIN IMMEDIATE")
        with pytest.raises(StoreError) as error:
            store.check()
    says(error, str(file), "locked by another program")
    store.check()
    store.close()


def test_files_that_are_no_databases(tmp_path):
    file = tmp_path / "notes.txt"
    file.write_text("notes\n" * 1000)
    with pytest.raises(StoreError) as error:
        Store.open(f"sqlite:///{file}")
    says(error, str(file), "no database of SQLite")
    with pytest.raises(StoreError) as error:
        Store.open(f"sqlite:///{tmp_path}")
    says(error, "cannot be opened")
    assert file.read_text() == "notes\n" * 1000


def test_a_damaged_database(file):
    data = bytearray(file.read_bytes())
    data[4096:] = b"\xff" * (len(data) - 4096)
    file.write_bytes(data)
    with pytest.raises(StoreError) as error, closing(Store.open(f"sqlite:///{file}")) as store:
        store.missions.list()
    says(error, "is damaged", "muster db restore")


def test_a_database_of_a_newer_muster(store, database_url):
    with store.database.writing() as connection:
        connection.execute(text("UPDATE alembic_version SET version_num = '9999'"))
    with pytest.raises(StoreError) as error:
        Store.open(database_url)
    says(error, "made by a newer Muster (tables 9999)", f"expected {HEAD} or older: upgrade Muster")
    with pytest.raises(StoreError, match=r"its tables are 9999"):
        store.check()


def test_a_server_that_is_gone_and_comes_back(postgresql, postgresql_url):
    store = Store.open(postgresql_url)
    postgresql.stop()
    try:
        for _ in range(2):
            with pytest.raises(StoreError) as error:
                store.check()
            says(error, "PostgreSQL test_", "start it")
    finally:
        postgresql.start()
    store.check()
    store.close()


def test_a_user_a_database_or_a_server_that_is_not_there(postgresql):
    for url, words in (
        (postgresql.url("nowhere"), "no database of this name"),
        (postgresql.url("postgres", user="stranger"), "refuses this user"),
        ("postgresql://ann:secret@127.0.0.1:1/x", "the server is gone"),
        ("postgresql://ann:secret@no-such-host.invalid/x", "the server is gone"),
    ):
        with pytest.raises(StoreError) as error:
            Store.open(url)
        assert "secret" not in says(error, words)


def test_a_wrong_password(postgresql, postgresql_url):
    rules = postgresql.folder / "data" / "pg_hba.conf"
    before = rules.read_text()
    with closing(Database(postgresql_url)) as database, database.writing() as connection:
        connection.execute(text("DROP ROLE IF EXISTS bo"))
        connection.execute(text("CREATE ROLE bo LOGIN PASSWORD 'right'"))
        rules.write_text("local all bo scram-sha-256\n" + before)
        connection.execute(text("SELECT pg_reload_conf()"))
    try:
        name = postgresql_url.partition("@/")[2]
        for user in ("bo:wr0ng", "bo"):
            with pytest.raises(StoreError) as error:
                Store.open(f"postgresql://{user}@/{name}")
            assert "wr0ng" not in says(error, "the password is wrong")
    finally:
        rules.write_text(before)
        with closing(Database(postgresql_url)) as database, database.writing() as connection:
            connection.execute(text("SELECT pg_reload_conf()"))


@pytest.mark.parametrize(
    "url",
    [
        "muster.db",
        "",
        "mysql://ann:secret@host/x",
        "sqlite://",
        "sqlite:///:memory:",
        "sqlite:///file:x?mode=memory&uri=true",
        "sqlite://ann:secret@host/x",
        "postgresql://ann:sec@ret@host/x",
        "postgresql://ann:x@host:secret/x",
        "secret://ann@host/x",
    ],
)
def test_urls_that_are_none(url):
    with pytest.raises(ParameterError) as error:
        Store.open(url)
    message = says(error, "--db: ")
    assert "expected" in message
    assert "secret@" not in message
    assert "ret@" not in message
    assert ":secret" not in message


@given(st.text("abc:/?#[]%+ ", min_size=6, max_size=12))
def test_no_password_is_told(middle):
    """Whatever somebody puts where a password goes, unquoted: neither the name nor the refusal has it."""
    password = f"pQ7{middle}Zx9"
    try:
        message = shown(database_url(f"postgresql://ann:{password}@db.example.org/muster"))
    except MusterError as error:
        message = str(error)
    assert "pQ7" not in message
    assert "Zx9" not in message


def test_whoever_waits_for_a_lock_of_another_program_does_not_do_so_for_ever(database_url, monkeypatch):
    monkeypatch.setattr("muster_control.store.database._PATIENCE_S", 1)
    with closing(Store.open(database_url)) as store, closing(Database(database_url)) as other:
        filled = Filled(store)
        with other.writing() as connection:
            if not other.is_sqlite:
                connection.execute(text("LOCK TABLE actions IN EXCLUSIVE MODE"))
            with ThreadPoolExecutor(4) as threads:
                asked = [threads.submit(store.actions.add, ANN, "run.pause", {}, filled.run) for _ in range(4)]
                for each in asked:
                    with pytest.raises(StoreError) as error:
                        each.result(timeout=30)
                    says(error, "is locked by another program; end it, or wait")
                assert store.actions.list() == []
        assert store.actions.add(ANN, "run.pause", {}, filled.run).outcome == ""


def test_a_check_writes(tmp_path):
    """As on a full disk, where a transaction may begin and nothing be written."""
    store = Store.open(f"sqlite:///{tmp_path}/muster.db")
    store.check()
    with store.database.writing() as connection:
        connection.execute(
            text("CREATE TRIGGER full BEFORE UPDATE ON alembic_version BEGIN SELECT RAISE(ABORT, 'full'); END")
        )
    with pytest.raises(StoreError, match="full"):
        store.check()
    store.close()
