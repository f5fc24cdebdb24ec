"""The study: `search` beside others on missions with time windows, prerequisites and teams."""

from __future__ import annotations

from muster_studies.descriptions import description
from muster_studies.peers.contest import Result, Run
from muster_studies.peers.ordered_table import ORDERED
from muster_studies.peers.teams_table import Teams
from muster_studies.peers.timed_contest import timed_contest
from muster_studies.peers.windows_table import Windows
from muster_studies.repetition import Repetition


def peers_timed_study() -> Repetition[Run, Result]:
    """`search` beside OR-Tools, PyVRP, VROOM and published figures, one run at a time."""
    return timed_contest(
        **description("peers-timed"),
        reproductions=(Windows(), ORDERED, Teams()),
        random="search and PyVRP are random; the others are not, and run once.",
    )
