"""Missions whose tasks wait for each other: how far the end is from that of CP-SAT, which has more time."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

from muster.generation.precedence import SHAPES
from muster_studies.effort import Effort
from muster_studies.peers.contest import OWN, Match, Result, Run, Standings, runs_of, standings_of
from muster_studies.peers.cp_sat_schedule import CpSatSchedule
from muster_studies.peers.gaps import above, gap_cells, mean_cells
from muster_studies.peers.timed_effort import limit_of, seeds_of
from muster_studies.tables import Cell, Notes, Table

PEER = CpSatSchedule.name
_GREEDY = "greedy"


@dataclass(frozen=True)
class Waiting:
    """Missions of all shapes and some sizes (tasks, robots).

    Parameters
    ----------
    limits_s
        of the search.
    peer_limit_s
        of CP-SAT.
    """

    number: str = "waiting"
    sizes: tuple[tuple[int, int], ...] = ((20, 3), (50, 5), (100, 8), (200, 12), (400, 20))
    limits_s: tuple[float, ...] = (2.0, 5.0)
    peer_limit_s: float = 60.0

    def jobs(self, effort: Effort) -> list[Run]:
        return [run for size in self._sizes(effort) for match in _matches(size) for run in self._runs(match, effort)]

    def table(self, effort: Effort, found: Mapping[Run, Result]) -> Table:
        results, notes = [found[run] for run in self.jobs(effort)], Notes()
        by_limit = {
            seconds: standings_of(result for result in results if result.run.seconds == seconds)
            for seconds in {result.run.seconds for result in results}
        }
        rows: list[tuple[Cell, ...]] = []
        for size in self._sizes(effort):
            gaps = [self._row(match, by_limit, effort, notes) for match in _matches(size)]
            rows += gaps
            rows.append((f"mean, {size[0]} tasks", None, *mean_cells([row[2:] for row in gaps])))
        columns = (
            *("mission", f"CP-SAT {self.peer_limit_s:g} s, end [s]", "greedy"),
            *(name for s in self.limits_s for name in (f"search {s:g} s", f"search {s:g} s, worst")),
        )
        title = "Prerequisites: per cent of the makespan above that of CP-SAT, which has more time"
        remark = (
            "waiting-SHAPE-TASKS-ROBOTS-SEED: tasks of 10 to 60 s on 100 m x 100 m that need one of three skills; "
            "robots of 1 or 1.5 m/s with two of them. tree: a task waits for two or three others as a rule; layers: "
            "for one to three of the layer before; chains: halves in series or in parallel, whose halves are so in "
            "turn, and the way back counts; pieces: five tasks one after the other at one place, and robots of one "
            "skill."
        )
        return Table(self.number, title, columns, tuple(rows), (remark, *notes.lines()))

    def _sizes(self, effort: Effort) -> tuple[tuple[int, int], ...]:
        return self.sizes[:1] if effort.quick else self.sizes

    def _runs(self, match: Match, effort: Effort) -> list[Run]:
        peer_s, seeds = limit_of(effort, self.peer_limit_s), seeds_of(effort)
        own = [run for s in self.limits_s for run in runs_of([match], [OWN], limit_of(effort, s), seeds)]
        return [*runs_of([match], [PEER, _GREEDY], peer_s, seeds), *own]

    def _row(self, match: Match, by_limit: Mapping[float, Standings], effort: Effort, notes: Notes) -> tuple[Cell, ...]:
        with_peer = by_limit[limit_of(effort, self.peer_limit_s)]
        peer = with_peer[match, PEER]
        if peer.fault is not None:
            return match.mission, notes.number(peer.fault), *[None] * (1 + 2 * len(self.limits_s))
        own = [by_limit[limit_of(effort, s)][match, OWN] for s in self.limits_s]
        return match.mission, peer.mean, *gap_cells([with_peer[match, _GREEDY], *own], peer.mean, above, notes)


def _matches(size: tuple[int, int]) -> list[Match]:
    tasks, robots = size
    return [Match(mission=f"waiting-{shape}-{tasks}-{robots}-0", objective="makespan") for shape in SHAPES]
