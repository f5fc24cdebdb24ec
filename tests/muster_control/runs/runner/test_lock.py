"""Real robots of a run are commanded by one runner at a time, and the file for that does no harm elsewhere."""

import signal
import stat
import subprocess
import sys

import pytest

from muster.mission.errors import NetworkError
from muster_control.contract import StoreError
from muster_control.runs.runner.lock import alone
from muster_control.services.database_lock import lock_of_runs
from muster_control.settings import Settings

_HOLD = """
import sys, time
from pathlib import Path
from muster_control.runs.runner.lock import alone
with alone(Path(sys.argv[1]), 1):
    print("held", flush=True)
    time.sleep(3600)
"""


def test_the_next_runner_waits_until_the_one_before_has_ended(tmp_path, monkeypatch):
    monkeypatch.setattr("muster_control.runs.runner.lock._WITHIN_S", 0.0)
    lock = tmp_path / "new" / "runs.lock"
    with subprocess.Popen([sys.executable, "-c", _HOLD, str(lock)], stdout=subprocess.PIPE, text=True) as other:
        try:
            assert other.stdout.readline() == "held\n"
            with pytest.raises(NetworkError, match="another process still commands the robots"), alone(lock, 1):
                pass
            with alone(lock, 2):  # another run
                pass
        finally:
            other.send_signal(signal.SIGKILL)
    with alone(lock, 1):
        pass
    assert [path.name for path in lock.parent.iterdir()] == ["runs.lock"]
    assert (lock.stat().st_size, stat.S_IMODE(lock.stat().st_mode)) == (0, 0o600)
    assert stat.S_IMODE(lock.parent.stat().st_mode) == 0o700


def test_a_name_that_leads_elsewhere_is_refused(tmp_path):
    victim = tmp_path / "victim"
    victim.write_text("kept")
    (tmp_path / "runs.lock").symlink_to(victim)
    said = r"/runs\.lock: .*; expected a file that can be written"
    with pytest.raises(StoreError, match=said), alone(tmp_path / "runs.lock", 1):
        pass
    assert victim.read_text() == "kept"


def _lock(database):
    return lock_of_runs(Settings(database=database))


def test_one_file_for_all_spellings_of_a_file(tmp_path, monkeypatch):
    (tmp_path / "muster.db").touch()
    (tmp_path / "folder").mkdir()
    (tmp_path / "link.db").symlink_to(tmp_path / "muster.db")
    monkeypatch.chdir(tmp_path / "folder")
    spelt = (f"{tmp_path}/muster.db", f"{tmp_path}/folder/../muster.db", "../muster.db", f"{tmp_path}/link.db")
    assert {_lock(f"sqlite:///{file}") for file in spelt} == {tmp_path / "muster.db.runs.lock"}
    assert _lock("sqlite:///other.db") == tmp_path / "folder" / "other.db.runs.lock"


def test_one_file_for_all_spellings_of_a_database_of_a_server(tmp_path, monkeypatch):
    monkeypatch.setenv("XDG_DATA_HOME", str(tmp_path))
    spelt = (
        "postgresql://ann@db/muster",
        "postgresql://bo:secret@DB:5432/muster",
        "postgresql+psycopg://ann@/muster?host=db",
        "postgres://ann@db/muster?port=5432&application_name=x",
    )
    (lock,) = {_lock(url) for url in spelt}
    assert lock.parent == tmp_path / "muster"
    others = ("postgresql://ann@db/other", "postgresql://ann@host/muster", "postgresql://ann@db:5433/muster")
    assert len({lock, *map(_lock, others), _lock("postgresql://ann@db/muster?port=5433")}) == 4
