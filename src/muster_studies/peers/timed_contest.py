"""What comparisons share whose runs have limits of their own: effort, conditions, and the lines above their tables."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence

from muster_studies.effort import Effort
from muster_studies.peers.contest import PEERS, Result, Run, undisturbed
from muster_studies.peers.machine import machine_and_versions, require_comparable
from muster_studies.peers.peer import Peer
from muster_studies.peers.study import shares
from muster_studies.peers.timed_effort import QUICK_S, seeds_of
from muster_studies.repetition import Repetition, Reproduction, one_by_one

_CONDITIONS = "Every solver has the same processor time for each plan (VROOM: wall time, of which it often uses little)"
_ROUNDED = (
    " Whole numbers that solvers want are rounded at 1e-7 of the longest way or work so that their plans hold in truth."
)


def timed_contest(
    *,
    name: str,
    summary: str,
    document: str,
    reproductions: tuple[Reproduction[Run, Result], ...],
    peers: Sequence[Peer] = tuple(PEERS.values()),
    perform: Callable[[Run], Result] = undisturbed,
    conditions: str = _CONDITIONS,
    rounded: str = _ROUNDED,
    random: str,
    legend: tuple[str, ...] = (),
) -> Repetition[Run, Result]:
    """A study of `search` beside other solvers, one run at a time.

    Parameters
    ----------
    conditions, rounded
        how much time each solver has; how whole numbers are made for solvers.
    random
        which solvers are random, and what of the means.
    legend
        lines about the instances, between the conditions and the settings.
    """

    def remarks(effort: Effort, found: Mapping[Run, Result]) -> tuple[str, ...]:
        seeds = seeds_of(effort)
        quick = f" With --quick every limit is {QUICK_S:g} s." if effort.quick else ""
        return (
            machine_and_versions(peers),
            f"{conditions} and one thread, and runs alone; handing over the model comes on top.{quick} All plans are "
            f"judged by muster.verify in double precision.{rounded}",
            f"mean and worst are of {'seed 0' if seeds == 1 else f'seeds 0 to {seeds - 1}'}. {random}",
            *legend,
            *(f"{peer.name}: {peer.settings}." for peer in peers),
            *([shares(found.values())] if any(peer.by_wall_clock for peer in peers) else []),
        )

    return Repetition(
        name=name,
        summary=summary,
        document=document,
        reproductions=reproductions,
        perform=one_by_one(perform),
        seeds=seeds_of,
        extras=("studies",),
        check=lambda effort: require_comparable(effort, peers),
        remarks=remarks,
    )
