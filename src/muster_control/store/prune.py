"""Deletes old data: what ended long ago, and what nothing refers to any more.

The room of it is used for what comes; the file of SQLite does not shrink. The log of a run is deleted with its run
alone: a trigger refuses any other way (see `schema.pruning`).
"""

from __future__ import annotations

from dataclasses import dataclass, fields
from datetime import UTC, datetime, timedelta
from typing import Any

from sqlalchemy import (
    ColumnElement,
    Connection,
    Select,
    Table,
    and_,
    delete,
    exists,
    func,
    insert,
    not_,
    or_,
    select,
    text,
)

from muster_control.contract import JOB_OVER, OVER
from muster_control.store.backup import existing, require_newest
from muster_control.store.schema import (
    actions,
    blobs,
    bodies,
    checkpoints,
    entries,
    jobs,
    mission_files,
    mission_versions,
    missions,
    plans,
    pruning,
    runs,
    stretches,
)

_DECIDE = (jobs, runs, missions, mission_versions, plans, blobs, mission_files)
"""What says which of them go; in the order in which a server writes to them, so that there is no deadlock with one."""

_START = jobs.c.arguments["start"].as_integer()  # the plan that a job goes on from


@dataclass(frozen=True)
class Pruned:
    """How many rows of each kind went, or would go."""

    runs: int = 0
    entries: int = 0
    stretches: int = 0
    actions: int = 0
    jobs: int = 0
    plans: int = 0
    mission_versions: int = 0
    missions: int = 0
    files: int = 0

    def __add__(self, other: Pruned) -> Pruned:
        return Pruned(*(getattr(self, f.name) + getattr(other, f.name) for f in fields(self)))


def prune(url: str, older_than_days: float, *, dry_run: bool = False) -> Pruned:
    """Delete what is older and over: runs with their log and actions, other actions, jobs; then what nothing refers to.

    That are plans and versions of missions, as old, and missions that were deleted, without any versions left.
    The newest plan of a mission stays, and the newest version of one that was not deleted. Each run is a transaction of
    its own, and so is the rest, so a server at work waits for one of them at most.

    Raises
    ------
    StoreError
        if the database cannot be written.
    """
    old = _Old(datetime.now(UTC) - timedelta(days=older_than_days))
    with existing(url) as database:
        require_newest(database)
        if dry_run:
            with database.snapshot() as connection:
                return _counted(connection, old)
        pruned = Pruned()
        with database.reading() as connection:
            over = connection.execute(select(runs.c.id).where(old.runs)).scalars().all()
        for run in over:
            with database.writing() as connection:
                pruned += _delete_run(connection, run)
        with database.writing() as connection:
            return pruned + _delete_others(connection, old)


class _Old:
    """Conditions on rows: which of them go. They hold before, while and after what they name is deleted."""

    def __init__(self, before: datetime) -> None:
        self.runs = and_(runs.c.state.in_(OVER), runs.c.ended_at < before)
        self.actions = and_(actions.c.run.is_(None), actions.c.at < before)
        self.jobs = and_(jobs.c.state.in_(JOB_OVER), jobs.c.ended_at < before)
        later = plans.alias("later")
        self.plans = and_(
            plans.c.at < before,
            exists(select(later.c.id).where(later.c.mission == plans.c.mission, later.c.version > plans.c.version)),
            ~exists(select(runs.c.id).where(runs.c.plan == plans.c.id, not_(self.runs))),
            plans.c.id.not_in(select(_START).where(_START.is_not(None), not_(self.jobs))),
        )
        self.mission_versions = and_(
            mission_versions.c.at < before,
            or_(_of_mission(missions.c.hidden), ~_of_mission(missions.c.newest == mission_versions.c.version)),
            *(
                ~exists(select(table.c.id).where(*_of_version(table), not_(gone)))
                for table, gone in ((plans, self.plans), (jobs, self.jobs), (runs, self.runs))
            ),
        )
        self.missions = ~exists(
            select(mission_versions.c.version).where(
                mission_versions.c.mission == missions.c.id, not_(self.mission_versions)
            )
        )
        self.mission_files = exists(
            select(mission_versions.c.version).where(
                mission_versions.c.mission == mission_files.c.mission,
                mission_versions.c.version == mission_files.c.version,
                self.mission_versions,
            )
        )
        self.files = ~exists(
            select(mission_files.c.name).where(mission_files.c.sha256 == blobs.c.sha256, not_(self.mission_files))
        )


def _of_mission(condition: ColumnElement[bool]) -> ColumnElement[bool]:
    return exists(select(missions.c.id).where(missions.c.id == mission_versions.c.mission, condition))


def _of_version(table: Table) -> tuple[ColumnElement[bool], ...]:
    return (
        table.c.mission == mission_versions.c.mission,
        table.c.mission_version == mission_versions.c.version,
    )


def _counted(connection: Connection, old: _Old) -> Pruned:
    def count(table: Table, condition: ColumnElement[bool]) -> int:
        counted: int = connection.execute(select(func.count()).select_from(table).where(condition)).scalar_one()
        return counted

    gone: Select[Any] = select(runs.c.id).where(old.runs)
    return Pruned(
        runs=count(runs, old.runs),
        entries=count(entries, entries.c.run.in_(gone)),
        stretches=count(stretches, stretches.c.run.in_(gone)),
        actions=count(actions, or_(actions.c.run.in_(gone), old.actions)),
        jobs=count(jobs, old.jobs),
        plans=count(plans, old.plans),
        mission_versions=count(mission_versions, old.mission_versions),
        missions=count(missions, old.missions),
        files=count(blobs, old.files),
    )


def _delete_run(connection: Connection, run: int) -> Pruned:
    connection.execute(insert(pruning).values(run=run))
    for table in (checkpoints, bodies):
        _delete(connection, table, table.c.run == run)
    pruned = Pruned(
        entries=_delete(connection, entries, entries.c.run == run),
        stretches=_delete(connection, stretches, stretches.c.run == run),
        actions=_delete(connection, actions, actions.c.run == run),
        runs=_delete(connection, runs, runs.c.id == run),
    )
    connection.execute(delete(pruning).where(pruning.c.run == run))
    return pruned


def _delete_others(connection: Connection, old: _Old) -> Pruned:
    """In an order in which nothing is deleted before what refers to it."""
    _let_nobody_write(connection)
    return Pruned(
        actions=_delete(connection, actions, old.actions),
        jobs=_delete(connection, jobs, old.jobs),
        plans=_delete(connection, plans, old.plans),
        **_delete_missions(connection, old),
    )


def _let_nobody_write(connection: Connection) -> None:
    """Lock out writers until the transaction ends, as SQLite does: all statements must see the same rows."""
    if connection.dialect.name == "postgresql":
        names = ", ".join(table.name for table in _DECIDE)
        connection.execute(text(f"LOCK TABLE {names} IN SHARE ROW EXCLUSIVE MODE"))


def _delete_missions(connection: Connection, old: _Old) -> dict[str, int]:
    _delete(connection, mission_files, old.mission_files)
    versions = _delete(connection, mission_versions, old.mission_versions)
    gone = _delete(connection, missions, old.missions)
    return {"mission_versions": versions, "missions": gone, "files": _delete(connection, blobs, old.files)}


def _delete(connection: Connection, table: Table, condition: ColumnElement[bool]) -> int:
    return connection.execute(delete(table).where(condition)).rowcount
