"""The paper's scenario: allocation (Figure 5) and time chart (Figure 6)."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass
from functools import cache
from typing import Any

from muster.library import published
from muster.verification import RouteFigures, Visit
from muster_studies.comparison_marks import EQUAL, equal, equal_rule
from muster_studies.effort import Effort
from muster_studies.runs import Case, Sample
from muster_studies.tables import Cell, Table, row

ITERATIONS = 100
"""Of the market; the paper states no number."""

TRAVEL, EXECUTION = "-", "#"
CHARACTER_S = 2


@cache
def paper() -> Mapping[str, Any]:
    """What the paper states."""
    return published("market-rescue")


def printed_allocation() -> Mapping[str, tuple[str, ...]]:
    """By robot the survivors that the paper's Figure 5 gives it."""
    routes = paper()["tables"]["Figure 5"]["plans"][0]["routes"]
    return {robot: tuple(route["tasks"]) for robot, route in routes.items()}


def market_case(effort: Effort, mission: str = "market-rescue") -> Case:
    """The market on a mission of the scenario."""
    iterations = ITERATIONS if effort.iterations is None else effort.iterations
    return Case(mission=mission, allocator="market", objective="max", iterations=iterations)


@dataclass(frozen=True)
class Allocation:
    """Figure 5: which survivors each robot does."""

    number: str = "Figure 5"
    mission: str = "market-rescue"
    columns: tuple[str, ...] = ("robot", "values", "survivors", "runs", "mark")

    def jobs(self, effort: Effort) -> Iterator[Case]:
        yield market_case(effort, self.mission)

    def table(self, effort: Effort, samples: Mapping[Case, Sample]) -> Table:
        sample, rows = samples[market_case(effort, self.mission)], []
        for route in sample.best.verdict.routes:
            there = printed_allocation()[route.robot]
            rows.append(row(self.columns, {"robot": route.robot, "values": "paper", "survivors": there}))
            runs = sum(set(_tasks(outcome.verdict.routes, route.robot)) == set(there) for outcome in sample.outcomes)
            cells: dict[str, Cell] = {
                "robot": route.robot,
                "values": "own",
                "survivors": route.tasks,
                "runs": f"{runs}/{len(sample.outcomes)}",
                "mark": EQUAL if set(route.tasks) == set(there) else "other survivors",
            }
            rows.append(row(self.columns, cells))
        notes = (
            f"Own: market, {sample.best.iterations} iterations, best of {len(sample.outcomes)} seeds. runs: in how "
            "many of them the robot does the same survivors as in the paper.",
        )
        title, _, remark = paper()["tables"][self.number]["title"].partition("; ")
        rule, lines = f"{EQUAL}: the robot does the same survivors as published.", (f"{remark.capitalize()}.", *notes)
        return Table(self.number, title, self.columns, tuple(rows), lines, mark_rule=rule)


def _tasks(routes: tuple[RouteFigures, ...], robot: str) -> tuple[str, ...]:
    return next(route.tasks for route in routes if route.robot == robot)


@dataclass(frozen=True)
class TimeChart:
    """Figure 6: how long each robot travels (A) and executes (B), and how long the mission takes."""

    number: str = "Figure 6"
    columns: tuple[str, ...] = ("robot", "values", "A", "B", "A + B", "chart", "mark")

    def jobs(self, effort: Effort) -> Iterator[Case]:
        yield market_case(effort)

    def table(self, effort: Effort, samples: Mapping[Case, Sample]) -> Table:
        verdict, rows = samples[market_case(effort)].best.verdict, []
        for route in verdict.routes:
            there = execution_s(route.robot)
            rows.append(row(self.columns, {"robot": route.robot, "values": "paper", "B": there}))
            cells: dict[str, Cell] = {
                "A": route.travel,
                "B": route.work,
                "A + B": route.usage,
                "chart": chart(route.visits),
            }
            mark = EQUAL if equal(there, route.work) else f"B {route.work - there:+.2f}"
            rows.append(row(self.columns, {"robot": route.robot, "values": "own", **cells, "mark": mark}))
        mission_s = float(paper()["simulated_mission_s"])
        rows.append(
            row(self.columns, {"robot": "mission", "values": "paper", "A + B": mission_s, "mark": "simulation"})
        )
        rows.append(row(self.columns, {"robot": "mission", "values": "own", "A + B": verdict.makespan_s}))
        notes = (
            "Seconds. What the paper prints of the figure is a picture. B follows from its Figures 3 and 5 whatever "
            "the positions; A does not.",
            "The paper's mission time, 1 min 23 s, is that of its simulation, with obstacles, turns and survivors at "
            "places that it does not print. Own places are chosen, in its arena of 2 m x 2 m, and own travel is "
            "straight and at full speed: the two times do not compare.",
            f"chart: a character is {CHARACTER_S} s; {TRAVEL} travel, {EXECUTION} execution, by the judge's schedule.",
        )
        title, rule = "Time chart of the allocation", equal_rule("B, the time of execution, is")
        return Table(self.number, title, self.columns, tuple(rows), notes, mark_rule=rule)


def execution_s(robot: str) -> float:
    """B of the paper's allocation, from its execution times and aging factor."""
    model = paper()["tables"]["Figure 3"]
    minutes = sum(model["tasks"][task]["time_required_min"] for task in printed_allocation()[robot])
    return float(60 * minutes / model["robots"][robot]["aging_factor"])


def chart(visits: Iterable[Visit]) -> str:
    """A robot's time as a line of characters."""
    drawn = ""
    for visit in visits:
        arrives, starts, ends = (round(s / CHARACTER_S) for s in (visit.arrives_s, visit.starts_s, visit.ends_s))
        drawn = drawn.ljust(arrives, TRAVEL).ljust(starts).ljust(ends, EXECUTION)
    return drawn
