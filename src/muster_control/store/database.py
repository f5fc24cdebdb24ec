"""Connections to a database, and transactions. Every failure of the database becomes a StoreError of one line.

SQLite uses write-ahead logging (WAL): readers and one writer do not wait for each other. With synchronous=FULL commits
survive a power failure, at one fsync per transaction. A writing transaction takes the lock at its beginning (BEGIN
IMMEDIATE), so it cannot fail later because another one wrote.
"""

from __future__ import annotations

import os
from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager, suppress
from pathlib import Path
from threading import Lock
from typing import Any, TypeVar

from sqlalchemy import Connection, Engine, Select, Table, create_engine, event
from sqlalchemy.exc import SQLAlchemyError

from muster.mission.errors import MissingExtraError
from muster_control.contract import StoreError
from muster_control.store.columns import as_json
from muster_control.store.failures import store_error
from muster_control.store.urls import database_url, shown, sqlite_file

T = TypeVar("T")

_PATIENCE_S = 10
_NEVER_FOR_EVER = {
    "connect_timeout": _PATIENCE_S,
    "tcp_user_timeout": 1000 * _PATIENCE_S,
    "keepalives_idle": _PATIENCE_S // 2,
    "keepalives_interval": 2,
    "keepalives_count": 3,
}
"""Options of libpq: a server that does not answer any more, because its machine or the network is gone, is given up."""


class Database:
    """A database, with or without tables.

    `name` stands in messages; `failures` counts failures. A server sets `require`, which checks at the beginning of
    each writing transaction of PostgreSQL whether it may write.
    """

    def __init__(self, url: str, name: str = "") -> None:
        address = database_url(url)
        self.name = name or shown(address)
        self.file = sqlite_file(address)
        self.failures = 0
        self.require: Callable[[Connection], None] = lambda _: None  # raises if a transaction may not write
        self._turn = Lock()  # SQLite has one writer at a time: threads of this process queue here instead of polling
        if self.file is None:
            self._engine = _postgresql(address)
        else:
            self._engine = _sqlite(address)

    @property
    def is_sqlite(self) -> bool:
        return self.file is not None

    @contextmanager
    def reading(self) -> Iterator[Connection]:
        """A transaction that reads."""
        with self._failing(), self._engine.connect() as connection:
            yield connection

    @contextmanager
    def writing(self) -> Iterator[Connection]:
        """A transaction that writes: all of it, or nothing if it raises."""
        if not self.is_sqlite:
            with self._failing(), self._engine.begin() as connection:
                self.require(connection)
                yield connection
            return
        with self._my_turn(), self._failing(), self._engine.execution_options(writes=True).begin() as connection:
            yield connection

    @contextmanager
    def snapshot(self) -> Iterator[Connection]:
        """A transaction that reads a snapshot."""
        engine = self._engine if self.is_sqlite else self._engine.execution_options(isolation_level="REPEATABLE READ")
        with self._failing(), engine.connect() as connection:
            yield connection

    def close(self) -> None:
        self._engine.dispose()

    @contextmanager
    def _my_turn(self) -> Iterator[None]:
        """Let one thread write at a time, with a limit on the wait."""
        if not self._turn.acquire(timeout=_PATIENCE_S):
            self.failures += 1
            raise StoreError(f"{self.name}: is locked by another program; end it, or wait")
        try:
            yield
        finally:
            self._turn.release()

    @contextmanager
    def _failing(self) -> Iterator[None]:
        try:
            yield
        except SQLAlchemyError as error:
            self.failures += 1
            raise store_error(error, self.name) from None


class DatabaseTable:
    """What one table of a database answers and changes; each method is a transaction."""

    def __init__(self, database: Database) -> None:
        self._database = database

    def _read_all(self, entry: Callable[..., T], query: Select[Any]) -> list[T]:
        """Return what a query finds, as entries made of the values of a row by column."""
        with self._database.reading() as connection:
            return [entry(**row._mapping) for row in connection.execute(query)]


def newest(query: Select[Any], table: Table, limit: int, before: int | None, **equal: object) -> Select[Any]:
    """A page of a query: the newest rows first, with ids below `before`, and these values where they are not None."""
    wanted = [table.c[name] == value for name, value in equal.items() if value is not None]
    if before is not None:
        wanted.append(table.c.id < before)
    return query.where(*wanted).order_by(table.c.id.desc()).limit(limit)


def insert_of(connection: Connection, table: Table) -> Any:
    """Return the database's own `INSERT` into a table, which knows `ON CONFLICT`."""
    if connection.dialect.name == "sqlite":
        from sqlalchemy.dialects.sqlite import insert
    else:
        from sqlalchemy.dialects.postgresql import insert  # type: ignore[assignment]
    return insert(table)


def insert_unless_there(connection: Connection, table: Table, row: Mapping[str, Any]) -> bool:
    """Insert a row unless there is one with its key, also a concurrent one; returns whether it was inserted."""
    insert = insert_of(connection, table).values(row).on_conflict_do_nothing().returning(*table.primary_key)
    return connection.execute(insert).first() is not None


def _sqlite(address: Any) -> Engine:
    engine = create_engine(
        address, json_serializer=as_json, hide_parameters=True, connect_args={"timeout": _PATIENCE_S}
    )

    @event.listens_for(engine, "connect")
    def set_up(connection: Any, _: Any) -> None:
        connection.isolation_level = None  # the driver must not begin transactions
        for pragma in ("journal_mode=WAL", "synchronous=FULL", "foreign_keys=ON"):
            connection.execute(f"PRAGMA {pragma}").close()

    @event.listens_for(engine, "begin")
    def begin(connection: Connection) -> None:
        writes = connection.get_execution_options().get("writes", False)
        connection.exec_driver_sql("BEGIN IMMEDIATE" if writes else "BEGIN")

    return engine


def _postgresql(address: Any) -> Engine:
    try:
        engine = create_engine(
            address,
            json_serializer=as_json,
            hide_parameters=True,
            pool_pre_ping=True,  # reconnects after a restart of the server
            connect_args={"application_name": "muster", **_NEVER_FOR_EVER},
        )
    except ImportError as error:
        raise MissingExtraError("web", "PostgreSQL") from error

    @event.listens_for(engine, "connect")
    def set_up(connection: Any, _: Any) -> None:
        connection.execute(f"SET lock_timeout = '{_PATIENCE_S}s'")
        connection.commit()

    return engine


def make_file(file: Path) -> None:
    """Create a database file and its folder for this user only; existing ones keep their mode.

    SQLite gives its further files the same mode.

    Raises
    ------
    StoreError
        if the folder cannot be made.
    """
    try:
        file.parent.mkdir(mode=0o700, parents=True, exist_ok=True)
    except OSError as error:
        raise StoreError(
            f"{file.parent}: {error.strerror or error}; expected a folder that can be made for the database"
        ) from None
    with suppress(OSError):  # SQLite will fail to open it, and say why
        os.close(os.open(file, os.O_RDONLY | os.O_CREAT | os.O_CLOEXEC, 0o600))
