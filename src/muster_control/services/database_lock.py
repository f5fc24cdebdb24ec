"""One server a database: two would carry the same missions out twice.

Of SQLite a lock of the operating system on a file beside the database, of PostgreSQL advisory locks of a session
(PostgreSQL manual, section 13.3.5). Both end with the process, however it ends. A session may end before, with the
server of the database or the network: `Lock.look` takes the lock anew, and until then nothing is written.

    A, SESSION    held by whoever may write; B at its start waits for nobody, and is refused
    A, OWN        a number that only A knows, held by the same session: as long as somebody holds it, A has SESSION
    A, WRITING    shared by each transaction of A that writes, before it looks whether OWN is held; B waits for it
                  after it has got SESSION, so that nothing that A has begun ends after B has read what is there
"""

from __future__ import annotations

import fcntl
import os
import secrets
import threading
from collections.abc import Iterator
from contextlib import closing, contextmanager, suppress
from hashlib import sha256
from pathlib import Path
from typing import TYPE_CHECKING

from sqlalchemy import Connection, text
from sqlalchemy.engine import URL

from muster_control.contract import StoreError
from muster_control.settings import Settings
from muster_control.store.failures import connection_error
from muster_control.store.urls import database_url, shown, sqlite_file, whereabouts

if TYPE_CHECKING:
    import psycopg

_SESSION = 0x6D757374657200  # "muster", as a number that no other program takes by chance
_WRITING = _SESSION + 1
_SET_UP = (
    "SET tcp_keepalives_idle = 5",  # a machine that is gone holds the lock for seconds, not for two hours
    "SET tcp_keepalives_interval = 2",
    "SET tcp_keepalives_count = 3",
    "SET lock_timeout = '10s'",
)
_STARTS_WITH = "SELECT pg_advisory_xact_lock_shared(:writing), pg_try_advisory_xact_lock_shared(:own)"
_END_OURS = """
SELECT pg_terminate_backend(pid, 5000) FROM pg_locks JOIN pg_database ON pg_database.oid = pg_locks.database
WHERE datname = current_database() AND locktype = 'advisory' AND (classid::bigint << 32) | objid::bigint = %s
AND mode = 'ExclusiveLock' AND pid <> pg_backend_pid()
"""


class TakenError(StoreError):
    """Another server uses the database: this server may neither write nor carry out runs."""


class Lock:
    """The exclusive use of a database. This lock is that of SQLite, which cannot be lost."""

    def look(self) -> None:
        """Take the lock again if it was lost. Call it again if the database cannot be reached.

        Raises
        ------
        TakenError
            if another server has the lock.
        """

    def require(self, connection: Connection) -> None:
        """Raise StoreError unless this transaction may write; until it ends no other server's transaction may."""


@contextmanager
def alone_with(url: str) -> Iterator[Lock]:
    """Hold the lock of a database within the block.

    Raises
    ------
    StoreError
        if another one does, or the database cannot be reached.
    """
    address = database_url(url)
    file = sqlite_file(address)
    if file is not None:
        with _file_locked(file):
            yield Lock()
        return
    with closing(_SessionLock(address.set(drivername="postgresql"), shown(address))) as lock:
        yield lock


@contextmanager
def _file_locked(file: Path) -> Iterator[None]:
    lock = _beside(file, ".lock")
    try:
        lock.parent.mkdir(mode=0o700, parents=True, exist_ok=True)
        descriptor = os.open(lock, os.O_RDWR | os.O_CREAT | os.O_CLOEXEC, 0o600)
    except OSError as error:
        raise StoreError(f"{lock}: {error.strerror}; expected a folder that can be written") from None
    try:
        try:
            fcntl.flock(descriptor, fcntl.LOCK_EX | fcntl.LOCK_NB)
        except OSError:
            other = os.read(descriptor, 20).decode("ascii", "replace").strip()
            whose = f"process {other}" if other else "another process"
            raise TakenError(
                f"{file.resolve()}: in use by {whose}; expected one server a database (--db names another)"
            ) from None
        with suppress(OSError):  # a full disk: the process id is left out
            os.ftruncate(descriptor, 0)
            os.write(descriptor, f"{os.getpid()}\n".encode())
        yield
    finally:
        os.close(descriptor)


def lock_of_runs(settings: Settings) -> Path:
    """The file that runners of real robots lock, the same for all servers of this database on this machine.

    Runners of another machine or user are not waited for: they stop their robots when their server ends.
    """
    return _local_file(settings, ".runs.lock")


def journal_of(settings: Settings) -> Path:
    """The file of the journal, the same for all servers of this database on this machine."""
    return _local_file(settings, ".journal")


def _local_file(settings: Settings, ending: str) -> Path:
    """A file of this machine for a database: beside that of SQLite, else in the data folder (`XDG_DATA_HOME`)."""
    address = database_url(settings.database)
    file = sqlite_file(address)
    if file is not None:
        return _beside(file, ending)
    key = sha256(whereabouts(address).encode()).hexdigest()[:16]
    return settings.folder / f"{key}{ending}"


def _beside(file: Path, ending: str) -> Path:
    """A file beside a database; links to the database are resolved first, as SQLite does."""
    whole = file.resolve()
    return whole.with_name(f"{whole.name}{ending}")


class _SessionLock(Lock):
    """The lock of PostgreSQL, held by a separate session."""

    def __init__(self, url: URL, name: str) -> None:
        self._url, self._name = url, name
        self._own = secrets.randbits(62)
        self._looking, self._is_over = threading.Lock(), False
        import psycopg

        self._session = self._connected()
        try:
            self._take()
        except (StoreError, psycopg.Error) as error:
            self._session.close()
            raise (error if isinstance(error, StoreError) else connection_error(error, name)) from None

    def look(self) -> None:
        with self._looking:
            self._look()
        if self._is_over:
            self._session.close()

    def _look(self) -> None:
        import psycopg

        try:
            self._session.execute("SELECT 1")
            return
        except psycopg.Error:
            self._session.close()
        if self._is_over:
            return
        try:
            self._session = self._connected()
        except StoreError:
            return
        try:
            with suppress(psycopg.Error):  # after a loss of the network our old session may still be open
                self._session.execute(_END_OURS, (self._own,))
            self._take()
        except psycopg.Error:
            self._session.close()

    def require(self, connection: Connection) -> None:
        _, is_free = connection.execute(text(_STARTS_WITH), {"writing": _WRITING, "own": self._own}).one()
        if is_free:
            raise StoreError(f"{self._name}: it was gone, and another server may have it; wait a moment")

    def close(self) -> None:
        """End the session without waiting for `look`, which may hang and then ends the session itself."""
        self._is_over = True
        if self._looking.acquire(blocking=False):
            self._session.close()
            self._looking.release()

    def _connected(self) -> psycopg.Connection[tuple[object, ...]]:
        import psycopg

        conninfo = self._url.render_as_string(hide_password=False)
        try:
            session = psycopg.connect(
                conninfo, autocommit=True, connect_timeout=10, tcp_user_timeout=10_000, application_name="muster lock"
            )
            for each in _SET_UP:
                session.execute(each)
        except psycopg.Error as error:
            raise connection_error(error, self._name) from None
        return session

    def _take(self) -> None:
        if not self._ask("SELECT pg_try_advisory_lock(%s)", _SESSION):
            raise TakenError(
                f"{self._name}: in use by another server; expected one server a database (--db names another)"
            )
        self._ask("SELECT pg_advisory_lock(%s)", _WRITING)
        self._ask("SELECT pg_advisory_unlock(%s)", _WRITING)
        self._ask("SELECT pg_advisory_lock(%s)", self._own)

    def _ask(self, query: str, key: int) -> bool:
        row = self._session.execute(query, (key,)).fetchone()
        return row is not None and bool(row[0])
