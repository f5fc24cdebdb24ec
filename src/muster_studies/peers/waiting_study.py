"""The study: `search` beside CP-SAT, which has more time, on missions whose tasks wait for each other."""

from __future__ import annotations

from collections.abc import Mapping

from muster_studies.effort import Effort
from muster_studies.peers.contest import WAITING_PEER, Result, Run, perform
from muster_studies.peers.machine import machine_and_versions, require_comparable
from muster_studies.peers.timed_effort import QUICK_S, seeds_of
from muster_studies.peers.waiting_table import Waiting
from muster_studies.repetition import Repetition, one_by_one


def peers_waiting_study() -> Repetition[Run, Result]:
    """`search` beside CP-SAT on missions with prerequisites, one run at a time."""
    return Repetition(
        name="peers-waiting",
        summary="search beside CP-SAT, which has more time: makespan of tasks that wait for each other",
        document="search beside CP-SAT: makespan of tasks that wait for each other",
        reproductions=(Waiting(),),
        perform=one_by_one(perform),
        seeds=seeds_of,
        extras=("studies",),
        check=_check,
        remarks=_legend,
    )


def _check(effort: Effort) -> None:
    require_comparable(effort, [WAITING_PEER])


def _legend(effort: Effort, found: Mapping[Run, Result]) -> tuple[str, ...]:
    seeds = seeds_of(effort)
    quick = f" With --quick every limit is {QUICK_S:g} s." if effort.quick else ""
    return (
        machine_and_versions([WAITING_PEER]),
        "Times are of the processor, with one thread, and each solver runs alone; handing over the model comes on top."
        f"{quick} All plans are judged by muster.verify in double precision.",
        f"search is random: mean and worst of {'seed 0' if seeds == 1 else f'seeds 0 to {seeds - 1}'}. CP-SAT runs "
        "once. search has its default settings.",
        f"CP-SAT: {WAITING_PEER.settings}.",
    )
