"""Routes without windows: team orienteering [chao1996], longest routes [he2023], many depots, one long tour."""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping
from dataclasses import dataclass

from muster_studies.effort import Effort
from muster_studies.instances.orienteering import BEST_SCORES
from muster_studies.instances.routing import LONGEST_ROUTES
from muster_studies.peers.contest import OWN, OWN_OTHERS, Match, Result, Run, Standings, runs_of, standings_of
from muster_studies.peers.gaps import Gap, above, below, gap_cells, gap_columns, mean_cells
from muster_studies.peers.timed_effort import QUICK_S, seeds_of
from muster_studies.tables import Cell, Notes, Table

_TOTAL, _MAX = "total", "max"


@dataclass(frozen=True, kw_only=True)
class Family:
    """Missions of one kind, after some limits of processor time.

    Parameters
    ----------
    known
        by mission the best value known; empty: the least value of all plans of the table is the reference.
    quick
        the mission that stands for all with --quick.
    gap
        how far a plan is behind the reference.
    remark
        what the missions and the reference are.
    """

    number: str
    title: str
    objective: str
    missions: tuple[str, ...]
    quick: str
    solvers: tuple[str, ...]
    remark: str
    known: Mapping[str, float]
    gap: Gap = above
    limits_s: tuple[float, ...] = (2.0, 10.0)

    def jobs(self, effort: Effort) -> list[Run]:
        matches = [self._match(name) for name in self._missions(effort)]
        return [run for s in self._limits(effort) for run in runs_of(matches, self.solvers, s, seeds_of(effort))]

    def table(self, effort: Effort, found: Mapping[Run, Result]) -> Table:
        results = [found[run] for run in self.jobs(effort)]
        references = {name: self._reference(name, results) for name in self._missions(effort)}
        notes, rows = Notes(), []
        for seconds in self._limits(effort):
            standings = standings_of(result for result in results if result.run.seconds == seconds)
            gaps = {name: self._gaps(name, best, standings, notes) for name, best in references.items()}
            rows += [(name, seconds, references[name], *cells) for name, cells in gaps.items()]
            rows.append(("mean", seconds, None, *mean_cells(list(gaps.values()))))
        columns = ("mission", "limit [s]", "reference", *gap_columns(self.solvers))
        return Table(self.number, self.title, columns, tuple(rows), (self.remark, *notes.lines()))

    def _match(self, mission: str) -> Match:
        return Match(mission=mission, objective=self.objective)

    def _missions(self, effort: Effort) -> tuple[str, ...]:
        return (self.quick,) if effort.quick else self.missions

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


_SCORES = {f"orienteering-{name}": float(score) for name, score in BEST_SCORES.items()}
_LONGEST = {"eil51-3": 159.5715, **{f"routes-{name}-{robots}": most for (name, robots), most in LONGEST_ROUTES.items()}}
_DEPOTS = (
    "routes-cc64-8",
    *(f"clustered-8-120-{seed}" for seed in range(3)),
    *(f"clustered-5-150-{seed}" for seed in range(3)),
)
_TOURS = ("tour-500-0", "routes-rat783-1", "tour-1000-0")
_TOTAL_SOLVERS = (OWN, "PyVRP", "OR-Tools")
_LEAST = "reference: the least total of all plans here; the best is not known."

FAMILIES = (
    Family(
        number="orienteering",
        title="Team orienteering, more tasks than the team can do: per cent of the score below the best known",
        objective=_TOTAL,
        missions=tuple(_SCORES),
        quick="orienteering-p2.3.g",
        solvers=(OWN, *OWN_OTHERS, "PyVRP", "OR-Tools"),
        remark="orienteering-pSET.ROBOTS.LETTER: instances of Chao, Golden and Wasil; a score is a priority, a limit "
        "on a path a work capacity. reference: the greatest score known. Tasks that may be left out are optional "
        "clients with prizes to PyVRP, disjunctions with penalties to OR-Tools.",
        known=_SCORES,
        gap=below,
    ),
    Family(
        number="longest",
        title="Several robots return, objective max: per cent of the longest route above the best known",
        objective=_MAX,
        missions=tuple(_LONGEST),
        quick="eil51-3",
        solvers=(OWN, "OR-Tools"),
        remark="NAME-ROBOTS, from one depot (eil51, mtsp, rand, kroa, rat: of TSPLIB or random) or from as many as "
        "robots (md). reference: the least longest route known, of He and Hao. OR-Tools has a global span; PyVRP has "
        "nothing of the kind.",
        known=_LONGEST,
    ),
    Family(
        number="depots",
        title="Clusters of tasks, a depot for each robot, objective total: per cent above the least",
        objective=_TOTAL,
        missions=_DEPOTS,
        quick="clustered-2-12-0",
        solvers=_TOTAL_SOLVERS,
        remark="clustered-ROBOTS-TASKS-SEED: depots all over a square of 1000 m, tasks in seven clusters; cc64 has 8 "
        f"depots and 120 tasks. {_LEAST}",
        known={},
    ),
    Family(
        number="tour",
        title="One robot, one long tour, objective total: per cent above the least",
        objective=_TOTAL,
        missions=_TOURS,
        quick="tour-30-0",
        solvers=_TOTAL_SOLVERS,
        remark=f"tour-PLACES-SEED: places all over a square of 1000 m; rat783: of TSPLIB. {_LEAST}",
        known={},
    ),
)
"""The tables of the comparison."""
