"""The study: its tables, its legend, how its runs are made, and its pictures."""

from __future__ import annotations

from muster_studies.descriptions import description
from muster_studies.market_5.pictures import FIGURES
from muster_studies.market_5.searches import Search, SearchResult, performed
from muster_studies.market_5.targets import Figure7, Targets
from muster_studies.market_5.tracks import Figure8, Goals, Localisation
from muster_studies.repetition import Repetition, Reproduction, one_by_one
from muster_studies.rescue.flights import repetitions

_TABLES: tuple[Reproduction[Search, SearchResult], ...] = (Figure7(), Figure8(), Goals(), Targets(), Localisation())

MARKET_5 = Repetition(
    **description("market-5"),
    reproductions=_TABLES,
    perform=one_by_one(performed),
    seeds=repetitions,
    extras=("map", "physics"),
    figures=FIGURES,
)
"""Three robots track their ways and search with lasers: Figures 7 and 8, targets, localisation."""
