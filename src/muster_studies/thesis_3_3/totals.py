"""Tables of figures of whole plans: 3.2 to 3.4, 3.7, 3.10, 3.15, 3.19 to 3.22."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass
from typing import Any

from muster_studies.comparison_marks import ERRATUM, INFORMATION, differences, equal_rule, reached
from muster_studies.effort import Effort
from muster_studies.misprints import corrected, errata, printed
from muster_studies.runs import Case, Sample, rejection
from muster_studies.tables import Cell, Notes, Table, row
from muster_studies.thesis_3_3.budgets import budgets
from muster_studies.thesis_3_3.plans import published_plans
from muster_studies.thesis_3_3.published import as_run_notes, is_random, publication

_UNEVEN = "mean is over plans with different numbers of tasks completed, and worst that of the fewest tasks."
THESIS, OWN = "thesis", "own"
_LABELS = {"scenario": "mission", "allocator": "allocator", "figure": "figure", "objective": "objective"}
_PUBLISHED: Mapping[str, tuple[str, ...]] = {
    "iterations": ("iterations",),
    "tasks": ("tasks_completed",),
    "C": ("total_cost",),
    "max u": ("max_usage",),
    "F": ("total+max", "best"),
    "mean": ("mean",),
    "worst": ("worst",),
    "spread": ("worst_less_best",),
    "deviation": ("standard_deviation",),
    "E": ("equality_index",),
    "s": ("elapsed_s",),
}
"""For each column the keys of published rows that it may come from."""


@dataclass(frozen=True)
class Totals:
    """A table with a row of the thesis, then own rows, for each of its allocations.

    Parameters
    ----------
    columns
        between the labels and the mark.
    plans
        the table with the routes to which these figures belong.
    published_iterations
        whether the numbers of iterations are what the table is about, so that no greater ones are tried.
    """

    number: str
    labels: tuple[str, ...]
    columns: tuple[str, ...]
    plans: str | None = None
    published_iterations: bool = False

    def jobs(self, effort: Effort) -> Iterator[Case]:
        for record in publication(self.number).rows:
            yield from self._cases(record, effort)

    def _cases(self, record: Mapping[str, Any], effort: Effort) -> list[Case]:
        if record["allocator"] == "benchmark":
            return []
        mission, allocator, published = record["run_as"], record["allocator"], record.get("iterations", 0)
        counts: tuple[int | None, ...] = (None,)
        if is_random(allocator):
            counts = budgets(effort, mission, allocator, published)
            counts = counts[:1] if self.published_iterations else counts
        return [
            Case(
                mission=mission,
                allocator=allocator,
                ignored=tuple(record["ignored"]),
                objective=record["objective"],
                iterations=count,
            )
            for count in counts
        ]

    def table(self, effort: Effort, samples: Mapping[Case, Sample]) -> Table:
        published, notes = publication(self.number), Notes()
        columns = (*self.labels, "values", *self.columns, "mark")
        rows = []
        for record in published.rows:
            cells = {**_labels(record), **_thesis_cells(printed(record)), "mark": _errata_mark(record, notes)}
            rows.append(row(columns, cells))
            for case in self._cases(record, effort):
                own = own_cells(samples[case])
                mark = self._mark(record, samples[case], own, notes)
                rows.append(row(columns, {**_labels(record), **own, "mark": mark}))
        missions = as_run_notes(record.get("run_as", "") for record in published.rows)
        remarks = [*_sources(published.rows), *([published.content["note"]] if "note" in published.content else ())]
        lines = (*notes.lines(), *remarks, *missions)
        return Table(self.number, published.title, columns, tuple(rows), lines, mark_rule=_RULE)

    def _mark(self, record: Mapping[str, Any], sample: Sample, own: Mapping[str, Cell], notes: Notes) -> str:
        there = _thesis_cells(corrected(record))
        if not is_random(record["allocator"]):
            return differences(there, own, ("tasks", "C", "max u", "F", "E"))
        marks = [notes.number(_UNEVEN)] if isinstance(own["tasks"], str) else []
        broken = self._broken_rule(record)
        if broken is not None:
            return " ".join([f"{INFORMATION} {notes.number(broken)}", *marks])
        objective = "C" if record["objective"] == "total" else "F"
        return " ".join([reached(sample, there[objective], there["tasks"]), *_missed(there, own), *marks])

    def _broken_rule(self, record: Mapping[str, Any]) -> str | None:
        """Why the published figure is no figure to reach; None if its plan holds, or is not known."""
        if self.plans is None:
            return None
        verdict = published_plans(self.plans)[record["mission"]].as_corrected
        if verdict.valid:
            return None
        return f"for information: the published plan breaks the rule (Table {self.plans}; {rejection(verdict)})."


_RULE = equal_rule("all of tasks, C, max u, F and E that are printed are")


def _labels(record: Mapping[str, Any]) -> dict[str, Cell]:
    labels: dict[str, Cell] = {column: record.get(key) for column, key in _LABELS.items()}
    return {**labels, "rules ignored": tuple(record["ignored"])}


def _thesis_cells(record: Mapping[str, Any]) -> dict[str, Any]:
    cells: dict[str, Any] = {"values": THESIS}
    for column, keys in _PUBLISHED.items():
        value = next((record[key] for key in keys if key in record), None)
        cells[column] = tuple(value) if isinstance(value, list) else value
    return cells


def _sources(records: Iterable[Mapping[str, Any]]) -> Iterator[str]:
    """Where the thesis takes a table's rows from, if that is another table."""
    numbers = [record["table"] for record in records if "table" in record]
    if numbers:
        yield f"The rows of the thesis are from Tables {', '.join(numbers)}."


def _errata_mark(record: Mapping[str, Any], notes: Notes) -> str | None:
    where = ", ".join(str(record[key]) for key in ("mission", "allocator"))
    marks = [f"{ERRATUM} {notes.number(f'{where}: {text}.')}" for text in errata(record)]
    return ", ".join(marks) or None


def own_cells(sample: Sample) -> dict[str, Cell]:
    """What a table shows of a case; C, F and the like are of the best run."""
    verdict = sample.best.verdict
    cells: dict[str, Cell] = {
        "values": OWN,
        "tasks": _tasks(sample),
        "C": verdict.total_cost,
        "max u": verdict.max_usage,
        "F": verdict.value("total+max"),
        "E": verdict.equality_index,
        "s": sample.cpu_s,
    }
    if sample.best.case.random:
        cells |= {
            "iterations": sample.best.iterations,
            "mean": sample.mean,
            "worst": sample.worst.value,
            "spread": sample.worst.value - sample.best.value,
            "deviation": sample.deviation,
        }
    return cells


def _tasks(sample: Sample) -> Cell:
    most, fewest = (outcome.verdict.tasks_completed for outcome in (sample.best, sample.worst))
    return most if most == fewest else f"{fewest}-{most}"


def _missed(there: Mapping[str, Any], own: Mapping[str, Cell]) -> Iterator[str]:
    """The statistics that the thesis states and that came out greater."""
    for column in ("mean", "worst"):
        here = own.get(column)
        if there[column] is not None and isinstance(here, float) and here > there[column]:
            yield f"{column} {here - there[column]:+.2f}"
