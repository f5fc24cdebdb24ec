"""Plans. The part that lists show (the head) is stored apart from the rest, which may be large."""

from __future__ import annotations

from collections.abc import Mapping
from datetime import UTC, datetime
from typing import Any, Literal

from sqlalchemy import Connection, Row, func, insert, select

from muster_control.contract import MOST_ROWS, PAGE_ROWS, NotFoundError, PlanEntry
from muster_control.store.database import DatabaseTable, newest
from muster_control.store.schema import missions, plans

_BODY = frozenset({"routes", "unassigned", "history", "book"})


class PlanTable(DatabaseTable):
    def add(
        self,
        mission: str,
        mission_version: int,
        origin: Literal["planned", "uploaded"],
        author: str,
        plan: Mapping[str, Any],
    ) -> PlanEntry:
        """A new plan, with the next version of its mission's plans.

        Raises
        ------
        NotFoundError
            if there is no such mission.
        """
        with self._database.writing() as connection:
            return add_plan(connection, mission, mission_version, origin, author, plan)

    def get(self, plan: int) -> PlanEntry:
        """One plan, whole.

        Raises
        ------
        NotFoundError
            if there is none.
        """
        with self._database.reading() as connection:
            row = connection.execute(select(plans).where(plans.c.id == plan)).one_or_none()
        if row is None:
            raise NotFoundError(f"no plan {plan}")
        return _entry(row)

    def missions(self, plans_read: int = MOST_ROWS) -> list[str]:
        """The missions of the newest plans, the one that was planned last first."""
        query = select(plans.c.mission).order_by(plans.c.id.desc()).limit(plans_read)
        with self._database.reading() as connection:
            return list(dict.fromkeys(connection.execute(query).scalars()))

    def list(self, mission: str | None = None, limit: int = PAGE_ROWS, before: int | None = None) -> list[PlanEntry]:
        """Plans, of one mission or all, the newest first; with ids below `before`, if given.

        Each without routes, history, unassigned and book.
        """
        query = newest(_HEADS, plans, limit, before, mission=mission)
        with self._database.reading() as connection:
            return [_entry(row) for row in connection.execute(query)]


_HEADS = select(*(column for column in plans.c if column.name != "body"))


def add_plan(
    connection: Connection,
    mission: str,
    mission_version: int,
    origin: Literal["planned", "uploaded"],
    author: str,
    plan: Mapping[str, Any],
) -> PlanEntry:
    """As `PlanTable.add`, within a transaction."""
    row = {
        "mission": mission,
        "mission_version": mission_version,
        "origin": origin,
        "author": author,
        "at": datetime.now(UTC),
        "head": {key: value for key, value in plan.items() if key not in _BODY},
        "body": {key: value for key, value in plan.items() if key in _BODY},
    }
    # who holds the mission's row counts its plans alone
    if connection.execute(select(missions.c.id).where(missions.c.id == mission).with_for_update()).first() is None:
        raise NotFoundError(f"no mission {mission}")
    newest = connection.execute(select(func.max(plans.c.version)).where(plans.c.mission == mission)).scalar()
    version = (newest or 0) + 1
    return _entry(connection.execute(insert(plans).values(version=version, **row).returning(plans)).one())


def _entry(row: Row[Any]) -> PlanEntry:
    values = dict(row._mapping)
    head, body = values.pop("head"), values.pop("body", {})
    return PlanEntry(**values, plan={**head, **body})
