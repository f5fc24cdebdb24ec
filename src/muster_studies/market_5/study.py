"""The study: its tables, its legend, how its runs are made, and its pictures."""

from __future__ import annotations

from muster_studies.market_5.pictures import FIGURES
from muster_studies.market_5.searches import Search, SearchResult, performed
from muster_studies.market_5.targets import Figure7, Targets
from muster_studies.market_5.tracks import Figure8, Goals, Localisation
from muster_studies.repetition import Repetition, Reproduction, one_by_one
from muster_studies.rescue.flights import repetitions

_TABLES: tuple[Reproduction[Search, SearchResult], ...] = (Figure7(), Figure8(), Goals(), Targets(), Localisation())

_LEGEND = (
    "The mission is market-rescue-arena, carried out in the kinematic and in the physics world, where the paper took "
    "V-REP; robots steer by odometry and laser landmarks, or by odometry alone. Places, noise and landmarks are ours. "
    "Allocation, times and failing robots: study rescue.",
)

MARKET_5 = Repetition(
    name="market-5",
    summary="search and tracking with lasers, market paper, section 5",
    document="market paper, sections 4.2, 4.3 and 5",
    legend=_LEGEND,
    reproductions=_TABLES,
    perform=one_by_one(performed),
    seeds=repetitions,
    extras=("map", "physics"),
    figures=FIGURES,
)
"""Three robots track their ways and search with lasers: Figures 7 and 8, targets, localisation."""
