"""Missions with time windows: how far each solver is above the best plans known [solomon1987]."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

from muster_studies.effort import Effort
from muster_studies.instances.solomon import REFERENCES
from muster_studies.peers.contest import OWN, Match, Result, Run, runs_of, standings_of
from muster_studies.peers.gaps import above, gap_cells, gap_columns, mean_cells
from muster_studies.peers.timed_effort import QUICK_S, seeds_of
from muster_studies.tables import Cell, Notes, Table

_SOLVERS = (OWN, "PyVRP", "OR-Tools", "VROOM")


@dataclass(frozen=True)
class Windows:
    """Solomon's instances without loads, after some limits of processor time."""

    number: str = "windows"
    limits_s: tuple[float, ...] = (2.0, 10.0)

    def jobs(self, effort: Effort) -> list[Run]:
        matches = list(_distances(effort))
        return [run for s in self._limits(effort) for run in runs_of(matches, _SOLVERS, s, seeds_of(effort))]

    def table(self, effort: Effort, found: Mapping[Run, Result]) -> Table:
        notes, rows = Notes(), []
        for seconds in self._limits(effort):
            standings = standings_of(found[run] for run in self.jobs(effort) if run.seconds == seconds)
            own = [
                (
                    _name(match),
                    seconds,
                    distance,
                    *gap_cells([standings[match, s] for s in _SOLVERS], distance, above, notes),
                )
                for match, distance in _distances(effort).items()
            ]
            rows += [*own, _mean_row(seconds, own)]
        return Table(
            self.number,
            "Solomon's instances without loads, total distance: per cent above the reference",
            ("instance-robots", "limit [s]", "reference", *gap_columns(_SOLVERS)),
            tuple(rows),
            (
                "reference: the distance of the best plan known with loads and so many robots; without loads there are "
                "shorter ones. mean: over the instances of which all plans of all solvers do all tasks.",
                *notes.lines(),
            ),
        )

    def _limits(self, effort: Effort) -> tuple[float, ...]:
        return (QUICK_S,) if effort.quick else self.limits_s


def _distances(effort: Effort) -> dict[Match, float]:
    """Each match, and the distance of its reference."""
    known = list(REFERENCES.items())[: 1 if effort.quick else None]
    return {
        Match(mission=f"solomon-{name}-{robots}", objective="total", complete=True): distance
        for (name, robots), distance in known
    }


def _name(match: Match) -> str:
    return match.mission.partition("-")[2]


def _mean_row(seconds: float, rows: Sequence[tuple[Cell, ...]]) -> tuple[Cell, ...]:
    """The mean of each column, over the rows in which each has a value."""
    return "mean", seconds, None, *mean_cells([row[3:] for row in rows])
