"""The study: its tables, its legend, and how its runs are made.

Figures 5 and 6: the allocation as routes, and its time chart.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from muster.mission.model import Mission
from muster.mission.plan import Plan, Route
from muster.report import plot_gantt, plot_routes
from muster_studies.descriptions import captioned, description
from muster_studies.effort import Effort
from muster_studies.market_rescue.comparison import Comparison
from muster_studies.market_rescue.scenario import Allocation, TimeChart, market_case
from muster_studies.repetition import Repetition, Reproduction, over_seeds
from muster_studies.runs import Case, Sample, mission_named, perform

if TYPE_CHECKING:
    from matplotlib.axes import Axes

    from muster.verification import Verdict


def _planned(effort: Effort) -> tuple[Mission, Verdict]:
    case = market_case(effort)
    return mission_named(case.mission), perform(case, 0).verdict


def _routes(effort: Effort) -> Axes:
    mission, verdict = _planned(effort)
    plan = Plan(routes=tuple(Route(route.robot, route.tasks) for route in verdict.routes), allocator="market")
    return plot_routes(mission, plan, verdict)


def _chart(effort: Effort) -> Axes:
    return plot_gantt(*_planned(effort))


FIGURES = captioned("market-rescue", {"5": _routes, "6": _chart})


_TABLES: tuple[Reproduction[Case, Sample], ...] = (Allocation(), TimeChart(), Comparison())

MARKET_RESCUE = Repetition(
    **description("market-rescue"),
    reproductions=_TABLES,
    perform=over_seeds,
    figures=FIGURES,
)
"""Market with relinquishing and annealing, in search and rescue."""
