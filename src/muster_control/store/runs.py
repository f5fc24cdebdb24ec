"""Runs: plans that are or were carried out. Their events are in their log."""

from __future__ import annotations

from collections.abc import Mapping
from datetime import UTC, datetime
from typing import Any, get_args

from sqlalchemy import Connection, insert, select, update

from muster_control.contract import OVER, PAGE_ROWS, ConflictError, NotFoundError, Run, RunState, User, World
from muster_control.store.actions import keep_actions, new_action
from muster_control.store.database import DatabaseTable, newest
from muster_control.store.request_keys import RequestKey, keyed
from muster_control.store.schema import runs

_UNDER_WAY = tuple(state for state in get_args(RunState) if state not in OVER)
_CHANGEABLE = frozenset({"state", "speed", "time_s", "remark", "resumed", "ended_at"})


class RunTable(DatabaseTable):
    def add(
        self,
        mission: str,
        mission_version: int,
        plan: int,
        world: World,
        settings: Mapping[str, Any],
        speed: float | None,
        author: str,
        by: User | None = None,
        request: RequestKey | None = None,
    ) -> Run:
        """Add a run in state *starting*, and in the same transaction the action of the user who starts it.

        Raises
        ------
        RepeatedRequestError, ConflictError
            if the request has a key that came before.
        """
        row = {
            "mission": mission,
            "mission_version": mission_version,
            "plan": plan,
            "world": world,
            "settings": dict(settings),
            "speed": speed,
            "state": "starting",
            "time_s": 0.0,
            "author": author,
            "at": datetime.now(UTC),
            "resumed": 0,
            "remark": "",
        }
        with self._database.writing() as connection, keyed(connection, request) as settle:
            run = Run(**connection.execute(insert(runs).values(row).returning(runs)).one()._mapping)
            if by is not None:
                said = {"plan": plan, "world": world, "speed": speed, "settings": dict(settings)}
                keep_actions(connection, [new_action(by, "run.start", said, run.id, "done", applied_s=0.0)])
            settle(run.id)
            return run

    def get(self, run: int) -> Run:
        """One run.

        Raises
        ------
        NotFoundError
            if there is none.
        """
        with self._database.reading() as connection:
            return _get(connection, run)

    def unfinished(self) -> list[Run]:
        """Runs that are not over, the oldest first."""
        query = select(runs).where(runs.c.state.not_in(OVER)).order_by(runs.c.id)
        return self._read_all(Run, query)

    def set(self, run: int, **fields: Any) -> Run:
        """Change `state`, `speed`, `time_s`, `remark`, `resumed` or `ended_at`.

        A run that is over ended now, if not told otherwise.

        Raises
        ------
        ConflictError
            if it is over, and would be in another state.
        NotFoundError
            if there is none.
        """
        if unknown := fields.keys() - _CHANGEABLE:
            raise TypeError(f"{', '.join(sorted(unknown))}: no field of a run that changes")
        with self._database.writing() as connection:
            before = _get(connection, run, to_write=True)
            state = fields.get("state", before.state)
            if before.state in OVER and state != before.state:
                raise ConflictError(f"run {run} is over: {before.state}")
            if state in OVER and before.ended_at is None:
                fields = {"ended_at": datetime.now(UTC), **fields}
            if not fields:
                return before
            changed = connection.execute(update(runs).where(runs.c.id == run).values(fields).returning(runs)).one()
            return Run(**changed._mapping)

    def list(
        self, limit: int = PAGE_ROWS, before: int | None = None, mission: str | None = None, *, over: bool = False
    ) -> list[Run]:
        """Runs, of one mission or all, or those alone that are over, the newest first; ids below `before`, if given."""
        query = newest(select(runs), runs, limit, before, mission=mission)
        if over:
            query = query.where(runs.c.state.not_in(_UNDER_WAY))  # most are over: the ids are read, no index of states
        return self._read_all(Run, query)


def _get(connection: Connection, run: int, *, to_write: bool = False) -> Run:
    query = select(runs).where(runs.c.id == run)
    row = connection.execute(query.with_for_update() if to_write else query).one_or_none()
    if row is None:
        raise NotFoundError(f"no run {run}")
    return Run(**row._mapping)
