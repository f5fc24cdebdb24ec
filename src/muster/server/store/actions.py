"""Actions: what users did, and what came of it."""

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
        """A new action, whose outcome is not known yet; of a run one of that very time is not added again.

        Parameters
        ----------
        at
            when it was asked for; None: now.
        """
        with self._database.writing() as connection:
            there = None if run is None or at is None else _of_that_time(connection, run, at)
            return there or add_action(connection, who, verb, data, run, at=at)

    def refused(self, who: User, verb: str, data: Mapping[str, Any], why: str) -> Action:
        """A new action that was refused; of no run, as that of which it was asked may not be there."""
        with self._database.writing() as connection:
            return add_action(connection, who, verb, data, None, why)

    def keep(self, action: Action) -> Action:
        """Write down late what the database refused, or took without a word, when it was asked for in a run.

        It gets a number now, unless it is there already.
        """
        assert action.run is not None
        row = {key: value for key, value in vars(action).items() if key != "id"}
        with self._database.writing() as connection:
            there = _of_that_time(connection, action.run, action.at)
            write = insert(actions) if there is None else update(actions).where(actions.c.id == there.id)
            return Action(**connection.execute(write.values(row).returning(actions)).one()._mapping)

    def settle(self, action: int, outcome: str, applied_s: float | None = None) -> None:
        """What came of it: `done`, or why it was refused; of a run also when, on the mission's clock.

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
        """Actions of a run whose outcome is not known, the oldest first."""
        query = select(actions).where(actions.c.run == run, actions.c.outcome == "").order_by(actions.c.id)
        with self._database.reading() as connection:
            return [Action(**row._mapping) for row in connection.execute(query)]

    def list(self, run: int | None = None, limit: int = 200, before: int | None = None) -> list[Action]:
        """Actions, of one run or all, the newest first; with ids below `before`, if given."""
        query = select(actions).order_by(actions.c.id.desc()).limit(limit)
        if run is not None:
            query = query.where(actions.c.run == run)
        if before is not None:
            query = query.where(actions.c.id < before)
        with self._database.reading() as connection:
            return [Action(**row._mapping) for row in connection.execute(query)]


def _of_that_time(connection: Connection, run: int, at: datetime) -> Action | None:
    """The action of a run and a time; who holds the run's row looks and writes alone."""
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
