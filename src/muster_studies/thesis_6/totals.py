"""Tables of totals, 6.3, 6.7, 6.10 and 6.11; and of own plans beside the published ones."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

from muster_studies.comparison_marks import ERRATUM, differences, equal_rule
from muster_studies.effort import Effort
from muster_studies.misprints import corrected, errata, printed
from muster_studies.tables import Cell, Notes, Table, row
from muster_studies.thesis_6.flights import ALLOCATOR, Flight, FlightResult
from muster_studies.thesis_6.published import MEASURED, PublishedPlan, excess, plans, tables

ITERATIONS, QUICK_ITERATIONS = 3000, 300
"""Of the own plans."""

CALCULATED, FLOWN, ACTIONS, ACTIONS_FLOWN = "own", "own, flown", "own, actions", "own, actions flown"
_COLUMNS = ("plan", "values", "tasks", "C", "C %", "F", "F %", "s", "mark")


TOTALS_RULE = equal_rule("C and F (recomputed of the plan; of measured ones the sums of the printed usages) are")


def search_iterations(effort: Effort) -> int:
    """How many iterations own plans get."""
    if effort.iterations is not None:
        return effort.iterations
    return QUICK_ITERATIONS if effort.quick else ITERATIONS


def search_flights(effort: Effort, mission: str, ignored: tuple[str, ...] = ()) -> list[Flight]:
    """Own plans of a mission with all seeds, carried out."""
    count = search_iterations(effort)
    return [Flight(mission=mission, iterations=count, ignored=ignored, seed=k) for k in range(effort.seed_count)]


def best_of(flights: Sequence[Flight], found: Mapping[Flight, FlightResult]) -> FlightResult:
    """The flight with the best plan, regardless of its outcome."""

    def rank(flight: Flight) -> tuple[float, float]:
        planned = found[flight].planned
        return -planned.weight_completed, total_and_greatest([route.usage for route in planned.routes])[1]

    return found[min(flights, key=rank)]


def total_and_greatest(usages: Sequence[float]) -> tuple[float, float]:
    """C, and F."""
    return sum(usages), sum(usages) + max(usages)


@dataclass(frozen=True)
class SystemTotals:
    """For each plan of a table of routes what it costs: calculated, measured, flown; then the same of own plans."""

    number: str
    routes: str

    def jobs(self, effort: Effort) -> Iterator[Flight]:
        for plan in plans(self.routes):
            yield plan.flight()
            if plan.with_actions is not None:
                yield plan.flight(plan.with_actions)
        for mission in self._missions:
            yield from search_flights(effort, mission, self._ignored)

    @property
    def _ignored(self) -> tuple[str, ...]:
        return plans(self.routes)[0].ignored

    @property
    def _missions(self) -> tuple[str, ...]:
        """Of own plans: that of the plan that was flown, and the same with actions."""
        (plan,) = (plan for plan in plans(self.routes) if plan.with_actions)
        return plan.mission, f"{plan.scenario}-actions"

    def table(self, effort: Effort, found: Mapping[Flight, FlightResult]) -> Table:
        notes, rows = Notes(), []
        for plan in plans(self.routes):
            rows += [row(_COLUMNS, cells) for cells in self._published(plan, found, notes)]
        for mission in self._missions:
            best = best_of(search_flights(effort, mission, self._ignored), found)
            rows += [row(_COLUMNS, cells) for cells in _own_plan(mission, best)]
        remark = (
            f"{ALLOCATOR}: own plans with {search_iterations(effort)} iterations, the best of {effort.seed_count} "
            f"seed{'s' if effort.seed_count > 1 else ''}; those of {self._missions[1]} know the ways within tasks."
        )
        lines = (*notes.lines(), remark)
        return Table(self.number, tables()[self.number]["title"], _COLUMNS, tuple(rows), lines, mark_rule=TOTALS_RULE)

    def _published(
        self, plan: PublishedPlan, found: Mapping[Flight, FlightResult], notes: Notes
    ) -> Iterator[dict[str, Cell]]:
        flown = found[plan.flight()]
        own = {"C": flown.planned.total_cost, "F": flown.planned.value("total+max")}
        label, count = f"{plan.figure} {plan.allocator}", flown.planned.tasks_completed
        for record in (r for r in tables()[self.number]["rows"] if r["allocator"] == plan.allocator):
            yield {"plan": label, "tasks": count, **_thesis_cells(record, plan, own, notes)}
        calculation = [route.usage for route in flown.planned.routes]
        yield {"plan": label, "values": CALCULATED, "tasks": count, **total_cells(calculation)}
        yield {"plan": label, "values": FLOWN, **_flown_cells(flown, calculation)}
        if plan.with_actions is not None:
            there = found[plan.flight(plan.with_actions)]
            planned = [route.usage for route in there.planned.routes]
            yield {"plan": label, "values": ACTIONS, "tasks": count, **total_cells(planned, calculation)}
            yield {"plan": label, "values": ACTIONS_FLOWN, **_flown_cells(there, calculation)}


def _thesis_cells(
    record: Mapping[str, Any], plan: PublishedPlan, own: Mapping[str, Cell], notes: Notes
) -> dict[str, Cell]:
    """A published row. The mark of a measured one tells whether it is the sum of the measured usages."""
    kind = record.get("measured")
    there, right = _figures(printed(record)), _figures(corrected(record))
    sums = own if kind is None else dict(zip(("C", "F"), total_and_greatest(plan.usages(kind)), strict=True))
    base = {} if kind is None else dict(zip(("C", "F"), total_and_greatest(plan.usages()), strict=True))
    numbers = " ".join(notes.number(f"{plan.figure} {plan.allocator}: {text}.") for text in errata(record))
    return {
        "values": "thesis" if kind is None else f"thesis, {MEASURED[kind]}",
        **there,
        **{f"{column} %": excess(right[column], base[column]) for column in base},
        "s": record.get("elapsed_s"),
        "mark": differences(right, sums, ("C", "F")) + (f" {ERRATUM} {numbers}" if numbers else ""),
    }


def _figures(record: Mapping[str, Any]) -> dict[str, float]:
    return {"C": record["total_cost"], "F": record["total+max"]}


def _own_plan(mission: str, flown: FlightResult) -> Iterator[dict[str, Cell]]:
    label, calculation = f"{ALLOCATOR}, {mission}", [route.usage for route in flown.planned.routes]
    count = flown.planned.tasks_completed
    yield {"plan": label, "values": CALCULATED, "tasks": count, **total_cells(calculation), "s": flown.planning_s}
    yield {"plan": label, "values": FLOWN, **_flown_cells(flown, calculation)}


def _flown_cells(flown: FlightResult, calculation: Sequence[float]) -> dict[str, Cell]:
    return {"tasks": len(flown.report.tasks_done), **total_cells(flown.usages, calculation)}


def total_cells(usages: Sequence[float], calculation: Sequence[float] | None = None) -> dict[str, Cell]:
    """Return C and F of usages, and by how much they are above those of a calculation, per cent."""
    values = dict(zip(("C", "F"), total_and_greatest(usages), strict=True))
    if calculation is None:
        return {**values}
    base = dict(zip(("C", "F"), total_and_greatest(calculation), strict=True))
    return {**values, **{f"{name} %": excess(values[name], base[name]) for name in values}}
