"""The study: its tables, its legend, and how its runs are made."""

from __future__ import annotations

from muster_studies.market_rescue.comparison import Comparison
from muster_studies.market_rescue.pictures import FIGURES
from muster_studies.market_rescue.scenario import Allocation, TimeChart
from muster_studies.repetition import Repetition, Reproduction, over_seeds
from muster_studies.runs import Case, Sample

_TABLES: tuple[Reproduction[Case, Sample], ...] = (Allocation(), TimeChart(), Comparison())

_LEGEND = (
    "A is travelled distance by velocity, B the sum of execution times by aging factor; a robot takes A + B, and the "
    "greatest A + B is what is minimised.",
    "All own numbers are recomputed by muster.verify. best, mean and worst are over all seeds; s is the processor time "
    "of a run (the mean over all seeds).",
)

MARKET_RESCUE = Repetition(
    name="market-rescue",
    summary="market with relinquishing, market paper, sections 4 and 5",
    document="market paper, sections 4 and 5",
    legend=_LEGEND,
    reproductions=_TABLES,
    perform=over_seeds,
    figures=FIGURES,
)
"""Market with relinquishing and annealing, in search and rescue."""
