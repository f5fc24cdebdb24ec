"""A study as a list of tables: the runs that they need, and the tables made from the results."""

from __future__ import annotations

import time
from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass
from typing import Any, Generic, Protocol, TypeVar

from muster_studies.effort import Effort
from muster_studies.figures import StudyFigure
from muster_studies.processes import run_cases
from muster_studies.runs import Case, Sample
from muster_studies.tables import Report, Table

OnDone = Callable[[int, int], None]
"""Called with the number of runs done, and of all runs."""

Job = TypeVar("Job")
Found = TypeVar("Found")
FoundIn = TypeVar("FoundIn", contravariant=True)


class Reproduction(Protocol[Job, FoundIn]):
    """One table repeated. Jobs that are equal, of several tables too, are done once."""

    @property
    def number(self) -> str: ...

    def jobs(self, effort: Effort) -> Iterable[Job]: ...

    def table(self, effort: Effort, found: Mapping[Job, FoundIn]) -> Table: ...


@dataclass(frozen=True)
class Performed(Generic[Job, Found]):
    """The results of all jobs, the number of runs, and their processor time."""

    found: Mapping[Job, Found]
    runs: int
    cpu_s: float


Performer = Callable[[Iterable[Job], int | None, int, OnDone | None], Performed[Job, Found]]
"""Does jobs, of which some may be equal, with a number of seeds (None: nothing is random) and of processes."""


def _accept(effort: Effort) -> None:
    """Accept any effort."""


def _no_remarks(effort: Effort, found: Mapping[Any, Any]) -> tuple[str, ...]:
    return ()


@dataclass(frozen=True, kw_only=True)
class Repetition(Generic[Job, Found]):
    """A study as a list of tables.

    Parameters
    ----------
    document
        the publication that is repeated.
    reproductions
        the tables, in order.
    perform
        does the jobs.
    seeds
        how many seeds there are for an effort; None where nothing is random.
    extras
        the optional parts of Muster that it needs.
    always
        the numbers of tables that are made whatever tables are wanted.
    check
        raises what an effort, or a part that is not installed, does not allow.
    remarks
        lines of the legend that depend on the effort and on what was found.
    figures
        the pictures that it draws, in order.
    """

    name: str
    summary: str
    document: str
    reproductions: tuple[Reproduction[Job, Found], ...]
    perform: Performer[Job, Found]
    legend: tuple[str, ...] = ()
    seeds: Callable[[Effort], int | None] = lambda effort: effort.seed_count
    extras: tuple[str, ...] = ()
    always: tuple[str, ...] = ()
    check: Callable[[Effort], None] = _accept
    remarks: Callable[[Effort, Mapping[Job, Found]], tuple[str, ...]] = _no_remarks
    figures: tuple[StudyFigure, ...] = ()

    @property
    def tables(self) -> tuple[str, ...]:
        return tuple(table.number for table in self.reproductions)

    def run(self, effort: Effort, workers: int = 1, on_done: OnDone | None = None) -> Report:
        """Repeat all tables, or those that `effort` names.

        Raises
        ------
        ParameterError
            if there is no such table, or the study cannot be repeated with this effort.
        MissingExtraError
            if a part that it needs is not installed.
        """
        self.check(effort)
        numbers, seeds = (*effort.wanted(self.tables), *self.always), self.seeds(effort)
        wanted = [table for table in self.reproductions if table.number in numbers]
        done = self.perform([job for table in wanted for job in table.jobs(effort)], seeds, workers, on_done)
        return Report(
            study=self.name,
            document=self.document,
            seeds=seeds,
            runs=done.runs,
            cpu_s=done.cpu_s,
            legend=(*self.legend, *self.remarks(effort, done.found)),
            tables=tuple(table.table(effort, done.found) for table in wanted),
        )


def one_by_one(do: Callable[[Job], Found]) -> Performer[Job, Found]:
    """Each job is one run in this process; `workers` is ignored."""

    def perform(
        jobs: Iterable[Job], seeds: int | None, workers: int, on_done: OnDone | None = None
    ) -> Performed[Job, Found]:
        different, begin = list(dict.fromkeys(jobs)), time.process_time()
        found: dict[Job, Found] = {}
        for job in different:
            found[job] = do(job)
            if on_done is not None:
                on_done(len(found), len(different))
        return Performed(found, len(found), time.process_time() - begin)

    return perform


def over_seeds(
    cases: Iterable[Case], seeds: int | None, workers: int, on_done: OnDone | None = None
) -> Performed[Case, Sample]:
    """Each case is run with all seeds, spread over processes."""
    samples = run_cases(cases, seeds or 1, workers, on_done)
    outcomes = [outcome for sample in samples.values() for outcome in sample.outcomes]
    return Performed(samples, len(outcomes), sum(outcome.cpu_s for outcome in outcomes))
