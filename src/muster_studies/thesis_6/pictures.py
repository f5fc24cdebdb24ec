"""Pictures like Figures 6.3, 6.10, 6.13 and 6.14: the paths of the robots, and those of their tasks."""

from __future__ import annotations

import tempfile
from pathlib import Path

from muster.report import save_figure
from muster.report.record import RecordWriter, read_record
from muster.report.recorded_tracks import plot_flown
from muster_studies.effort import Effort
from muster_studies.thesis_6.action_paths import ActionPaths
from muster_studies.thesis_6.flights import Flight, carried_out, mission_with
from muster_studies.thesis_6.published import plans

FIGURES = {"6.2": "6.3", "6.6": "6.10", "6.8": "6.13", "6.9": "6.14"}
"""The published picture of what was flown, by table of routes."""


def draw(effort: Effort, folder: Path, numbers: tuple[str, ...]) -> list[Path]:
    """One file for each plan that was flown, of the tables of routes asked for or all of `actions`; the files made."""
    made = []
    for number in ActionPaths().routes:
        if number in numbers or ActionPaths().number in numbers:
            (plan,) = (plan for plan in plans(number) if plan.with_actions)
            path = folder / f"{number}-like-figure-{FIGURES[number]}.png"
            _draw(plan.flight(plan.with_actions), path)
            made.append(path)
    return made


def _draw(flight: Flight, path: Path) -> None:
    with tempfile.TemporaryDirectory() as folder:
        record = Path(folder) / "record.mcap"
        with RecordWriter(record, mission_with(flight)) as recorder:
            carried_out(flight, recorder)
        save_figure(plot_flown(read_record(record)), path)
