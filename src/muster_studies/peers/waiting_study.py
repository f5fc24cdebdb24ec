"""The study: `search` beside CP-SAT, which has more time, on missions whose tasks wait for each other."""

from __future__ import annotations

from muster_studies.descriptions import description
from muster_studies.peers.contest import WAITING_PEER, Result, Run, perform
from muster_studies.peers.timed_contest import timed_contest
from muster_studies.peers.waiting_table import Waiting
from muster_studies.repetition import Repetition


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
