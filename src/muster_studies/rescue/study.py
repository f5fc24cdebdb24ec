"""The study: its tables, its legend, how its runs are made, and its pictures."""

from __future__ import annotations

from typing import Any

from muster_studies.repetition import Repetition, Reproduction, one_by_one
from muster_studies.rescue.failures import Failures
from muster_studies.rescue.flights import Flight, Planning, repetitions
from muster_studies.rescue.metrics import Figure7, Figure8
from muster_studies.rescue.pictures import FIGURES
from muster_studies.rescue.scenario import Figure5, Figure6

_TABLES: tuple[Reproduction[Flight | Planning, Any], ...] = (Figure5(), Figure6(), Figure7(), Figure8(), Failures())

_LEGEND = (
    "The mission is market-rescue-arena: the paper's robots and survivors; places, obstacles, turning and acceleration "
    "are chosen here. Plans are the market's, with seed 0 where no more is said.",
)

RESCUE = Repetition(
    name="rescue",
    summary="search and rescue carried out, market paper, sections 4.2 to 6",
    document="market paper, sections 4.2 to 6",
    legend=_LEGEND,
    reproductions=_TABLES,
    perform=one_by_one(lambda job: job.perform()),
    seeds=repetitions,
    extras=("map",),
    figures=FIGURES,
)
"""[market-paper]'s scenario, carried out without noise, with noise, and with robots that fail; Figures 7 and 8."""
