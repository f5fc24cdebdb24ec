"""Figures A.4 to A.9 and A.15 to A.17: trajectories, least distances and velocities of three methods."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from functools import cache, partial
from typing import TYPE_CHECKING

from muster_studies.descriptions import captioned
from muster_studies.effort import Effort
from muster_studies.rvo.runs import Job
from muster_studies.rvo.scenarios import Scenario, scenarios, tables
from muster_studies.rvo.trajectories import MethodRun, plot_trajectories, plot_velocities

if TYPE_CHECKING:
    from matplotlib.figure import Figure

_PICTURED = ("RVO", "HRVO", "ORCA")

Plot = Callable[[Sequence[MethodRun], str], "Figure"]


_SHOWN: tuple[tuple[str, Plot, int], ...] = (
    ("A.17", plot_trajectories, 4),
    ("A.17", plot_velocities, 7),
    ("A.22", plot_trajectories, 15),
)
"""Of each three figures the table of scenarios, how they are drawn, and the number of the first."""


def _draw(table: str, number: str, plot: Plot, figure: str, effort: Effort) -> Figure:
    """Three methods in a scenario; a misprinted one as printed and as corrected."""
    variants = [scenario for scenario in scenarios(table) if scenario.number == number]
    title = f"Table {table}, scenario {number} (as Figure {figure})"
    return plot([_run(scenario, method) for scenario in variants for method in _PICTURED], title)


@cache
def _run(scenario: Scenario, method: str) -> MethodRun:
    job = Job(scenario, method, 0 if method == "ORCA" else None)
    found, parameters = job.perform(), tables()["A.18"]
    return MethodRun(
        method=f"{method} {scenario.side}".rstrip(),
        robots=tuple(scenario.robots),
        goals=job.crowd.goals,
        positions=found.positions,
        velocities=found.velocities,
        least_distances_m=found.least_distances_m,
        dt=found.dt,
        touch_m=2 * parameters["radius_m"],
        inflated_m=2 * parameters["inflated_radius_m"],
    )


FIGURES = captioned(
    "rvo",
    {
        (figure := f"A.{first + k}"): partial(_draw, table, scenario, plot, figure)
        for table, plot, first in _SHOWN
        for k, scenario in enumerate("123")
    },
)
