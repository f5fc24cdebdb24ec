"""The study: `search` beside others on missions with goods and energy."""

from __future__ import annotations

from muster_studies.descriptions import description
from muster_studies.peers.contest import PEERS, Result, Run
from muster_studies.peers.goods_tables import CHARGING, CUSTOMERS, LOADS, PEERS_WITH_GOODS, TRANSPORTS
from muster_studies.peers.timed_contest import timed_contest
from muster_studies.repetition import Repetition


def peers_goods_study() -> Repetition[Run, Result]:
    """`search` beside PyVRP, OR-Tools, VROOM and the best values known, one run at a time."""
    return timed_contest(
        **description("peers-goods"),
        reproductions=(LOADS, CUSTOMERS, TRANSPORTS, CHARGING),
        peers=tuple(PEERS[name] for name in PEERS_WITH_GOODS),
        random="search and PyVRP are random; the others are not, and run once. search has its default settings. mean: "
        "over the missions on which all plans of all solvers do all tasks.",
    )
