"""The study: its tables, its legend, how its runs are made, and its pictures."""

from __future__ import annotations

from typing import Any

from muster_studies.descriptions import description
from muster_studies.repetition import Repetition, Reproduction, one_by_one
from muster_studies.rescue.failures import Failures
from muster_studies.rescue.flights import Flight, Planning, repetitions
from muster_studies.rescue.metrics import Figure7, Figure8
from muster_studies.rescue.pictures import FIGURES
from muster_studies.rescue.scenario import Figure5, Figure6

_TABLES: tuple[Reproduction[Flight | Planning, Any], ...] = (Figure5(), Figure6(), Figure7(), Figure8(), Failures())

RESCUE = Repetition(
    **description("rescue"),
    reproductions=_TABLES,
    perform=one_by_one(lambda job: job.perform()),
    seeds=repetitions,
    extras=("map",),
    figures=FIGURES,
)
"""[market-paper]'s scenario, carried out without noise, with noise, and with robots that fail; Figures 7 and 8."""
