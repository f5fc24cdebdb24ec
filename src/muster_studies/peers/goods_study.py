"""The study: `search` beside others on missions with goods and energy."""

from __future__ import annotations

from collections.abc import Mapping

from muster_studies.effort import Effort
from muster_studies.peers.contest import PEERS, Result, Run, undisturbed
from muster_studies.peers.goods_tables import CHARGING, CUSTOMERS, LOADS, PEERS_WITH_GOODS, TRANSPORTS
from muster_studies.peers.machine import machine_and_versions, require_comparable
from muster_studies.peers.study import shares
from muster_studies.peers.timed_effort import QUICK_S, seeds_of
from muster_studies.repetition import Repetition, one_by_one


def peers_goods_study() -> Repetition[Run, Result]:
    """`search` beside PyVRP, OR-Tools, VROOM and the best values known, one run at a time."""
    return Repetition(
        name="peers-goods",
        summary="search beside PyVRP, OR-Tools and VROOM: loads and windows, transports, charging",
        document="search beside solvers from elsewhere: loads and windows, transports, charging",
        reproductions=(LOADS, CUSTOMERS, TRANSPORTS, CHARGING),
        perform=one_by_one(undisturbed),
        seeds=seeds_of,
        extras=("studies",),
        check=_check,
        remarks=_legend,
    )


def _check(effort: Effort) -> None:
    require_comparable(effort, (PEERS[name] for name in PEERS_WITH_GOODS))


def _legend(effort: Effort, found: Mapping[Run, Result]) -> tuple[str, ...]:
    peers = [PEERS[name] for name in PEERS_WITH_GOODS]
    seeds = seeds_of(effort)
    quick = f" With --quick every limit is {QUICK_S:g} s." if effort.quick else ""
    return (
        machine_and_versions(peers),
        "Every solver has the same processor time for each plan (VROOM: wall time, of which it often uses little) and "
        f"one thread, and runs alone; handing over the model comes on top.{quick} All plans are judged by "
        "muster.verify in double precision. Whole numbers that solvers want are rounded at 1e-7 of the longest way or "
        "work so that their plans hold in truth.",
        f"search and PyVRP are random: mean and worst of {'seed 0' if seeds == 1 else f'seeds 0 to {seeds - 1}'}. The "
        "others are not, and run once. search has its default settings. mean: over the missions on which all plans of "
        "all solvers do all tasks.",
        "That all tasks can be done is told to PyVRP as required clients and shipments, without which it leaves more "
        "out; OR-Tools and VROOM may leave tasks out at a price above any way. Loads are pickups to PyVRP and VROOM, a "
        "dimension to OR-Tools; transports are shipments to both, pickups and deliveries to OR-Tools.",
        *(f"{peer.name}: {peer.settings}." for peer in peers),
        shares(found.values()),
    )
