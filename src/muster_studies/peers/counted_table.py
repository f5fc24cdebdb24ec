"""Missions of which some tasks may be left out: tasks done, then the objective, of each solver."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from statistics import fmean

from muster_studies.effort import Effort
from muster_studies.peers.contest import OWN, Match, Result, Run, Standing, Standings, runs_of, standings_of
from muster_studies.peers.timed_effort import limit_of, seeds_of
from muster_studies.tables import Cell, Notes, Table

_QUICK = 2
_CLOSE = 1e-4
"""Objectives that differ by less, relative, are equal."""


@dataclass(frozen=True, kw_only=True)
class Counted:
    """Missions at equal processor time.

    Parameters
    ----------
    matches
        with --quick the first two.
    measure
        the objective as columns call it, with its unit.
    fewer
        what a better plan with as many tasks has, for the legend.
    remarks
        what else the legend says.
    """

    number: str
    title: str
    matches: tuple[Match, ...]
    solvers: tuple[str, ...]
    limit_s: float
    measure: str
    fewer: str
    remarks: tuple[str, ...] = ()

    def _matches(self, effort: Effort) -> tuple[Match, ...]:
        return self.matches[:_QUICK] if effort.quick else self.matches

    def jobs(self, effort: Effort) -> list[Run]:
        return runs_of(self._matches(effort), self.solvers, limit_of(effort, self.limit_s), seeds_of(effort))

    def table(self, effort: Effort, found: Mapping[Run, Result]) -> Table:
        standings, notes = standings_of(found[run] for run in self.jobs(effort)), Notes()
        matches = self._matches(effort)
        rows = [self._row(match, standings, notes) for match in matches]
        name = self.measure.split()[0]
        return Table(
            self.number,
            self.title,
            ("mission", "tasks", *(column for s in self.solvers for column in (s, f"{s}, {self.measure}"))),
            (*rows, self._last_row(matches, standings)),
            (
                *self.remarks,
                f"The last row: all tasks done; under the {name}s on how many missions search is better, equal, worse "
                f"(more tasks done, or as many and {self.fewer}).",
                *notes.lines(),
            ),
        )

    def _row(self, match: Match, standings: Standings, notes: Notes) -> tuple[Cell, ...]:
        cells: list[Cell] = [match.mission, standings[match, OWN].results[0].tasks_total]
        for solver in self.solvers:
            standing = standings[match, solver]
            fault = standing.fault
            cells += [_done(standing), standing.mean] if fault is None else [notes.number(fault), None]
        return tuple(cells)

    def _last_row(self, matches: Sequence[Match], standings: Standings) -> tuple[Cell, ...]:
        cells: list[Cell] = ["all", sum(standings[match, OWN].results[0].tasks_total for match in matches)]
        for solver in self.solvers:
            cells.append(sum(_done(standings[match, solver]) for match in matches))
            against = [_compared(standings[match, OWN], standings[match, solver]) for match in matches]
            cells.append(None if solver == OWN else " / ".join(str(against.count(sign)) for sign in (1, 0, -1)))
        return tuple(cells)


def _done(standing: Standing) -> float:
    """The mean number of tasks done; none of a plan that does not count."""
    return fmean(0 if result.fault else result.tasks for result in standing.results)


def _compared(own: Standing, other: Standing) -> int:
    """1 where the first is better, 0 where they are equal, -1 where it is worse."""
    if _done(own) != _done(other):
        return 1 if _done(own) > _done(other) else -1
    if abs(own.mean - other.mean) <= _CLOSE * max(own.mean, other.mean):
        return 0
    return 1 if own.mean < other.mean else -1
