"""Who may read a database of SQLite: whoever made it, and nobody else who is at the machine."""

import os
import stat
from contextlib import closing

import pytest
from tests.muster_control.store.conftest import Filled

from muster_control.security.sessions import kept_secret
from muster_control.services.database_lock import alone_with
from muster_control.store import Store
from muster_control.store.backup import backup, restore


@pytest.fixture(autouse=True)
def usual_umask():
    """By which everybody may read what is not said to be private."""
    before = os.umask(0o022)
    yield
    os.umask(before)


def modes(folder):
    """Of a folder and the files in it."""
    return {path.name: stat.S_IMODE(path.stat().st_mode) for path in (folder, *folder.iterdir())}


def test_a_new_database_is_for_its_owner_alone(tmp_path):
    with closing(Store.open(f"sqlite:///{tmp_path}/new/muster.db")) as store:
        Filled(store)
        files = dict.fromkeys(("muster.db", "muster.db-wal", "muster.db-shm"), 0o600)
        assert modes(tmp_path / "new") == {"new": 0o700, **files}


def test_so_is_one_that_is_restored(tmp_path):
    with closing(Store.open(f"sqlite:///{tmp_path}/old.db")) as store:
        Filled(store)
    backup(f"sqlite:///{tmp_path}/old.db", tmp_path / "copy.db")
    restore(tmp_path / "copy.db", f"sqlite:///{tmp_path}/new/muster.db")
    assert modes(tmp_path / "new") == {"new": 0o700, "muster.db": 0o600}


def test_so_is_the_folder_whatever_is_made_in_it_first(tmp_path):
    with alone_with(f"sqlite:///{tmp_path}/locked/muster.db"):
        assert modes(tmp_path / "locked") == {"locked": 0o700, "muster.db.lock": 0o600}
    kept_secret(tmp_path / "secret" / "session.key")
    assert modes(tmp_path / "secret") == {"secret": 0o700, "session.key": 0o600}


def test_a_database_that_is_there_keeps_its_mode(tmp_path):
    folder = tmp_path / "shared"
    folder.mkdir(0o750)
    Store.open(f"sqlite:///{folder}/muster.db").close()
    (folder / "muster.db").chmod(0o640)
    with closing(Store.open(f"sqlite:///{folder}/muster.db")) as store:
        Filled(store)
        files = dict.fromkeys(("muster.db", "muster.db-wal", "muster.db-shm"), 0o640)
        assert modes(folder) == {"shared": 0o750, **files}
