"""Table `actions`: plans whose tasks are paths with entry and exit, as planned and as carried out."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace

from muster_studies.effort import Effort
from muster_studies.tables import Cell, Table, row
from muster_studies.thesis_6.flights import ALLOCATOR, Flight, FlightResult
from muster_studies.thesis_6.published import MEASURED, PublishedPlan, excess, plans
from muster_studies.thesis_6.totals import best_of, search_flights

NEAR = "near"
WITHIN = 2.0
"""Per cent of what is planned, where no robot is in another's way."""
ALL = "all"


@dataclass(frozen=True)
class ActionPaths:
    """A row for each robot of each plan that was flown, and one for all; for own plans the latter alone."""

    number: str = "actions"
    routes: tuple[str, ...] = ("6.2", "6.6", "6.8", "6.9")
    columns: tuple[str, ...] = (
        "plan",
        "robot",
        "places",
        "planned",
        "alone",
        "alone %",
        "flown",
        "flown %",
        "places %",
        *(f"{name} %" for name in MEASURED.values()),
        "mark",
    )

    @property
    def plans(self) -> tuple[PublishedPlan, ...]:
        return tuple(plan for number in self.routes for plan in plans(number) if plan.with_actions)

    def jobs(self, effort: Effort) -> Iterator[Flight]:
        for plan in self.plans:
            flight = plan.flight(plan.with_actions)
            yield from (plan.flight(), flight, _alone(flight))
            for own in _own(effort, plan):
                yield from (own, _alone(own))

    def table(self, effort: Effort, found: Mapping[Flight, FlightResult]) -> Table:
        rows = []
        for plan in self.plans:
            flight = plan.flight(plan.with_actions)
            flown, alone = found[flight], found[_alone(flight)]
            robots = [route.robot for route in flown.planned.routes]
            places = [route.usage for route in found[plan.flight()].planned.routes]
            columns = {kind: plan.usages(kind) for kind in MEASURED}
            for k, robot in enumerate(robots):
                cells = _cells(flown, alone, slice(k, k + 1), places, columns, plan)
                rows.append(row(self.columns, {"plan": plan.figure, "robot": robot, **cells}))
            cells = _cells(flown, alone, slice(None), places, columns, plan)
            rows.append(row(self.columns, {"plan": plan.figure, "robot": ALL, **cells}))
            own = _own(effort, plan)
            best = best_of(own, found)
            flight = next(one for one in own if found[one] is best)
            cells = _cells(best, found[_alone(flight)], slice(None))
            rows.append(row(self.columns, {"plan": f"{ALLOCATOR}, {plan.figure}", "robot": ALL, **cells}))
        return Table(self.number, "Tasks as ways: planned and flown", self.columns, tuple(rows), _NOTES)


_NOTES = (
    "places: planned as the thesis does, to the middle of a task and a typed cost there; planned: by the ways of the "
    "tasks, from entry to exit. alone: flown without avoidance, so that no robot is in another's way; flown: with it "
    f"(ORCA). alone %, flown %: against planned. mark: {NEAR} if alone is within {WITHIN:g} % of planned.",
    f"{ALLOCATOR}: the own plan of Tables 6.3, 6.7, 6.10 and 6.11 for the tasks of that figure.",
    "places %: flown against places, to be held against Gazebo % and real %, which are what the thesis measured "
    "against what it calculated.",
    "The thesis prints no layout of tasks but patrols of 4 L: those of rasters and observations are assumed "
    "(16T-3R-actions). Its robots stop short of a goal by a threshold that is not printed; here they do not.",
)


def _alone(flight: Flight) -> Flight:
    return replace(flight, avoidance="none")


def _own(effort: Effort, plan: PublishedPlan) -> list[Flight]:
    return search_flights(effort, f"{plan.scenario}-actions", plan.ignored)


def _cells(
    flown: FlightResult,
    alone: FlightResult,
    which: slice,
    places: Sequence[float] | None = None,
    measured: Mapping[str, Sequence[float]] | None = None,
    plan: PublishedPlan | None = None,
) -> dict[str, Cell]:
    """The figures of some robots together; of own plans there are no published ones."""
    planned = sum([route.usage for route in flown.planned.routes][which])
    free, used = sum(alone.usages[which]), sum(flown.usages[which])
    off = excess(free, planned)
    cells: dict[str, Cell] = {
        "planned": planned,
        "alone": free,
        "alone %": off,
        "flown": used,
        "flown %": excess(used, planned),
        "mark": NEAR if abs(off) <= WITHIN else "more",
    }
    if places is None or measured is None or plan is None:
        return cells
    calculated = sum(plan.usages()[which])
    for kind, column in MEASURED.items():
        if measured[kind]:
            cells[f"{column} %"] = excess(sum(measured[kind][which]), calculated)
    return {**cells, "places": sum(places[which]), "places %": excess(used, sum(places[which]))}
