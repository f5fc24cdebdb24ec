"""Studies of `search` beside others, by kind of mission: time, routes, prerequisites, goods and energy."""

from __future__ import annotations

from muster_studies.descriptions import description
from muster_studies.peers.contest import PEERS, WAITING_PEER, Result, Run, perform
from muster_studies.peers.teams_table import Teams
from muster_studies.peers.timed_contest import timed_contest
from muster_studies.peers.timed_tables import (
    CHARGING,
    CUSTOMERS,
    LOADS,
    ORDERED,
    PEERS_WITH_GOODS,
    ROUTES,
    TRANSPORTS,
    WINDOWS,
)
from muster_studies.peers.waiting_table import Waiting
from muster_studies.repetition import Repetition


def peers_timed_study() -> Repetition[Run, Result]:
    """`search` beside OR-Tools, PyVRP, VROOM and published figures, one run at a time."""
    return timed_contest(
        **description("peers-timed"),
        reproductions=(WINDOWS, ORDERED, Teams()),
        random="search and PyVRP are random; the others are not, and run once.",
    )


def peers_routes_study() -> Repetition[Run, Result]:
    """`search` beside PyVRP, OR-Tools and the best values known, one run at a time."""
    return timed_contest(
        **description("peers-routes"),
        reproductions=ROUTES,
        peers=(PEERS["PyVRP"], PEERS["OR-Tools"]),
        conditions="Every solver has the same processor time for each plan",
        random="search and PyVRP are random; OR-Tools is not, and runs once. search has its default settings. mean: "
        "over the missions on which all solvers have plans that count.",
    )


def peers_waiting_study() -> Repetition[Run, Result]:
    """`search` beside CP-SAT on missions with prerequisites, one run at a time."""
    return timed_contest(
        **description("peers-waiting"),
        reproductions=(Waiting(),),
        peers=(WAITING_PEER,),
        perform=perform,
        conditions="Each solver has the processor time that its column says",
        rounded="",
        random="search is random; CP-SAT runs once. search has its default settings.",
    )


def peers_goods_study() -> Repetition[Run, Result]:
    """`search` beside PyVRP, OR-Tools, VROOM and the best values known, one run at a time."""
    return timed_contest(
        **description("peers-goods"),
        reproductions=(LOADS, CUSTOMERS, TRANSPORTS, CHARGING),
        peers=tuple(PEERS[name] for name in PEERS_WITH_GOODS),
        random="search and PyVRP are random; the others are not, and run once. search has its default settings. mean: "
        "over the missions on which all plans of all solvers do all tasks.",
    )
