"""The database that a URL means, and its name in messages: without user, password and options."""

from __future__ import annotations

from pathlib import Path

from sqlalchemy.engine import URL, make_url
from sqlalchemy.exc import ArgumentError

from muster.mission.errors import ParameterError

_PORT = 5432  # of PostgreSQL, where none is given
_EXPECTED = "expected sqlite:///FILE or postgresql://USER@HOST/NAME"


def database_url(text: str) -> URL:
    """The URL with the driver that Muster uses.

    Raises
    ------
    ParameterError
        if it is no URL of a database that Muster can use. The message has nothing of the URL but its beginning, since
        anything else might be a password.
    """
    scheme, colon, rest = text.partition("://")
    if not colon or not scheme.replace("+", "").isalnum():
        raise ParameterError(f"--db: no URL of a database; {_EXPECTED}")
    if scheme not in ("sqlite", "postgresql", "postgres", "postgresql+psycopg"):
        raise ParameterError(f"--db: {scheme}://...; {_EXPECTED}")
    if scheme != "sqlite" and rest.partition("?")[0].count("@") > 1:
        raise ParameterError(f"--db: {scheme}://... with more than one @; expected %40 for an @ in a password")
    try:
        url = make_url(text)
    except (ArgumentError, ValueError):
        raise ParameterError(f"--db: {scheme}://... cannot be read; {_EXPECTED}") from None
    if scheme == "sqlite":
        return _of_a_file(url)
    return url.set(drivername="postgresql+psycopg")


def _of_a_file(url: URL) -> URL:
    if url.host or not url.database or url.database == ":memory:" or url.database.startswith("file:") or url.query:
        raise ParameterError(
            "--db: sqlite:// without a plain file; expected sqlite:///FILE, such as sqlite:////srv/muster.db"
        )
    return url


def sqlite_file(url: URL) -> Path | None:
    """The file of a database of SQLite; None of PostgreSQL."""
    return Path(str(url.database)) if url.get_backend_name() == "sqlite" else None


def shown(url: URL) -> str:
    """What messages call the database: its file, or its name and server."""
    if url.get_backend_name() == "sqlite":
        return str(url.database)
    return f"PostgreSQL {url.database or ''} at {_host(url)}{'' if url.port is None else f':{url.port}'}"


def whereabouts(url: URL) -> str:
    """Server and name of a PostgreSQL database, equal for all spellings of its URL where the URL shows that."""
    port = url.port or url.query.get("port") or _PORT
    return f"{_host(url).lower()}:{port}/{url.database or url.username or ''}"  # which has the user's name by default


def _host(url: URL) -> str:
    host = url.host or url.query.get("host") or "localhost"
    return host if isinstance(host, str) else ", ".join(host)
