"""Figures 6.3, 6.10, 6.13 and 6.14: the trajectories of the robots, and those of their tasks."""

from __future__ import annotations

import tempfile
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING

from muster.report.record import RecordWriter, read_record
from muster.report.recorded_tracks import plot_flown
from muster_studies.effort import Effort
from muster_studies.figures import StudyFigure
from muster_studies.thesis_6.action_paths import ActionPaths
from muster_studies.thesis_6.flights import Flight, carried_out, mission_with
from muster_studies.thesis_6.published import plans

if TYPE_CHECKING:
    from matplotlib.axes import Axes

_FLOWN = {
    "6.3": ("6.2", "the trajectories of three drones over the tasks of 16T-3R in Gazebo"),
    "6.10": ("6.6", "the trajectories of six ground robots over the tasks of 31T-6R50 in Gazebo"),
    "6.13": ("6.8", "the trajectories of two Wafflebots over the tasks of 6T-2R, in truth and in Gazebo"),
    "6.14": ("6.9", "the trajectories of two Wafflebots over the tasks of 11T-2R, in truth and in Gazebo"),
}
"""By published figure the table of routes that was carried out, and what the print shows."""


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


FIGURES = tuple(
    StudyFigure(
        number=number,
        source="tcf-thesis",
        shows=shows,
        draw=partial(_flown, table),
        tables=(table, ActionPaths().number),
        differs="the kinematic world in place of Gazebo and of real robots",
    )
    for number, (table, shows) in _FLOWN.items()
)
