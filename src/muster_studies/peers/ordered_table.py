"""Missions whose tasks have time windows and wait for each other: tasks done, then the makespan."""

from __future__ import annotations

from muster_studies.peers.contest import OWN, OWN_OTHERS, Match
from muster_studies.peers.counted_table import Counted

ORDERED = Counted(
    number="ordered",
    title="Windows and prerequisites: tasks done and makespan of each solver, means over seeds",
    matches=tuple(Match(mission=f"windows-{seed}", objective="makespan") for seed in range(20)),
    solvers=(OWN, *OWN_OTHERS, "CP-SAT", "OR-Tools"),
    limit_s=2.0,
    measure="makespan [s]",
    fewer="an earlier end",
)
"""Random missions with windows and prerequisites."""
