"""Jobs in the database, from request to end."""

from __future__ import annotations

from collections.abc import Mapping
from datetime import UTC, datetime
from typing import Any

from sqlalchemy import Connection, insert, select, update

from muster_control.contract import PAGE_ROWS, ConflictError, Job, JobState, NotFoundError
from muster_control.store.database import DatabaseTable, newest
from muster_control.store.plans import add_plan
from muster_control.store.request_keys import RequestKey, keyed
from muster_control.store.schema import jobs


class JobTable(DatabaseTable):
    def add(
        self,
        kind: str,
        mission: str,
        mission_version: int,
        arguments: Mapping[str, Any],
        author: str,
        request: RequestKey | None = None,
    ) -> Job:
        """Add a queued job.

        Raises
        ------
        RepeatedRequestError, ConflictError
            if the request has a key that came before.
        """
        row = {
            "kind": kind,
            "state": "queued",
            "mission": mission,
            "mission_version": mission_version,
            "arguments": dict(arguments),
            "author": author,
            "asked_at": datetime.now(UTC),
            "error": "",
        }
        with self._database.writing() as connection, keyed(connection, request) as settle:
            job = Job(**connection.execute(insert(jobs).values(row).returning(jobs)).one()._mapping)
            settle(job.id)
            return job

    def get(self, job: int) -> Job:
        """One job.

        Raises
        ------
        NotFoundError
            if there is none.
        """
        with self._database.reading() as connection:
            return _get(connection, job)

    def begin(self, job: int) -> Job:
        """Set a queued job running.

        Raises
        ------
        ConflictError
            if it is not queued: cancelled, for example.
        NotFoundError
            if there is none.
        """
        return self._move(job, ("queued",), state="running", begun_at=datetime.now(UTC))

    def progress(self, job: int, data: Mapping[str, Any]) -> None:
        """Set the progress of a running job; ignored for other jobs."""
        under_way = (jobs.c.id == job, jobs.c.state == "running")
        with self._database.writing() as connection:
            connection.execute(update(jobs).where(*under_way).values(progress=dict(data)))

    def end(self, job: int, state: JobState, result: Mapping[str, Any] | None = None, error: str = "") -> Job:
        """End a job: `done`, `failed` or `cancelled`.

        Raises
        ------
        ConflictError
            if it was over already.
        NotFoundError
            if there is none.
        """
        over = {"state": state, "result": None if result is None else dict(result), "error": error}
        return self._move(job, ("queued", "running"), **over, ended_at=datetime.now(UTC))

    def end_with_plan(self, job: int, plan: Mapping[str, Any], why: str, progress: Mapping[str, Any] | None) -> Job:
        """End a job and store its plan in one transaction, so that a crash cannot lead to a second plan.

        Raises
        ------
        ConflictError
            if it is not under way: cancelled, for example.
        NotFoundError
            if there is none.
        """
        with self._database.writing() as connection:
            over = {"state": "done", "ended_at": datetime.now(UTC)}
            if progress is not None:
                over["progress"] = dict(progress)
            moved = _move(connection, job, ("running",), **over)
            entry = add_plan(connection, moved.mission, moved.mission_version, "planned", moved.author, plan)
            return _move(connection, job, ("done",), result={"plan": entry.id, "why": why})

    def requeue(self) -> list[Job]:
        """Queue jobs again that were running when the server ended; returns all queued jobs, oldest first."""
        again = {"state": "queued", "begun_at": None, "progress": None}
        with self._database.writing() as connection:
            connection.execute(update(jobs).where(jobs.c.state == "running").values(again))
            rows = connection.execute(select(jobs).where(jobs.c.state == "queued").order_by(jobs.c.id))
            return [Job(**row._mapping) for row in rows]

    def _move(self, job: int, states: tuple[JobState, ...], **values: Any) -> Job:
        with self._database.writing() as connection:
            return _move(connection, job, states, **values)

    def list(
        self,
        state: JobState | None = None,
        mission: str | None = None,
        limit: int = PAGE_ROWS,
        before: int | None = None,
    ) -> list[Job]:
        """Jobs of one state and mission or of all, newest first; with ids below `before`, if given."""
        query = newest(select(jobs), jobs, limit, before, state=state, mission=mission)
        return self._read_all(Job, query)


def _move(connection: Connection, job: int, states: tuple[JobState, ...], **values: Any) -> Job:
    which = (jobs.c.id == job, jobs.c.state.in_(states))
    moved = connection.execute(update(jobs).where(*which).values(values).returning(jobs)).one_or_none()
    if moved is None:
        found = _get(connection, job)
        raise ConflictError(f"job {job} is {found.state}; expected one that is {' or '.join(states)}")
    return Job(**moved._mapping)


def _get(connection: Connection, job: int) -> Job:
    row = connection.execute(select(jobs).where(jobs.c.id == job)).one_or_none()
    if row is None:
        raise NotFoundError(f"no job {job}")
    return Job(**row._mapping)
