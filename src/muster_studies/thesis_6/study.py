"""The study: its tables, its legend, and how its runs are made.

Figures 6.2, 6.3 and 6.8 to 6.14: plans, the trajectories of the robots, and their worlds.
"""

from __future__ import annotations

import tempfile
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING

from muster.mission.plan import Plan, Route
from muster.report.maps.recorded_tracks import plot_flown
from muster.report.record import RecordWriter, read_record
from muster_studies.descriptions import captioned, description
from muster_studies.effort import Effort
from muster_studies.plan_pictures import PlanPanel, plan_figure
from muster_studies.repetition import Repetition, Reproduction, one_by_one
from muster_studies.runs import mission_named
from muster_studies.thesis_6.action_paths import ActionPaths
from muster_studies.thesis_6.disturbed import CapacityReserve, UsageUnderNoise
from muster_studies.thesis_6.flights import Flight, FlightResult, carried_out, fly, mission_with
from muster_studies.thesis_6.laws import ByLaw
from muster_studies.thesis_6.misaligned import MisalignedMarkers
from muster_studies.thesis_6.physics import BesidePhysics
from muster_studies.thesis_6.published import PublishedPlan, plans
from muster_studies.thesis_6.routes import RobotUsages
from muster_studies.thesis_6.totals import SystemTotals
from muster_studies.world_pictures import world_figure

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

_PLANNED = {"6.2": ("6.2",), "6.9": ("6.6",), "6.12": ("6.8", "6.9")}
"""By published figure the tables of routes whose plans it has."""
_FLOWN = {"6.3": "6.2", "6.10": "6.6", "6.13": "6.8", "6.14": "6.9"}
"""By published figure the table of routes that was carried out."""
_WORLDS = {"6.8": "6.6", "6.11": "6.8"}
"""By published figure the table of routes of the mission that is seen."""


def _planned(tables: tuple[str, ...], effort: Effort) -> Figure:
    return plan_figure([_panel(plan) for table in tables for plan in plans(table)])


def _panel(plan: PublishedPlan) -> PlanPanel:
    return PlanPanel(
        title=f"Figure {plan.figure}: {plan.allocator}",
        mission=mission_named(plan.mission),
        plan=_plan(plan),
        ignored=plan.ignored,
    )


def _plan(plan: PublishedPlan) -> Plan:
    return Plan(routes=tuple(Route(*route) for route in plan.sequences), ignored=plan.ignored)


def _world(table: str, effort: Effort) -> Figure:
    plan, mission = plans(table)[0], mission_named(plans(table)[0].mission)
    return world_figure(mission, _plan(plan), f"{mission.name} in the physics world", plan.ignored)


def _flown(table: str, effort: Effort) -> Axes:
    """The one plan of a table of routes that was carried out, its tasks as ways."""
    (plan,) = (plan for plan in plans(table) if plan.with_actions)
    return _recorded(plan.flight(plan.with_actions))


def _recorded(flight: Flight) -> Axes:
    with tempfile.TemporaryDirectory() as folder:
        record = Path(folder) / "record.mcap"
        with RecordWriter(record, mission_with(flight)) as recorder:
            carried_out(flight, recorder)
        return plot_flown(read_record(record))


FIGURES = captioned(
    "thesis-6",
    {
        **{number: partial(_planned, tables) for number, tables in _PLANNED.items()},
        **{number: partial(_flown, table) for number, table in _FLOWN.items()},
        **{number: partial(_world, table) for number, table in _WORLDS.items()},
    },
)


_TABLES: tuple[Reproduction[Flight, FlightResult], ...] = (
    RobotUsages("6.2"),
    SystemTotals("6.3", "6.2"),
    RobotUsages("6.6"),
    SystemTotals("6.7", "6.6"),
    RobotUsages("6.8"),
    RobotUsages("6.9"),
    SystemTotals("6.10", "6.8"),
    SystemTotals("6.11", "6.9"),
    ActionPaths(),
    BesidePhysics(),
    ByLaw(),
    UsageUnderNoise(),
    MisalignedMarkers(),
    CapacityReserve(),
)

THESIS_6 = Repetition(
    **description("thesis-6"),
    reproductions=_TABLES,
    perform=one_by_one(fly),
    figures=FIGURES,
)
"""What plans cost when robots carry them out: calculated, in Gazebo, in truth, and here."""
