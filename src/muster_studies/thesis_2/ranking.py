"""The tables: all allocators ranked, and three of them beside the verdicts of Table 2.2.

Table 2.2 of [tcf-thesis]: how it ranks three metaheuristics, from the literature.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from statistics import fmean
from types import MappingProxyType

from muster_studies.effort import Effort
from muster_studies.runs import Case, Outcome
from muster_studies.tables import CHECK_MARK, Cell, Table
from muster_studies.thesis_2 import samples
from muster_studies.thesis_2.samples import ALLOCATORS, MISSIONS, SALESMEN, Excesses, Samples

GENETIC, SWARM, COLONY = "order-crossover", "particle-swarm", "ant-colony"
"""The allocators that stand for GA, PSO and ACO: those that the section describes."""

RANKS: Mapping[str, tuple[str, str, str]] = MappingProxyType(
    {
        "computational demand": (SWARM, GENETIC, COLONY),
        "global search": (GENETIC, COLONY, SWARM),
        "robustness": (COLONY, GENETIC, SWARM),
    }
)
"""From the best to the worst."""


@dataclass(frozen=True)
class Ranking:
    """All allocators, the lowest mean excess first."""

    number: str = "ranking"

    def jobs(self, effort: Effort) -> Iterable[Case]:
        return samples.cases(effort).values()

    def table(self, effort: Effort, found: Samples) -> Table:
        by_name, own = samples.excesses(effort, found), samples.cases(effort)
        rows: list[tuple[Cell, ...]] = []
        for place, name in enumerate(_ranked(by_name), 1):
            of = by_name[name]
            groups = (of.mean(group) for group in (SALESMEN, samples.TEST_CASES, samples.SEARCH_AND_RESCUE))
            cpu_s = fmean(found[own[name, mission]].cpu_s for mission in MISSIONS)
            rows.append((place, name, *groups, of.mean(), of.half_interval(), of.worst(), 100 * of.fewer, cpu_s))
        columns = ("", "allocator", "salesmen", "test cases", "rescue", "mean", "±", "worst", "fewer tasks", "s")
        notes = (
            "Per cent above the best plan found: means over missions and seeds; ± is half of the 95 % confidence "
            "interval of the mean over seeds; worst, the mean over missions of the worst seed; fewer tasks: per cent "
            "of plans that do less than the best, which are not in the means.",
            f"salesmen: {', '.join(SALESMEN)}; test cases: {', '.join(samples.TEST_CASES)}; "
            f"rescue: {', '.join(samples.SEARCH_AND_RESCUE)}. s: processor time of a run.",
        )
        return Table(self.number, "What plans cost more than the best [%]", columns, tuple(rows), notes)


@dataclass(frozen=True)
class Verdicts:
    """Table 2.2: the published ranks of three metaheuristics, and ours by what is measured."""

    number: str = "2.2"

    def jobs(self, effort: Effort) -> Iterable[Case]:
        return samples.cases(effort).values()

    def table(self, effort: Effort, found: Samples) -> Table:
        figures = _figures(effort, found)
        rows: list[tuple[Cell, ...]] = []
        for criterion, published in RANKS.items():
            figure = figures[criterion]
            own = sorted(published, key=lambda name: figure[name])
            for place, (theirs, ours) in enumerate(zip(published, own, strict=True), 1):
                agrees = f" {CHECK_MARK}" if theirs == ours else ""
                rows.append((criterion, place, theirs, f"{ours}{agrees}", figure[ours]))
        notes = (
            "computational demand: milliseconds of processor time until the plan is as good as that of greedy, on the "
            "salesmen's missions; a run that never gets there counts with all its time.",
            "global search: per cent above the best plan found, the mean over all missions and seeds. "
            "robustness: the same of the worst seed of each mission.",
            "Where a plan does fewer tasks than the best, it counts as twice the cost of the best (100 %).",
        )
        columns = ("criterion", "rank", "published", "own", "figure")
        mark = f"{CHECK_MARK}: the same rank as published"
        return Table(self.number, "Three metaheuristics", columns, tuple(rows), notes, mark_rule=mark)


def _ranked(by_name: Mapping[str, Excesses]) -> list[str]:
    """By mean excess, where plans that do fewer tasks count as twice the cost."""
    return sorted(ALLOCATORS, key=lambda name: fmean(_counted(by_name[name])))


def _counted(of: Excesses) -> list[float]:
    """The mean of each mission."""
    return [fmean(100.0 if one is None else one for one in row) for row in of.by_mission.values()]


def _worst(of: Excesses) -> float:
    return fmean(max(100.0 if one is None else one for one in row) for row in of.by_mission.values())


def _figures(effort: Effort, found: Samples) -> dict[str, dict[str, float]]:
    """By criterion and allocator; lower is better."""
    by_name, own = samples.excesses(effort, found), samples.cases(effort)
    names = RANKS["robustness"]

    def demand(name: str) -> float:
        times = []
        for mission in SALESMEN:
            goal = found[own["greedy", mission]].best.value
            times += [_reached_s(one, goal) for one in found[own[name, mission]].outcomes]
        return 1000.0 * fmean(times)

    return {
        "computational demand": {name: demand(name) for name in names},
        "global search": {name: fmean(_counted(by_name[name])) for name in names},
        "robustness": {name: _worst(by_name[name]) for name in names},
    }


def _reached_s(outcome: Outcome, goal: float) -> float:
    """When a run, all plans of which do all tasks, was as good as the goal; else all its time."""
    return next((time for time, value in outcome.history if value <= goal), outcome.cpu_s)
