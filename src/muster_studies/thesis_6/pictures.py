"""Figures 6.2, 6.3 and 6.8 to 6.14: plans, the trajectories of the robots, and their worlds."""

from __future__ import annotations

import tempfile
from collections.abc import Iterator
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING

from muster.mission.plan import Plan, Route
from muster.report.record import RecordWriter, read_record
from muster.report.recorded_tracks import plot_flown
from muster_studies.effort import Effort
from muster_studies.figures import Draw, StudyFigure
from muster_studies.plan_pictures import PlanPanel, plan_figure
from muster_studies.runs import mission_named
from muster_studies.thesis_6.action_paths import ActionPaths
from muster_studies.thesis_6.flights import Flight, carried_out, mission_with
from muster_studies.thesis_6.published import PublishedPlan, plans
from muster_studies.world_pictures import world_figure

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

_FLOWN = {
    "6.3": ("6.2", "the trajectories of three drones over the tasks of 16T-3R in Gazebo"),
    "6.10": ("6.6", "the trajectories of six ground robots over the tasks of 31T-6R50 in Gazebo"),
    "6.13": ("6.8", "the trajectories of two Wafflebots over the tasks of 6T-2R, in truth and in Gazebo"),
    "6.14": ("6.9", "the trajectories of two Wafflebots over the tasks of 11T-2R, in truth and in Gazebo"),
}
"""By published figure the table of routes that was carried out, and what the print shows."""


_PLANNED = {
    "6.2": (("6.2",), "routes of three drones over 16T-3R by the greedy and by the combined genetic allocation"),
    "6.9": (("6.6",), "routes of six ground robots over 31T-6R50 by the greedy and by the combined genetic allocation"),
    "6.12": (("6.8", "6.9"), "routes of two Wafflebots over 6T-2R and 11T-2R by the greedy allocation"),
}
"""By published figure the tables of routes whose plans it has, and what the print shows."""

_WORLDS = {
    "6.8": ("6.6", "the places of the tasks of 31T-6R50 and six ground robots at their starts in Gazebo"),
    "6.11": ("6.8", "two Wafflebots at their starts, a photograph and Gazebo"),
}
"""By published figure the table of routes of the mission that is seen, and what the print shows."""


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


def _figures() -> Iterator[StudyFigure]:
    for number, (tables, shows) in _PLANNED.items():
        yield _figure(number, shows, partial(_planned, tables), tables, "misprints corrected")
    for number, (table, shows) in _FLOWN.items():
        differs = "the kinematic world in place of Gazebo and of real robots"
        yield _figure(number, shows, partial(_flown, table), (table, ActionPaths().number), differs)
    for number, (table, shows) in _WORLDS.items():
        yield _figure(number, shows, partial(_world, table), (table,), "the physics world; no photograph")


def _figure(number: str, shows: str, draw: Draw, tables: tuple[str, ...], differs: str) -> StudyFigure:
    return StudyFigure(number=number, source="tcf-thesis", shows=shows, draw=draw, tables=tables, differs=differs)


FIGURES = tuple(sorted(_figures(), key=lambda figure: int(figure.number.partition(".")[2])))
