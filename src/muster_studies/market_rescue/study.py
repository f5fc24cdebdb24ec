"""The study: its tables, its legend, and how its runs are made."""

from __future__ import annotations

from muster_studies.descriptions import description
from muster_studies.market_rescue.comparison import Comparison
from muster_studies.market_rescue.pictures import FIGURES
from muster_studies.market_rescue.scenario import Allocation, TimeChart
from muster_studies.repetition import Repetition, Reproduction, over_seeds
from muster_studies.runs import Case, Sample

_TABLES: tuple[Reproduction[Case, Sample], ...] = (Allocation(), TimeChart(), Comparison())

MARKET_RESCUE = Repetition(
    **description("market-rescue"),
    reproductions=_TABLES,
    perform=over_seeds,
    figures=FIGURES,
)
"""Market with relinquishing and annealing, in search and rescue."""
