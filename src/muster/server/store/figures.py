"""What metrics say of a database: how many jobs and runs there are, and how good the newest plans were."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from typing import Any

from sqlalchemy import func, select

from muster.server.store.schema import jobs, runs
from muster.server.store.store import Store

_NEWEST = 20


@dataclass(frozen=True, kw_only=True)
class Figures:
    """Counts by state, and of the newest that are over the mean, None where there are none.

    Parameters
    ----------
    job_s
        how long jobs took, from their beginning.
    gap
        how far plans may be from the best one: (objective - bound) / objective.
    flown
        the objective as measured over the planned one.
    """

    jobs: Mapping[str, int]
    runs: Mapping[str, int]
    job_s: float | None
    gap: float | None
    flown: float | None


def figures(store: Store) -> Figures:
    """The figures as they are now; raises StoreError."""
    done = select(jobs).where(jobs.c.state == "done").order_by(jobs.c.id.desc()).limit(_NEWEST)
    ended = select(runs.c.report).where(runs.c.state == "ended").order_by(runs.c.id.desc()).limit(_NEWEST)
    with store.database.reading() as connection:
        of_jobs, of_runs = (
            {row[0]: row[1] for row in connection.execute(select(table.c.state, func.count()).group_by(table.c.state))}
            for table in (jobs, runs)
        )
        newest = [row._mapping for row in connection.execute(done)]
        reports = [row.report for row in connection.execute(ended)]
    return Figures(
        jobs=of_jobs,
        runs=of_runs,
        job_s=_mean((job["ended_at"] - job["begun_at"]).total_seconds() for job in newest if job["begun_at"]),
        gap=_mean(_gap(job["progress"] or {}) for job in newest),
        flown=_mean(_flown(report or {}) for report in reports),
    )


def _gap(progress: Mapping[str, Any]) -> float | None:
    objective, bound = progress.get("objective"), progress.get("bound")
    return (objective - bound) / objective if objective and bound is not None else None


def _flown(report: Mapping[str, Any]) -> float | None:
    objective = report.get("objective") or {}
    planned, flown = objective.get("planned"), objective.get("flown")
    return flown / planned if planned and flown is not None else None


def _mean(values: Iterable[float | None]) -> float | None:
    known = [value for value in values if value is not None]
    return sum(known) / len(known) if known else None
