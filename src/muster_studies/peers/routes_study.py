"""The study: `search` beside others on routes: orienteering, longest routes, many depots, long tours."""

from __future__ import annotations

from collections.abc import Mapping

from muster_studies.effort import Effort
from muster_studies.peers.contest import PEERS, Result, Run, undisturbed
from muster_studies.peers.machine import machine_and_versions, require_comparable
from muster_studies.peers.routes_tables import FAMILIES
from muster_studies.peers.timed_effort import QUICK_S, seeds_of
from muster_studies.repetition import Repetition, one_by_one

_PEERS = ("PyVRP", "OR-Tools")


def peers_routes_study() -> Repetition[Run, Result]:
    """`search` beside PyVRP, OR-Tools and the best values known, one run at a time."""
    return Repetition(
        name="peers-routes",
        summary="search beside PyVRP and OR-Tools: orienteering, longest routes, many depots, long tours",
        document="search beside solvers from elsewhere: orienteering, longest routes, many depots, long tours",
        reproductions=FAMILIES,
        perform=one_by_one(undisturbed),
        seeds=seeds_of,
        extras=("studies",),
        check=_check,
        remarks=_legend,
    )


def _check(effort: Effort) -> None:
    require_comparable(effort, (PEERS[name] for name in _PEERS))


def _legend(effort: Effort, found: Mapping[Run, Result]) -> tuple[str, ...]:
    peers = [PEERS[name] for name in _PEERS]
    seeds = seeds_of(effort)
    quick = f" With --quick every limit is {QUICK_S:g} s." if effort.quick else ""
    return (
        machine_and_versions(peers),
        "Every solver has the same processor time for each plan and one thread, and runs alone; handing over the model "
        f"comes on top.{quick} All plans are judged by muster.verify in double precision; whole numbers that solvers "
        "want are rounded up at 1e-7 of the longest way.",
        f"search and PyVRP are random: mean and worst of {'seed 0' if seeds == 1 else f'seeds 0 to {seeds - 1}'}. "
        "OR-Tools is not, and runs once. search has its default settings. mean: over the missions on which all solvers "
        "have plans that count.",
        *(f"{peer.name}: {peer.settings}." for peer in peers),
    )
