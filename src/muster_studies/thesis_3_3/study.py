"""The study: its tables, its legend, and how its runs are made."""

from __future__ import annotations

from muster_studies.descriptions import description
from muster_studies.repetition import Repetition, Reproduction, over_seeds
from muster_studies.runs import Case, Sample
from muster_studies.thesis_3_3.pictures import FIGURES
from muster_studies.thesis_3_3.routes import Routes
from muster_studies.thesis_3_3.rules import Capacities, Chains, Violations
from muster_studies.thesis_3_3.totals import Totals
from muster_studies.thesis_3_3.trials import Readings, Trials

_RUN = ("scenario", "allocator")
_FIGURES = ("iterations", "tasks", "C", "F", "mean", "worst", "s")
_STATISTICS = ("iterations", "tasks", "F", "mean", "worst", "spread", "deviation", "s")

_TABLES: tuple[Reproduction[Case, Sample], ...] = (
    Totals("3.2", ("allocator",), _STATISTICS),
    Totals("3.3", ("figure", "allocator"), _FIGURES, published_iterations=True),
    Totals("3.4", _RUN, _FIGURES),
    Routes("3.5"),
    Routes("3.6"),
    Totals("3.7", _RUN, _FIGURES, plans="3.6"),
    Routes("3.8"),
    Routes("3.9"),
    Totals("3.10", _RUN, _FIGURES, plans="3.9"),
    Chains(),
    Violations(),
    Routes("3.13"),
    Routes("3.14"),
    Totals("3.15", _RUN, _FIGURES, plans="3.14"),
    Capacities(),
    Routes("3.17"),
    Routes("3.18"),
    Totals("3.19", _RUN, _FIGURES, plans="3.18"),
    Totals("3.20", ("scenario", "rules ignored"), _FIGURES),
    Totals("3.21", ("scenario", "objective"), ("tasks", "C", "max u", "F", "E", "s")),
    Totals("3.22", ("scenario", "objective"), ("iterations", "tasks", "C", "max u", "F", "E", "mean", "worst", "s")),
    Trials("A.15", "total+max"),
    Trials("A.16", "iterations"),
    Readings(),
)

THESIS_3_3 = Repetition(
    **description("thesis-3.3"),
    reproductions=_TABLES,
    perform=over_seeds,
    figures=FIGURES,
)
"""Greedy, genetic, hill-climbing and combined task allocation against a benchmark, and under each rule."""
