"""Keys of requests: a repeated request creates nothing twice, also after a restart of the server."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from datetime import UTC, datetime, timedelta

from sqlalchemy import ColumnElement, Connection, delete, select, update

from muster_control.contract import ConflictError
from muster_control.store.database import DatabaseTable, insert_unless_there
from muster_control.store.schema import request_keys

KEPT = timedelta(days=1)
"""How long a key is remembered; a client that tries again does so within minutes."""


@dataclass(frozen=True)
class RequestKey:
    """What a client calls one of its requests; `digest` is of what the request asks for."""

    user: str
    key: str
    digest: str


class RepeatedRequestError(Exception):
    """The same request came before; `made` is the id of what it made."""

    def __init__(self, made: int) -> None:
        super().__init__(made)
        self.made = made


class RequestKeyTable(DatabaseTable):
    def require_new(self, request: RequestKey) -> None:
        """Look whether a request came before.

        Raises
        ------
        RepeatedRequestError
            if it did.
        ConflictError
            if another request of this user had the key.
        """
        with self._database.reading() as connection:
            _require_new(connection, request)


@contextmanager
def keyed(connection: Connection, request: RequestKey | None) -> Iterator[Callable[[int], None]]:
    """Take the key of a request, within the transaction that makes something; gives what writes down what it made.

    A second transaction that takes the key waits for the end of this one. Without a request nothing is written.

    Raises
    ------
    RepeatedRequestError, ConflictError
        as `require_new`.
    """
    if request is None:
        yield lambda made: None
        return
    _take(connection, request)
    yield lambda made: _settle(connection, request, made)


def _take(connection: Connection, request: RequestKey) -> None:
    now = datetime.now(UTC)
    connection.execute(delete(request_keys).where(request_keys.c.at < now - KEPT))
    row = {"user": request.user, "key": request.key, "digest": request.digest, "made": 0, "at": now}
    if not insert_unless_there(connection, request_keys, row):
        _require_new(connection, request)


def _settle(connection: Connection, request: RequestKey, made: int) -> None:
    connection.execute(update(request_keys).where(*_named(request)).values(made=made))


def _require_new(connection: Connection, request: RequestKey) -> None:
    row = connection.execute(select(request_keys).where(*_named(request))).one_or_none()
    if row is None:
        return
    if row.digest != request.digest:
        raise ConflictError(f"Idempotency-Key {request.key} was sent with another request; expected a new key")
    raise RepeatedRequestError(row.made)


def _named(request: RequestKey) -> tuple[ColumnElement[bool], ColumnElement[bool]]:
    return request_keys.c.user == request.user, request_keys.c.key == request.key
