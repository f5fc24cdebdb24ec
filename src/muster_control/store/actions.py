"""Actions of users and their outcomes.

The id of an action is the moment of its request in microseconds since 1970, so an action has an id before it is
written, and may be written twice without harm. (Databases of older Musters have actions that were counted from 1.)
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import asdict
from datetime import UTC, datetime, timedelta
from threading import Lock
from typing import Any

from sqlalchemy import Connection, select, update

from muster_control.contract import PAGE_ROWS, Action, NotFoundError, User
from muster_control.store.database import DatabaseTable, insert_of, newest
from muster_control.store.schema import actions

_1970 = datetime(1970, 1, 1, tzinfo=UTC)
_lock = Lock()
_last = _1970


def new_action(
    who: User,
    verb: str,
    data: Mapping[str, Any],
    run: int | None = None,
    outcome: str = "",
    applied_s: float | None = None,
) -> Action:
    """Return an action of now that is not in the database; each has another moment, later than those before."""
    global _last
    with _lock:
        _last = at = max(datetime.now(UTC), _last + timedelta(microseconds=1))
    return Action(
        id=id_at(at),
        at=at,
        who=who.name,
        role=who.role,
        address=who.address,
        verb=verb,
        data=dict(data),
        run=run,
        outcome=outcome,
        applied_s=applied_s,
        kept=False,
    )


def id_at(at: datetime) -> int:
    """Return the id of the action of a moment."""
    return (at - _1970) // timedelta(microseconds=1)


class ActionTable(DatabaseTable):
    def add(self, who: User, verb: str, data: Mapping[str, Any], run: int | None = None, outcome: str = "") -> Action:
        """Add an action of now."""
        action = new_action(who, verb, data, run, outcome)
        self.keep([action])
        return action.as_kept()

    def keep(self, given: Sequence[Action]) -> None:
        """Write actions; of those that are there already the outcome, if there is one."""
        if given:
            with self._database.writing() as connection:
                keep_actions(connection, given)

    def settle(self, action: int, outcome: str, applied_s: float | None = None) -> None:
        """Set the outcome: `done`, or why it was refused; of a run also the mission time.

        Raises
        ------
        NotFoundError
            if there is no such action.
        """
        with self._database.writing() as connection:
            written = update(actions).where(actions.c.id == action).values(outcome=outcome, applied_s=applied_s)
            if connection.execute(written).rowcount == 0:
                raise NotFoundError(f"no action {action}")

    def unsettled(self, run: int) -> list[Action]:
        """Actions of a run without an outcome, oldest first."""
        query = select(actions).where(actions.c.run == run, actions.c.outcome == "").order_by(actions.c.id)
        return self._read_all(Action, query)

    def list(self, run: int | None = None, limit: int = PAGE_ROWS, before: int | None = None) -> list[Action]:
        """Actions of one run or of all, newest first; only ids below `before`, if given."""
        query = newest(select(actions), actions, limit, before, run=run)
        return self._read_all(Action, query)


def keep_actions(connection: Connection, given: Sequence[Action]) -> None:
    """As `ActionTable.keep`, within a transaction."""
    write: Any = insert_of(connection, actions)
    settled = {name: write.excluded[name] for name in ("outcome", "applied_s")}
    write = write.on_conflict_do_update(index_elements=[actions.c.id], set_=settled, where=write.excluded.outcome != "")
    connection.execute(write, [{key: value for key, value in asdict(one).items() if key != "kept"} for one in given])
