"""The study: `search` beside others on missions with time windows, prerequisites and teams."""

from __future__ import annotations

from collections.abc import Mapping

from muster_studies.effort import Effort
from muster_studies.peers.contest import PEERS, Result, Run, undisturbed
from muster_studies.peers.machine import machine_and_versions, require_comparable
from muster_studies.peers.ordered_table import ORDERED
from muster_studies.peers.study import shares
from muster_studies.peers.teams_table import Teams
from muster_studies.peers.timed_effort import QUICK_S, seeds_of
from muster_studies.peers.windows_table import Windows
from muster_studies.repetition import Repetition, one_by_one


def peers_timed_study() -> Repetition[Run, Result]:
    """`search` beside OR-Tools, PyVRP, VROOM and published figures, one run at a time."""
    return Repetition(
        name="peers-timed",
        summary="search beside OR-Tools, PyVRP and VROOM: time windows, prerequisites, teams",
        document="search beside solvers from elsewhere: time windows, prerequisites, teams",
        reproductions=(Windows(), ORDERED, Teams()),
        perform=one_by_one(undisturbed),
        seeds=seeds_of,
        extras=("studies",),
        check=_check,
        remarks=_legend,
    )


def _check(effort: Effort) -> None:
    require_comparable(effort, PEERS.values())


def _legend(effort: Effort, found: Mapping[Run, Result]) -> tuple[str, ...]:
    seeds = seeds_of(effort)
    quick = f" With --quick every limit is {QUICK_S:g} s." if effort.quick else ""
    return (
        machine_and_versions(PEERS.values()),
        "Every solver has the same processor time for each plan (VROOM: wall time) and one thread, and runs alone; "
        f"handing over the model comes on top.{quick} All plans are judged by muster.verify in double precision. Whole "
        "numbers that solvers want are rounded at 1e-7 of the longest way or work: travel and work up, openings of "
        "windows up, ends down, so that their plans hold in truth.",
        "search and PyVRP are random: mean and worst of "
        f"{'seed 0' if seeds == 1 else f'seeds 0 to {seeds - 1}'}. The others are not, and run once.",
        "windows: instances of Solomon; service times are the work, demands are left out, robots as many as vehicles "
        "of the reference. That all tasks can be done is told to PyVRP as required clients, without which it does "
        "fewer tasks more often; OR-Tools and VROOM may leave tasks out at a price above any way.",
        "ordered: 3 to 10 robots, 9 to 60 tasks on 100 m x 100 m, work of 20 to 40 s, one window each that opens in 0 "
        "to 400 s and is 30 to 1,600 s long, a tenth of the pairs ordered; windows-SEED. PyVRP and VROOM have no "
        "prerequisites.",
        "teams: the instances of two published generators, by their seeds. A robot has its skills for its team's sum; "
        "all robots return, and the makespan includes it.",
        *(f"{peer.name}: {peer.settings}." for peer in PEERS.values()),
        shares(found.values()),
    )
