"""Missions whose tasks need teams: the search beside the best plans known and published means [dai2024] [dai2025]."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from statistics import fmean

from muster_studies.effort import Effort
from muster_studies.instances.coalitions import SKILL_SETS
from muster_studies.peers.contest import OWN, Match, Result, Run
from muster_studies.peers.timed_effort import limit_of, seeds_of
from muster_studies.tables import Cell, Table


@dataclass(frozen=True, kw_only=True)
class TeamSet:
    """A set of instances, `family-0`, `family-1` ...

    Parameters
    ----------
    best_known
        the least makespan known of each, in seconds; empty: not known.
    seeds
        of the search, at most.
    published
        figures of others, in words.
    """

    name: str
    family: str
    instances: int
    limit_s: float
    seeds: int
    best_known: tuple[float, ...] = ()
    published: str

    def runs(self, effort: Effort) -> list[Run]:
        seconds = limit_of(effort, self.limit_s)
        return [
            Run(match=Match(mission=f"{self.family}-{k}", objective="makespan"), solver=OWN, seconds=seconds, seed=seed)
            for k in range(1 if effort.quick else self.instances)
            for seed in range(min(self.seeds, seeds_of(effort)))
        ]

    def gap(self, result: Result) -> float:
        """Per cent above the least makespan known."""
        known = self.best_known[int(result.run.match.mission.rpartition("-")[2])]
        return 100 * (result.value / known - 1)


_GAPS = "mean gaps of one-core search 4.7 to 6.6 % in 2 s, CP-SAT on 8 cores 7 to 13 %, learned policies 28 to 43 %"
SETS = (
    *(
        TeamSet(
            name=skill_set.name,
            family=f"skills-{key}",
            instances=len(skill_set.best_known),
            limit_s=2.0,
            seeds=3,
            best_known=skill_set.best_known,
            published=_GAPS,
        )
        for key, skill_set in SKILL_SETS.items()
    ),
    TeamSet(
        name="DCMRTA-20-50",
        family="counted",
        instances=50,
        limit_s=5.0,
        seeds=1,
        published="means of the same 50 of CTAS-D 36.9 s in 300 s, OR-Tools 42.0 s, learned policy 34.8 s",
    ),
)


@dataclass(frozen=True)
class Teams:
    """Teams of robots with skills, and teams of a number of robots."""

    number: str = "teams"

    def jobs(self, effort: Effort) -> list[Run]:
        return [run for team_set in SETS for run in team_set.runs(effort)]

    def table(self, effort: Effort, found: Mapping[Run, Result]) -> Table:
        columns = (
            *("set", "instances", "runs", "limit [s]", "processor time, most [s]"),
            *("makespan, mean [s]", "gap, mean [%]", "gap, worst [%]"),
        )
        rows = tuple(_row(team_set, [found[run] for run in team_set.runs(effort)]) for team_set in SETS)
        title = "Tasks for teams: makespans of search, the way back included, and per cent above the best known"
        notes = tuple(f"{team_set.name}, published: {team_set.published}." for team_set in SETS)
        return Table(self.number, title, columns, rows, notes)


def _row(team_set: TeamSet, results: list[Result]) -> tuple[Cell, ...]:
    fault = next((result.fault for result in results if result.fault), None)
    if fault is None and any(result.tasks < result.tasks_total for result in results):
        fault = "tasks left out"
    instances = len({result.run.match for result in results})
    counts = team_set.name, instances, len(results), results[0].run.seconds, max(result.cpu_s for result in results)
    if fault is not None:
        return *counts, fault, None, None
    gaps = [team_set.gap(result) for result in results] if team_set.best_known else []
    figures = (fmean(gaps), max(gaps)) if gaps else (None, None)
    return *counts, fmean(result.value for result in results), *figures
