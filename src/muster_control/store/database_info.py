"""The size of a database and its numbers of rows."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

from sqlalchemy import func, select, text

from muster_control.store.backup import existing, require_newest
from muster_control.store.schema import HEAD, actions, entries, jobs, mission_versions, missions, plans, runs, stretches

_COUNTED = (missions, mission_versions, plans, jobs, runs, entries, stretches, actions)


@dataclass(frozen=True)
class DatabaseInfo:
    """The name of a database in messages, its migration, its size, and the rows of each table."""

    database: str
    tables: str
    bytes: int
    rows: Mapping[str, int]


def database_info(url: str) -> DatabaseInfo:
    """Count what is in a database.

    Raises
    ------
    StoreError
        if it cannot be read, or has older tables.
    """
    with existing(url) as database:
        require_newest(database)
        with database.snapshot() as connection:
            rows = {
                table.name: connection.execute(select(func.count()).select_from(table)).scalar_one()
                for table in _COUNTED
            }
            size = "page_count * page_size FROM pragma_page_count, pragma_page_size"
            query = f"SELECT {size}" if database.is_sqlite else "SELECT pg_database_size(current_database())"
            return DatabaseInfo(database.name, HEAD, connection.execute(text(query)).scalar_one(), rows)
