"""Failures of the database as messages for people: one line that says what happened and what to do.

SQLite names its failures (https://sqlite.org/rescode.html), PostgreSQL numbers them (its manual, appendix A); a
connection that fails has a text only.
"""

from __future__ import annotations

import sqlite3

from sqlalchemy.exc import DBAPIError, SQLAlchemyError, StatementError

from muster.mission.errors import MusterError
from muster_control.contract import StoreError

_OF_SQLITE = (
    ("SQLITE_FULL", "the disk is full; free some space, or `muster db prune`"),
    ("SQLITE_READONLY", "may only be read; make the file and its folder writable for this user"),
    ("SQLITE_BUSY", "is locked by another program; end it, or wait"),
    ("SQLITE_LOCKED", "is locked by another program; end it, or wait"),
    ("SQLITE_CANTOPEN", "cannot be opened; make the file and its folder readable and writable for this user"),
    ("SQLITE_PERM", "cannot be opened; make the file and its folder readable and writable for this user"),
    ("SQLITE_AUTH", "cannot be opened; make the file and its folder readable and writable for this user"),
    ("SQLITE_NOTADB", "is no database of SQLite; name another file"),
    ("SQLITE_CORRUPT", "is damaged; restore a backup with `muster db restore`"),
    ("SQLITE_IOERR", "the disk failed; look at the system's log, and whether the disk is full"),
    ("SQLITE_TOOBIG", "something is larger than the database can keep; make it smaller"),
)

_OF_POSTGRESQL = (
    ("53100", "the server's disk is full; free some space there, or `muster db prune`"),
    ("53300", "the server has no connection left; end other programs, or raise its max_connections"),
    ("53", "the server has too little memory or room; look at its log"),
    ("25006", "may only be read; connect to a server that can be written to"),
    ("28P01", "the password is wrong; give the right one in the URL, PGPASSWORD or ~/.pgpass"),
    ("28", "the server refuses this user; look at its pg_hba.conf"),
    ("3D000", "there is no database of this name; make it with createdb"),
    ("42501", "this user may not do that; make the user the owner of the database"),
    ("57P03", "the server is starting or stopping; wait"),
    ("57P", "the server was stopped; start it again"),
    ("08", "the server is gone; start it, or look at the network"),
    ("55P03", "is locked by another program; end it, or wait"),
    ("40", "another program was in the way; try again"),
    ("54", "something is larger than the database can keep; make it smaller"),
)

_OF_A_CONNECTION = (
    ("password authentication failed", "28P01"),
    ("no password supplied", "28P01"),
    ("no pg_hba.conf entry", "28000"),
    ("authentication failed", "28000"),
    ("too many clients", "53300"),
    ("remaining connection slots", "53300"),
    ("the database system is", "57P03"),
    ("terminating connection", "57P01"),
    ("role", "28000"),
    ("does not exist", "3D000"),
)


def store_error(error: SQLAlchemyError, where: str) -> MusterError:
    """The StoreError for a failure; `where` is the database's name in messages."""
    cause = error.orig if isinstance(error, StatementError) else None
    if isinstance(cause, MusterError):  # what was to be written is wrong: a column said so
        return cause
    if isinstance(cause, UnicodeError):
        return StoreError(f"{where}: {cause}; expected a text in UTF-8")
    name = getattr(cause, "sqlite_errorname", None)
    meaning = _known(name, _OF_SQLITE) if name else _known(_sqlstate(error), _OF_POSTGRESQL)
    if meaning is not None:
        return StoreError(f"{where}: {meaning}")
    return StoreError(f"{where}: {_first_line(cause or error)}; look at the database")


def connection_error(error: Exception, where: str) -> StoreError:
    """The StoreError for a failed connection to PostgreSQL without SQLAlchemy."""
    meaning = _known(_state_of(error), _OF_POSTGRESQL)
    return StoreError(f"{where}: {meaning or f'{_first_line(error)}; look at the database'}")


def sqlite_error(error: sqlite3.Error, where: str) -> StoreError:
    """The StoreError for a failure of SQLite without SQLAlchemy."""
    meaning = (
        _known(getattr(error, "sqlite_errorname", ""), _OF_SQLITE) or f"{_first_line(error)}; look at the database"
    )
    return StoreError(f"{where}: {meaning}")


def _known(name: str, table: tuple[tuple[str, str], ...]) -> str | None:
    return next((meaning for start, meaning in table if name.startswith(start)), None)


def _sqlstate(error: SQLAlchemyError) -> str:
    return _state_of(error.orig if isinstance(error, DBAPIError) else None)


def _state_of(cause: BaseException | None) -> str:
    state = getattr(cause, "sqlstate", None)
    if state:
        return str(state)
    text = str(cause)
    known = next((state for words, state in _OF_A_CONNECTION if words in text), None)
    if known is None and type(cause).__name__ == "OperationalError":
        return "08"
    return known or "unknown"


def _first_line(error: BaseException) -> str:
    lines = str(error).strip().splitlines()
    return lines[0] if lines else type(error).__name__
