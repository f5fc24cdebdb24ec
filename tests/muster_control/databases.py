"""Databases for tests: SQLite in a folder of its own, and a PostgreSQL server that is started once for all tests.

A `conftest.py` or test takes the fixtures by `from tests.muster_control.databases import *`, or one by its name.
"""

import itertools
import os
import shutil
import signal
import subprocess
from contextlib import suppress
from pathlib import Path
from tempfile import mkdtemp

import pytest
from tests.muster_control.runs.process import children

__all__ = ["database_url", "postgresql", "postgresql_url"]

_numbers = itertools.count(1)
_PATIENCE_S = 900
"""For so long a server may start or stop: a busy machine takes longer than the minute that `pg_ctl` waits."""
_QUICK = "-c fsync=off -c synchronous_commit=off -c full_page_writes=off -c shared_buffers=16MB -c max_connections=40"


class PostgreSQL:
    """A server of this test session: on a socket in a folder of its own, on no network, run by an unprivileged user."""

    def __init__(self, programs):
        self.folder = Path(mkdtemp(prefix="muster-pg-"))
        self._programs = programs
        self._user = ["setpriv", "--reuid=postgres", "--regid=postgres", "--clear-groups"] if os.geteuid() == 0 else []
        try:
            if self._user:
                shutil.chown(self.folder, "postgres", "postgres")
            self.call("initdb", "-D", self._data, "-A", "trust", "-U", "muster", "-E", "UTF8", "--locale=C", "-N")
            self.start()
        except BaseException:
            shutil.rmtree(self.folder, ignore_errors=True)
            raise

    @property
    def _data(self):
        return self.folder / "data"

    def call(self, program, *arguments):
        command = [*self._user, str(self._programs / program), *map(str, arguments)]
        done = subprocess.run(  # a server that goes on must not hold a pipe of ours
            command, cwd=self.folder, stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL
        )
        if done.returncode != 0:
            log = self._log.read_text() if self._log.exists() else "no log"
            raise RuntimeError(f"{program} ended with {done.returncode}: {log[-2000:]}")

    @property
    def _log(self):
        return self.folder / "log"

    def start(self):
        options = f"-c listen_addresses='' -c unix_socket_directories={self.folder} {_QUICK}"
        self.call("pg_ctl", "-D", self._data, "-w", "-t", _PATIENCE_S, "-o", options, "-l", self._log, "start")

    def stop(self):
        self.call("pg_ctl", "-D", self._data, "-w", "-t", _PATIENCE_S, "-m", "fast", "stop")

    def freeze(self):
        """Let all processes stand: nothing is answered, and no connection breaks."""
        self._signal(signal.SIGSTOP)

    def thaw(self):
        """Let them go on."""
        self._signal(signal.SIGCONT)

    def _signal(self, what):
        postmaster = int((self._data / "postmaster.pid").read_text().split()[0])
        for pid in (postmaster, *(pid for pid, _ in children(postmaster))):
            with suppress(ProcessLookupError):
                os.kill(pid, what)

    def new(self):
        """The URL of a new, empty database."""
        name = f"test_{next(_numbers)}"
        self.call("createdb", "-h", self.folder, "-U", "muster", name)
        return self.url(name)

    def url(self, name, user="muster"):
        return f"postgresql://{user}@/{name}?host={self.folder}"

    def close(self):
        try:
            self.stop()
        finally:
            shutil.rmtree(self.folder, ignore_errors=True)


def postgresql_programs():
    """The folder of PostgreSQL's programs; None if it is not installed."""
    on_path = shutil.which("initdb")
    if on_path:
        return Path(on_path).resolve().parent
    versions = sorted(Path("/usr/lib/postgresql").glob("*/bin/initdb"), key=lambda file: float(file.parts[-3]))
    return versions[-1].parent if versions else None


@pytest.fixture(scope="session")
def postgresql():
    """A PostgreSQL server; tests that need it are skipped where there is none."""
    programs = postgresql_programs()
    if programs is None:
        pytest.skip("no PostgreSQL here; tools/test_packages.sh installs it")
    try:
        server = PostgreSQL(programs)
    except (OSError, RuntimeError, LookupError) as error:
        pytest.skip(f"no PostgreSQL can be started here: {error}")
    yield server
    server.close()


@pytest.fixture
def postgresql_url(postgresql, tmp_path, monkeypatch):
    """The URL of a new database of PostgreSQL; what a server keeps beside it is the test's own."""
    monkeypatch.setenv("XDG_DATA_HOME", str(tmp_path / "data"))
    return postgresql.new()


@pytest.fixture(params=["sqlite", "postgresql"])
def database_url(request, tmp_path):
    """The URL of a new database: the test runs once for each kind."""
    if request.param == "sqlite":
        return f"sqlite:///{tmp_path}/muster.db"
    return request.getfixturevalue("postgresql_url")
