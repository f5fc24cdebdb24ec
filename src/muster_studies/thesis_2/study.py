"""The study: its tables, its legend, and how its runs are made."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from typing import Any

from muster_studies.descriptions import description
from muster_studies.effort import Effort
from muster_studies.repetition import OnDone, Performed, Repetition, one_by_one, over_seeds
from muster_studies.runs import Case
from muster_studies.thesis_2 import samples
from muster_studies.thesis_2.diversity import Diversity
from muster_studies.thesis_2.planners import PathPlanners
from muster_studies.thesis_2.ranking import Ranking, Verdicts


def _perform(
    jobs: Iterable[Any], seeds: int | None, workers: int, on_done: OnDone | None = None
) -> Performed[Any, Any]:
    """Runs of allocators spread over seeds and processes, then jobs that measure by themselves, one by one."""
    every = list(jobs)
    runs = over_seeds([job for job in every if isinstance(job, Case)], seeds, workers, on_done)
    rest = one_by_one(_measured)([job for job in every if not isinstance(job, Case)], None, 1, on_done)
    return Performed({**runs.found, **rest.found}, runs.runs + rest.runs, runs.cpu_s + rest.cpu_s)


def _measured(job: Any) -> Any:
    return job.measured()


def _remarks(effort: Effort, found: Mapping[Any, Any]) -> tuple[str, ...]:
    limit = f"{effort.iterations} iterations" if effort.iterations is not None else None
    budget = limit or f"{samples.seconds(effort):g} s of processor time"
    return (
        f"Every anytime allocator has {budget} for each plan, and {samples.seed_count(effort)} seeds; the others end "
        "by themselves and are not random. All values are muster.verify's, of each mission's own objective.",
    )


THESIS_2 = Repetition(
    **description("thesis-2"),
    reproductions=(Ranking(), Verdicts(), Diversity(), PathPlanners()),
    perform=_perform,
    seeds=samples.seed_count,
    extras=("studies", "map"),
    remarks=_remarks,
)
