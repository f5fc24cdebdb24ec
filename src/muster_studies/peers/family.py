"""Missions of one kind beside a reference: how far each solver is behind, after some limits of processor time."""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from functools import cache
from importlib.resources import files
from types import MappingProxyType

import msgspec

from muster_studies.effort import Effort
from muster_studies.peers.contest import Match, Result, Run, Standings, runs_of, standings_of
from muster_studies.peers.gaps import Gap, above, below, gap_cells, gap_columns, mean_cells
from muster_studies.peers.timed_effort import QUICK_S, seeds_of
from muster_studies.tables import Cell, Notes, Table


@dataclass(frozen=True, kw_only=True)
class Family:
    """Missions of one kind, after some limits of processor time.

    Parameters
    ----------
    known
        by mission the best value known; empty: the least value of all plans of the table is the reference.
    quick
        the mission that stands for all with --quick.
    only
        the missions that have a limit, where not all have it.
    complete
        whether plans that do all tasks are known to exist.
    gap
        how far a plan is behind the reference.
    remark
        what the missions and the reference are.
    column, prefix
        the heading of the missions' names, and the beginning of these that the table leaves out.
    """

    number: str
    title: str
    objective: str
    missions: tuple[str, ...]
    quick: str
    solvers: tuple[str, ...]
    remark: str
    known: Mapping[str, float]
    gap: Gap
    limits_s: tuple[float, ...]
    only: Mapping[float, tuple[str, ...]]
    complete: bool
    column: str
    prefix: str

    def jobs(self, effort: Effort) -> list[Run]:
        matches = {s: [self._match(name) for name in self._missions(effort, s)] for s in self._limits(effort)}
        return [run for s, some in matches.items() for run in runs_of(some, self.solvers, s, seeds_of(effort))]

    def table(self, effort: Effort, found: Mapping[Run, Result]) -> Table:
        results = [found[run] for run in self.jobs(effort)]
        references = {name: self._reference(name, results) for name in self._all(effort)}
        notes, rows = Notes(), []
        for seconds in self._limits(effort):
            standings = standings_of(result for result in results if result.run.seconds == seconds)
            missions = self._missions(effort, seconds)
            gaps = {name: self._gaps(name, references[name], standings, notes) for name in missions}
            rows += [
                (name.removeprefix(self.prefix), seconds, references[name], *cells) for name, cells in gaps.items()
            ]
            rows.append(("mean", seconds, None, *mean_cells(list(gaps.values()))))
        columns = (self.column, "limit [s]", "reference", *gap_columns(self.solvers))
        return Table(self.number, self.title, columns, tuple(rows), (self.remark, *notes.lines()))

    def _match(self, mission: str) -> Match:
        return Match(mission=mission, objective=self.objective, complete=self.complete)

    def _all(self, effort: Effort) -> Sequence[str]:
        return (self.quick,) if effort.quick else self.missions

    def _missions(self, effort: Effort, seconds: float) -> Sequence[str]:
        """Those that have a limit."""
        return self._all(effort) if effort.quick else self.only.get(seconds, self.missions)

    def _limits(self, effort: Effort) -> tuple[float, ...]:
        return (QUICK_S,) if effort.quick else self.limits_s

    def _reference(self, mission: str, results: Iterable[Result]) -> float:
        """The best value known, or the least of all plans that do all tasks; infinite where there is none."""
        values = [
            result.value
            for result in results
            if result.run.match.mission == mission and result.fault is None and result.tasks == result.tasks_total
        ]
        return self.known.get(mission, min(values, default=math.inf))

    def _gaps(self, mission: str, reference: float, standings: Standings, notes: Notes) -> list[Cell]:
        match = self._match(mission)
        return gap_cells([standings[match, solver] for solver in self.solvers], reference, self.gap, notes)


_GAPS: Mapping[str, Gap] = {"above": above, "below": below}


def family_of(number: str, known: Mapping[str, float] = MappingProxyType({})) -> Family:
    """Return the table of that number, as `families.yaml` describes it, beside the best values known.

    Parameters
    ----------
    number : str
        Number of the table.
    known : Mapping[str, float]
        By mission the best value known; where the file names no missions, these are all.
    """
    described = _described()[number]
    fields = msgspec.structs.asdict(described)
    fields |= {"missions": described.missions or tuple(known), "gap": _GAPS[described.gap]}
    return Family(number=number, known=known, **fields)


class _Described(msgspec.Struct, forbid_unknown_fields=True):
    title: str
    objective: str
    quick: str
    solvers: tuple[str, ...]
    remark: str
    missions: tuple[str, ...] = ()
    gap: str = "above"
    limits_s: tuple[float, ...] = (2.0, 10.0)
    only: dict[float, tuple[str, ...]] = {}
    complete: bool = False
    column: str = "mission"
    prefix: str = ""


@cache
def _described() -> dict[str, _Described]:
    content = (files("muster_studies.peers") / "families.yaml").read_bytes()
    return msgspec.yaml.decode(content, type=dict[str, _Described])
