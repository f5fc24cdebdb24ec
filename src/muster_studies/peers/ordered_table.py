"""Missions whose tasks have time windows and wait for each other: tasks done, then the makespan."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from statistics import fmean

from muster_studies.effort import Effort
from muster_studies.peers.contest import OWN, OWN_OTHERS, Match, Result, Run, Standing, Standings, runs_of, standings_of
from muster_studies.peers.timed_effort import limit_of, seeds_of
from muster_studies.tables import Cell, Notes, Table

_SOLVERS = (OWN, *OWN_OTHERS, "CP-SAT", "OR-Tools")
_CLOSE = 1e-4
"""Makespans that differ by less, relative, are equal."""


@dataclass(frozen=True)
class Ordered:
    """Random missions with windows and prerequisites, at equal processor time."""

    number: str = "ordered"
    missions: int = 20
    limit_s: float = 2.0

    def _matches(self, effort: Effort) -> list[Match]:
        count = 2 if effort.quick else self.missions
        return [Match(mission=f"windows-{seed}", objective="makespan") for seed in range(count)]

    def jobs(self, effort: Effort) -> list[Run]:
        return runs_of(self._matches(effort), _SOLVERS, limit_of(effort, self.limit_s), seeds_of(effort))

    def table(self, effort: Effort, found: Mapping[Run, Result]) -> Table:
        standings, notes = standings_of(found[run] for run in self.jobs(effort)), Notes()
        matches = self._matches(effort)
        rows = [_row(match, standings, notes) for match in matches]
        return Table(
            self.number,
            "Windows and prerequisites: tasks done and makespan of each solver, means over seeds",
            ("mission", "tasks", *(column for s in _SOLVERS for column in (s, f"{s}, makespan [s]"))),
            (*rows, _last_row(matches, standings)),
            (
                "The last row: all tasks done; under the makespans on how many missions search is better, equal, worse "
                "(more tasks done, or as many and an earlier end).",
                *notes.lines(),
            ),
        )


def _row(match: Match, standings: Standings, notes: Notes) -> tuple[Cell, ...]:
    cells: list[Cell] = [match.mission, standings[match, OWN].results[0].tasks_total]
    for solver in _SOLVERS:
        standing = standings[match, solver]
        fault = standing.fault
        cells += [_done(standing), standing.mean] if fault is None else [notes.number(fault), None]
    return tuple(cells)


def _done(standing: Standing) -> float:
    """The mean number of tasks done; none of a plan that does not count."""
    return fmean(0 if result.fault else result.tasks for result in standing.results)


def _last_row(matches: list[Match], standings: Standings) -> tuple[Cell, ...]:
    cells: list[Cell] = ["all", sum(standings[match, OWN].results[0].tasks_total for match in matches)]
    for solver in _SOLVERS:
        cells.append(sum(_done(standings[match, solver]) for match in matches))
        against = [_compared(standings[match, OWN], standings[match, solver]) for match in matches]
        cells.append(None if solver == OWN else " / ".join(str(against.count(sign)) for sign in (1, 0, -1)))
    return tuple(cells)


def _compared(own: Standing, other: Standing) -> int:
    """1 where the first is better, 0 where they are equal, -1 where it is worse."""
    if _done(own) != _done(other):
        return 1 if _done(own) > _done(other) else -1
    if abs(own.mean - other.mean) <= _CLOSE * max(own.mean, other.mean):
        return 0
    return 1 if own.mean < other.mean else -1
