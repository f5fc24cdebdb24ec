"""Tables of routes, 6.2, 6.6, 6.8 and 6.9: each robot's usage, calculated, measured, and flown here."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass

from muster.execution.reports.report import Report
from muster_studies.comparison_marks import EQUAL, ERRATUM, equal, equal_rule
from muster_studies.effort import Effort
from muster_studies.misprints import errata, printed
from muster_studies.tables import Cell, Notes, Table, row
from muster_studies.thesis_6.flights import Flight, FlightResult
from muster_studies.thesis_6.published import MEASURED, PublishedPlan, excess, plans, tables

USAGE_RULE = equal_rule("own, the calculated usage, is")


@dataclass(frozen=True)
class RobotUsages:
    """A row for each robot of each plan. The corrected plan is what is judged and flown, tasks as places with costs."""

    number: str

    def jobs(self, effort: Effort) -> Iterator[Flight]:
        for plan in plans(self.number):
            yield plan.flight()

    def table(self, effort: Effort, found: Mapping[Flight, FlightResult]) -> Table:
        measured = [kind for kind in MEASURED if any(plan.usages(kind) for plan in plans(self.number))]
        beside = [column for kind in measured for column in (MEASURED[kind], f"{MEASURED[kind]} %")]
        columns = ("figure", "robot", "tasks", "thesis", "own", "mark", *beside, "flown", "flown %")
        notes, rows = Notes(), []
        for plan in plans(self.number):
            flown = found[plan.flight()]
            for own, usage in zip(flown.planned.routes, flown.usages, strict=True):
                cells = published_cells(plan, own.robot, own.usage, notes)
                cells |= {"flown": usage, "flown %": excess(usage, own.usage)}
                rows.append(row(columns, cells))
        flights = [found[plan.flight()] for plan in plans(self.number)]
        remarks = [_carried_out(plan, flown) for plan, flown in zip(plans(self.number), flights, strict=True)]
        title = f"{tables()[self.number]['title']}: usage of each robot{_rules(self.number)}"
        return Table(self.number, title, columns, tuple(rows), (*notes.lines(), *remarks), mark_rule=USAGE_RULE)


def published_cells(plan: PublishedPlan, robot: str, own: float, notes: Notes) -> dict[str, Cell]:
    """Return what the thesis calculated and measured for a robot, beside its own usage."""
    there = plan.usage(robot)
    assert there is not None  # every plan was calculated
    mark = EQUAL if equal(there, own) else f"{own - there:+.2f}"
    texts = [f"{plan.figure}, {robot}: {text}." for text in errata(plan.routes[robot])]
    cells: dict[str, Cell] = {
        "figure": plan.figure,
        "robot": robot,
        "tasks": plan.printed_tasks(robot),
        "thesis": printed(plan.routes[robot])["usage"],
        "own": own,
        "mark": mark + "".join(f" {ERRATUM} {notes.number(text)}" for text in texts),
    }
    for kind, column in MEASURED.items():
        value = plan.usage(robot, kind)
        if value is not None:
            cells |= {column: value, f"{column} %": excess(value, there)}
    return cells


def contacts_of(report: Report) -> str:
    """Return how often robots touched, and how near they came to each other, in words."""
    apart = "" if report.min_distance_m is None else f", at least {report.min_distance_m:.2f} m between centres"
    return f"{report.contacts or 'no'} contact{'' if report.contacts == 1 else 's'}{apart}"


def _carried_out(plan: PublishedPlan, flown: FlightResult) -> str:
    report = flown.report
    return (
        f"{plan.figure} ({plan.allocator}, run as {plan.mission}), carried out: {len(report.tasks_done)} of "
        f"{flown.planned.tasks_total} tasks done, {flown.lost} of those planned lost; {contacts_of(report)}; "
        f"{report.mission_time_s:.0f} s, {report.waiting_s:.0f} s of waiting."
    )


def _rules(number: str) -> str:
    ignored = tables()[number]["ignored"]
    return f"; without {', '.join(ignored)}" if ignored else "; all rules"
