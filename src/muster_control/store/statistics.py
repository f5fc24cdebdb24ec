"""Statistics of a database for metrics: numbers of jobs and runs, and the quality of the newest plans."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from typing import Any

from sqlalchemy import func, select

from muster.mission.plan import gap
from muster_control.store.schema import jobs, plans, runs
from muster_control.store.store import Store

_NEWEST = 20


@dataclass(frozen=True, kw_only=True)
class Statistics:
    """Counts by state, and of the newest that are over the mean, None where there are none.

    Parameters
    ----------
    job_s
        how long jobs took, from their beginning.
    gap
        how far plans that were made here may be from the best one: see `muster.mission.plan.gap`.
    flown
        the objective as measured over the planned one.
    """

    jobs: Mapping[str, int]
    runs: Mapping[str, int]
    job_s: float | None
    gap: float | None
    flown: float | None


def statistics(store: Store) -> Statistics:
    """The figures as they are now; raises StoreError."""
    took = select(jobs.c.begun_at, jobs.c.ended_at).where(jobs.c.state == "done", jobs.c.begun_at.is_not(None))
    done = took.order_by(jobs.c.id.desc()).limit(_NEWEST)
    made = select(plans.c.head).where(plans.c.origin == "planned").order_by(plans.c.id.desc()).limit(_NEWEST)
    ended = select(runs.c.report).where(runs.c.state == "ended").order_by(runs.c.id.desc()).limit(_NEWEST)
    with store.database.reading() as connection:
        of_jobs, of_runs = (
            {row[0]: row[1] for row in connection.execute(select(table.c.state, func.count()).group_by(table.c.state))}
            for table in (jobs, runs)
        )
        times = connection.execute(done).all()
        heads = [row.head for row in connection.execute(made)]
        reports = [row.report for row in connection.execute(ended)]
    return Statistics(
        jobs=of_jobs,
        runs=of_runs,
        job_s=_mean((ended_at - begun_at).total_seconds() for begun_at, ended_at in times),
        gap=_mean(_gap(head) for head in heads),
        flown=_mean(_flown(report or {}) for report in reports),
    )


def _gap(head: Mapping[str, Any]) -> float | None:
    value, bound = (head.get("objective") or {}).get("value"), head.get("lower_bound")
    return None if value is None or bound is None else gap(value, bound)


def _flown(report: Mapping[str, Any]) -> float | None:
    objective = report.get("objective") or {}
    planned, flown = objective.get("planned"), objective.get("flown")
    return flown / planned if planned and flown is not None else None


def _mean(values: Iterable[float | None]) -> float | None:
    known = [value for value in values if value is not None]
    return sum(known) / len(known) if known else None
