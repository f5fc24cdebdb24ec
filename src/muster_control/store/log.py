"""The append-only log of runs: entries, and stretches of tracks; and the last checkpoints.

Triggers of the database, in the first migration, refuse changes.
"""

from __future__ import annotations

import json
import time
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from datetime import UTC, datetime
from typing import Any, TypeVar

from sqlalchemy import Connection, Row, Table, delete, func, insert, select, update

from muster.mission.errors import ParameterError
from muster_control.contract import Checkpoint, ConflictError, Entry, NotFoundError, Stretch
from muster_control.store.columns import as_json
from muster_control.store.database import Database, DatabaseTable
from muster_control.store.schema import bodies as body_table
from muster_control.store.schema import checkpoints, runs
from muster_control.store.schema import entries as entry_table
from muster_control.store.schema import stretches as stretch_table

_AT_ONCE, _ENTRIES_AT_ONCE = 64, 1000
_KEPT = 2
"""Checkpoints of a run that are kept: the one before the last is used where the last is damaged."""

Item = TypeVar("Item", Entry, Stretch)


class LogTable(DatabaseTable):
    def __init__(self, database: Database) -> None:
        super().__init__(database)
        self.observe: Callable[[float], None] = lambda seconds: None
        """Receives the seconds of each `append`, also of one that failed."""

    def append(
        self,
        run: int,
        time_s: float,
        entries: Sequence[Entry],
        stretches: Sequence[Stretch] = (),
        bodies: Mapping[str, Any] | None = None,
    ) -> int:
        """Append entries and stretches in one transaction; returns how many entries were new.

        Entries that exist are skipped, so a writer may repeat a write whose result it does not know; a different entry
        in their place is an error. Stretches are numbered by the writer and not compared. The run's `time_s` is raised
        to `time_s`, and its report becomes the data of an entry `report`. `bodies` says where they are after all this.

        Raises
        ------
        ConflictError
            if there is a gap before an entry or stretch, or another entry is there.
        NotFoundError
            if there is no such run.
        ParameterError
            if an entry or stretch is of another run.
        """
        with self._timed(), self._database.writing() as connection:
            row = connection.execute(select(runs.c.time_s).where(runs.c.id == run).with_for_update()).one_or_none()
            if row is None:
                raise NotFoundError(f"no run {run}")
            last = _last(connection, entry_table, run)
            _require_same(connection, run, [entry for entry in entries if entry.seq <= last])
            new = _following(run, last, entries)
            tracks = _following(run, _last(connection, stretch_table, run), stretches)
            now = datetime.now(UTC)
            if new:
                connection.execute(insert(entry_table), [_entry_row(entry, now) for entry in new])
            if tracks:
                connection.execute(insert(stretch_table), [dict(vars(stretch)) for stretch in tracks])
            changes: dict[str, Any] = {"time_s": time_s} if time_s > row.time_s else {}
            if report := next((entry for entry in new if entry.kind == "report"), None):
                changes["report"] = dict(report.data)
            if changes:
                connection.execute(update(runs).where(runs.c.id == run).values(changes))
            if bodies is not None:
                connection.execute(delete(body_table).where(body_table.c.run == run))
                connection.execute(insert(body_table).values(run=run, data=dict(bodies)))
        return len(new)

    def add_checkpoint(self, checkpoint: Checkpoint) -> None:
        """Write a checkpoint, and delete those that are no longer needed, in one transaction.

        Raises
        ------
        ConflictError
            if the log does not reach up to it, or the run has one of that entry.
        """
        run = checkpoint.run
        with self._database.writing() as connection:
            last, known = _last(connection, entry_table, run), _last(connection, checkpoints, run)
            if not known < checkpoint.seq <= last:
                expected = f"expected one after entry {known} up to {last}"
                raise ConflictError(f"run {run}: a checkpoint of entry {checkpoint.seq}; {expected}")
            connection.execute(insert(checkpoints).values(vars(checkpoint) | {"facts": dict(checkpoint.facts)}))
            of_run = checkpoints.c.run == run
            kept = select(checkpoints.c.seq).where(of_run).order_by(checkpoints.c.seq.desc()).limit(_KEPT)
            connection.execute(delete(checkpoints).where(of_run, checkpoints.c.seq.not_in(kept.scalar_subquery())))

    def checkpoints(self, run: int) -> list[Checkpoint]:
        """The checkpoints of a run, the newest first."""
        query = select(checkpoints).where(checkpoints.c.run == run).order_by(checkpoints.c.seq.desc())
        with self._database.reading() as connection:
            return [Checkpoint(**{**row._mapping, "data": bytes(row.data)}) for row in connection.execute(query)]

    def bodies(self, run: int) -> Mapping[str, Any] | None:
        """Where bodies are; None where that is not known."""
        with self._database.reading() as connection:
            found: Mapping[str, Any] | None = connection.execute(
                select(body_table.c.data).where(body_table.c.run == run)
            ).scalar()
        return found

    def entries(self, run: int, after: int = 0, limit: int | None = None) -> list[Entry]:
        """Entries with a `seq` above `after`, in order."""
        query = select(entry_table).where(entry_table.c.run == run, entry_table.c.seq > after)
        return self._read_all(Entry, query.order_by(entry_table.c.seq).limit(limit))

    def all_entries(self, run: int) -> Iterator[Entry]:
        """All entries in order, read in portions, so that few are in memory at once."""
        portion = self.entries(run, limit=_ENTRIES_AT_ONCE)
        while portion:
            yield from portion
            portion = self.entries(run, portion[-1].seq, _ENTRIES_AT_ONCE)

    def stretches(self, run: int) -> Iterator[Stretch]:
        """The tracks in order, read in portions, so that no transaction stays open while they are processed."""
        query = select(stretch_table).where(stretch_table.c.run == run).order_by(stretch_table.c.seq).limit(_AT_ONCE)
        rows = self._rows(query)
        while rows:
            yield from (Stretch(**{**row._mapping, "data": bytes(row.data)}) for row in rows)
            rows = self._rows(query.where(stretch_table.c.seq > rows[-1].seq))

    def tracked_s(self, run: int) -> float:
        """Until when there are tracks, 0 without any."""
        query = select(func.max(stretch_table.c.until_s)).where(stretch_table.c.run == run)
        with self._database.reading() as connection:
            return float(connection.execute(query).scalar() or 0.0)

    def last_stretch(self, run: int) -> int:
        """The `seq` of the last stretch, 0 without any."""
        with self._database.reading() as connection:
            return _last(connection, stretch_table, run)

    @contextmanager
    def _timed(self) -> Iterator[None]:
        began = time.perf_counter()
        try:
            yield
        finally:
            self.observe(time.perf_counter() - began)

    def _rows(self, query: Any) -> Sequence[Row[Any]]:
        with self._database.reading() as connection:
            return connection.execute(query).all()


def _last(connection: Connection, table: Table, run: int) -> int:
    last: int | None = connection.execute(select(func.max(table.c.seq)).where(table.c.run == run)).scalar()
    return last or 0


def _following(run: int, last: int, items: Sequence[Item]) -> list[Item]:
    """The new entries, which must follow `last` without a gap."""
    new: list[Item] = []
    for item in items:
        what = type(item).__name__.lower()
        if item.run != run or item.seq < 1:
            raise ParameterError(f"{what} {item.seq} of run {item.run}; expected 1 or more, of run {run}")
        if item.seq <= last:
            continue
        if item.seq > last + 1:
            raise ConflictError(f"run {run}: {what} {item.seq} does not follow {last}; expected {last + 1}")
        new.append(item)
        last = item.seq
    return new


def _require_same(connection: Connection, run: int, again: Sequence[Entry]) -> None:
    """Raise ConflictError unless repeated entries equal those in the log."""
    if not again:
        return
    numbers = [entry.seq for entry in again]
    query = select(entry_table).where(
        entry_table.c.run == run, entry_table.c.seq >= min(numbers), entry_table.c.seq <= max(numbers)
    )
    there = {row.seq: (row.time_s, row.kind, row.data) for row in connection.execute(query)}
    for entry in again:
        said = (entry.time_s, entry.kind, json.loads(as_json(dict(entry.data))))
        if entry.seq in there and there[entry.seq] != said:
            raise ConflictError(
                f"run {run}: entry {entry.seq} is {there[entry.seq][1]} at {there[entry.seq][0]:g} s, not {entry.kind} "
                f"at {entry.time_s:g} s; expected that one server alone writes this log"
            )


def _entry_row(entry: Entry, now: datetime) -> dict[str, Any]:
    return {**vars(entry), "data": dict(entry.data), "at": entry.at or now}
