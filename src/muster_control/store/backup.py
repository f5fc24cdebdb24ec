"""Backups of a database: an SQLite file with the same tables, which can be restored into SQLite or PostgreSQL.

A backup is a snapshot, also while a server writes: SQLite's online backup (https://sqlite.org/backup.html) reads in one
transaction, PostgreSQL in one of REPEATABLE READ. A backup is complete or does not exist.
"""

from __future__ import annotations

import os
import sqlite3
from collections.abc import Iterator
from contextlib import closing, contextmanager
from pathlib import Path
from tempfile import TemporaryDirectory

from sqlalchemy import Connection, Table, func, insert, select, text

from muster.mission.errors import ParameterError
from muster_control.contract import StoreError
from muster_control.store.database import Database
from muster_control.store.failures import sqlite_error
from muster_control.store.migrate import migrate, revision
from muster_control.store.schema import HEAD, metadata, pruning
from muster_control.store.store import Store

_AT_ONCE = 200
_COPIED = [table for table in metadata.sorted_tables if table is not pruning]


def backup(url: str, file: Path) -> None:
    """Copy a database into a new file, which its owner alone may read.

    Raises
    ------
    ParameterError
        if the file exists.
    StoreError
        if the database cannot be read, or the file not be written.
    """
    if file.exists():
        raise ParameterError(f"{file}: exists; expected the name of a new file")
    with existing(url) as database, _folder_beside(file) as folder:
        copy = folder / file.name
        os.close(os.open(copy, os.O_CREAT | os.O_EXCL, 0o600))
        if database.file is not None:
            _copy_file(database.file, copy)
        else:
            _copy_server(database, copy)
        try:
            os.link(copy, file)  # refuses a file that was made meanwhile
        except OSError as error:
            raise _unwritable(file, error) from None


def restore(file: Path, url: str) -> None:
    """Restore a backup into an empty or new database. A backup of an older Muster is migrated.

    Raises
    ------
    ParameterError
        if the database is not empty, or the file no backup.
    StoreError
        if the database cannot be written, or the copy is of a newer Muster.
    """
    with TemporaryDirectory(prefix="muster-") as folder:
        copy = Path(folder) / "backup.db"
        _copy_file(file, copy)
        with closing(Database(f"sqlite:///{copy}", name=str(file))) as source:
            with source.reading() as connection:
                if revision(connection) is None:
                    raise ParameterError(
                        f"{file}: no backup of mission control; expected one that `muster db backup` wrote"
                    )
            migrate(source)
            with closing(Store.open(url)) as store, source.snapshot() as old, store.database.writing() as new:
                _require_empty(new, store.database.name)
                _copy_rows(old, new)
                _count_on(new)


@contextmanager
def existing(url: str) -> Iterator[Database]:
    """Open a database that exists and has tables.

    Raises
    ------
    StoreError
        if it is not.
    """
    database = Database(url)
    if database.file is not None and not database.file.is_file():
        raise StoreError(f"{database.name}: no such file; expected a database of mission control")
    with closing(database):
        with database.reading() as connection:
            found = revision(connection)
        if found is None:
            raise StoreError(
                f"{database.name}: no tables of mission control; expected a database that a server has used"
            )
        yield database


def require_newest(database: Database) -> None:
    """Raise StoreError if its tables are not those that this Muster knows."""
    with database.reading() as connection:
        found = revision(connection)
    if found != HEAD:
        raise StoreError(
            f"{database.name}: its tables are {found}; expected {HEAD}: `muster serve` brings older ones on"
        )


@contextmanager
def _folder_beside(file: Path) -> Iterator[Path]:
    try:
        folder = TemporaryDirectory(prefix=".muster-", dir=file.absolute().parent)
    except OSError as error:
        raise _unwritable(file, error) from None
    with folder as name:
        yield Path(name)


def _unwritable(file: Path, error: OSError) -> StoreError:
    return StoreError(f"{file}: {error.strerror or error}; expected a file that can be written")


def _copy_file(source: Path, to: Path) -> None:
    if not source.exists():
        raise StoreError(f"{source}: no such file; expected one that `muster db backup` wrote")
    try:
        with (
            closing(sqlite3.connect(f"{source.absolute().as_uri()}?mode=ro", uri=True)) as old,
            closing(sqlite3.connect(to)) as new,
        ):
            old.execute(
                "SELECT count(*) FROM sqlite_master"
            ).fetchall()  # says what is wrong with the source, if anything
            try:
                old.backup(new)
                new.execute("PRAGMA journal_mode=DELETE")  # one file, without a log beside it
            except sqlite3.Error as error:
                raise sqlite_error(error, str(to.name)) from None
    except sqlite3.Error as error:
        raise sqlite_error(error, str(source)) from None


def _copy_server(database: Database, to: Path) -> None:
    require_newest(database)
    with closing(Store.open(f"sqlite:///{to}")) as store, database.snapshot() as old, store.database.writing() as new:
        _copy_rows(old, new)
    with closing(sqlite3.connect(to)) as file:
        file.execute("PRAGMA journal_mode=DELETE")


def _copy_rows(old: Connection, new: Connection) -> None:
    for table in _COPIED:
        rows = old.execution_options(yield_per=_AT_ONCE).execute(select(table).order_by(*table.primary_key))
        for portion in rows.partitions():
            new.execute(insert(table), [dict(row._mapping) for row in portion])


def _require_empty(connection: Connection, name: str) -> None:
    for table in _COPIED:
        if connection.execute(select(*table.primary_key).limit(1)).first() is not None:
            raise ParameterError(f"{name}: holds {table.name.replace('_', ' ')} already; expected an empty database")


def _count_on(connection: Connection) -> None:
    """Let PostgreSQL number new rows from the highest number on, as SQLite does."""
    if connection.dialect.name == "sqlite":
        return
    for table in _COPIED:
        if _is_numbered(table):
            highest = connection.execute(select(func.max(table.c.id))).scalar()
            if highest is not None:
                sequence = text("SELECT setval(pg_get_serial_sequence(:table, 'id'), :highest)")
                connection.execute(sequence, {"table": table.name, "highest": highest})


def _is_numbered(table: Table) -> bool:
    return table.autoincrement_column is not None
