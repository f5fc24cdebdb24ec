"""The study: `search` beside others on routes: orienteering, longest routes, many depots, long tours."""

from __future__ import annotations

from muster_studies.descriptions import description
from muster_studies.peers.contest import PEERS, Result, Run
from muster_studies.peers.routes_tables import FAMILIES
from muster_studies.peers.timed_contest import timed_contest
from muster_studies.repetition import Repetition


def peers_routes_study() -> Repetition[Run, Result]:
    """`search` beside PyVRP, OR-Tools and the best values known, one run at a time."""
    return timed_contest(
        **description("peers-routes"),
        reproductions=FAMILIES,
        peers=(PEERS["PyVRP"], PEERS["OR-Tools"]),
        conditions="Every solver has the same processor time for each plan",
        random="search and PyVRP are random; OR-Tools is not, and runs once. search has its default settings. mean: "
        "over the missions on which all solvers have plans that count.",
    )
