"""The paper's scenario: allocation (Figure 5), and time chart (Figure 6) as planned and as carried out."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

from muster.verification import Visit
from muster_studies.comparison_marks import EQUAL, equal, equal_rule
from muster_studies.effort import Effort
from muster_studies.market_rescue.scenario import (
    CHARACTER_S,
    EXECUTION,
    TRAVEL,
    Allocation,
    chart,
    execution_s,
    market_case,
    paper,
)
from muster_studies.rescue.flights import Flight, FlightResult, Planning, repetitions
from muster_studies.rescue.teams import ARENA, verdict_of
from muster_studies.runs import Sample
from muster_studies.tables import Cell, Table, row


def undisturbed(effort: Effort, team: str = ARENA) -> Flight:
    """The plan carried out without noise, and nobody fails."""
    return Flight(team=team, iterations=market_case(effort).iterations or 0)


@dataclass(frozen=True)
class Figure5:
    """Which survivors each robot does: the market's plans, with different seeds."""

    number: str = "Figure 5"

    def jobs(self, effort: Effort) -> Iterator[Planning]:
        for seed in range(repetitions(effort)):
            yield Planning(market_case(effort, ARENA), seed)

    def table(self, effort: Effort, results: Mapping[Any, Any]) -> Table:
        outcomes = tuple(results[job] for job in self.jobs(effort))
        return Allocation(mission=ARENA).table(effort, {market_case(effort, ARENA): Sample(outcomes)})


@dataclass(frozen=True)
class Figure6:
    """How long each robot travels and executes: planned by the judge's schedule, and carried out without noise."""

    number: str = "Figure 6"
    columns: tuple[str, ...] = ("robot", "values", "travel", "execution", "total", "chart", "mark")

    def jobs(self, effort: Effort) -> Iterator[Flight]:
        yield undisturbed(effort)

    def table(self, effort: Effort, results: Mapping[Any, Any]) -> Table:
        flight = undisturbed(effort)
        flown: FlightResult = results[flight]
        verdict, rows = verdict_of(flight.team, flight.iterations), []
        for route in verdict.routes:
            printed = execution_s(route.robot)
            ways = {"planned": route.visits, "carried out": flown.visits[route.robot]}
            rows.append(row(self.columns, {"robot": route.robot, "values": "paper", "execution": printed}))
            rows += [
                row(self.columns, {"robot": route.robot, "values": name, **_cells(visits, printed)})
                for name, visits in ways.items()
            ]
        totals = {
            "paper": float(paper()["simulated_mission_s"]),
            "planned": verdict.makespan_s,
            "carried out": flown.report.mission_time_s,
        }
        rows += [
            row(self.columns, {"robot": "mission", "values": name, "total": total}) for name, total in totals.items()
        ]
        notes = (
            "Seconds. The paper's figure is a picture; its execution times follow from Figures 3 and 5. Its mission "
            "time, 1 min 23 s, is that of its simulation, in an arena whose places it does not print: ours are chosen, "
            "so that the two times do not compare.",
            "Planned: shortest ways around the obstacles at full speed. Carried out: steps of 0.1 s, in which a robot "
            "also turns and speeds up; each work is found ended at the next step, so that it takes longer.",
            f"chart: a character is {CHARACTER_S} s; {TRAVEL} travel, {EXECUTION} execution.",
        )
        title, rule = "Time chart, planned and carried out", equal_rule("the time of execution is")
        return Table(self.number, title, self.columns, tuple(rows), notes, mark_rule=rule)


def _cells(visits: Sequence[Visit], printed_s: float) -> dict[str, Cell]:
    leaves = [0.0, *(visit.ends_s for visit in visits)]
    travel = sum(visit.arrives_s - left for visit, left in zip(visits, leaves, strict=False))
    execution = sum(visit.ends_s - visit.starts_s for visit in visits)
    return {
        "travel": travel,
        "execution": execution,
        "total": leaves[-1],
        "chart": chart(visits),
        "mark": EQUAL if equal(printed_s, execution) else f"execution {execution - printed_s:+.2f}",
    }
