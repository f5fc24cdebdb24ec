"""Actions of users and their outcomes."""

from __future__ import annotations

from collections.abc import Mapping
from datetime import UTC, datetime
from typing import Any

from sqlalchemy import Connection, insert, select, update

from muster.exchange.mission_control import Action, NotFoundError, User
from muster.server.store.database import Database
from muster.server.store.schema import actions, runs


class ActionTable:
    def __init__(self, database: Database) -> None:
        self._database = database

    def add(
        self, who: User, verb: str, data: Mapping[str, Any], run: int | None = None, at: datetime | None = None
    ) -> Action:
        """Add an action without an outcome; a run's action of the same time is not added again.

        Parameters
        ----------
        at
            the time of the request; None: now.
        """
        with self._database.writing() as connection:
            there = None if run is None or at is None else _of_that_time(connection, run, at)
            return there or add_action(connection, who, verb, data, run, at=at)

    def refused(self, who: User, verb: str, data: Mapping[str, Any], why: str) -> Action:
        """Add an action that was refused, without its run, which may not exist."""
        with self._database.writing() as connection:
            return add_action(connection, who, verb, data, None, why)

    def keep(self, action: Action) -> Action:
        """Write an action of a run that could not be written when it was requested.

        It gets an id now, unless it was written after all.
        """
        assert action.run is not None
        row = {key: value for key, value in vars(action).items() if key not in ("id", "kept")}
        with self._database.writing() as connection:
            there = _of_that_time(connection, action.run, action.at)
            write = insert(actions) if there is None else update(actions).where(actions.c.id == there.id)
            return Action(**connection.execute(write.values(row).returning(actions)).one()._mapping)

    def settle(self, action: int, outcome: str, applied_s: float | None = None) -> None:
        """Set the outcome: `done`, or why it was refused; of a run also the mission time.

        Raises
        ------
        NotFoundError
            if there is no such action.
        """
        values = {"outcome": outcome, "applied_s": applied_s}
        with self._database.writing() as connection:
            if connection.execute(update(actions).where(actions.c.id == action).values(values)).rowcount == 0:
                raise NotFoundError(f"no action {action}")

    def unsettled(self, run: int) -> list[Action]:
        """Actions of a run without an outcome, oldest first."""
        query = select(actions).where(actions.c.run == run, actions.c.outcome == "").order_by(actions.c.id)
        with self._database.reading() as connection:
            return [Action(**row._mapping) for row in connection.execute(query)]

    def list(self, run: int | None = None, limit: int = 200, before: int | None = None) -> list[Action]:
        """Actions of one run or of all, newest first; only ids below `before`, if given."""
        query = select(actions).order_by(actions.c.id.desc()).limit(limit)
        if run is not None:
            query = query.where(actions.c.run == run)
        if before is not None:
            query = query.where(actions.c.id < before)
        with self._database.reading() as connection:
            return [Action(**row._mapping) for row in connection.execute(query)]


def _of_that_time(connection: Connection, run: int, at: datetime) -> Action | None:
    """The action of a run at a time; the run's row is locked, so that no other transaction adds one."""
    connection.execute(select(runs.c.id).where(runs.c.id == run).with_for_update())
    row = connection.execute(select(actions).where(actions.c.run == run, actions.c.at == at)).first()
    return None if row is None else Action(**row._mapping)


def add_action(
    connection: Connection,
    who: User,
    verb: str,
    data: Mapping[str, Any],
    run: int | None,
    outcome: str = "",
    at: datetime | None = None,
    applied_s: float | None = None,
) -> Action:
    """A new action, within a transaction."""
    row = {
        "at": at or datetime.now(UTC),
        "who": who.name,
        "role": who.role,
        "address": who.address,
        "verb": verb,
        "data": dict(data),
        "run": run,
        "applied_s": applied_s,
        "outcome": outcome,
    }
    return Action(**connection.execute(insert(actions).values(row).returning(actions)).one()._mapping)
