"""Figures A.4 to A.9 and A.15 to A.17: trajectories, least distances and velocities of three methods."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from functools import cache, partial
from typing import TYPE_CHECKING

from muster.report.trajectories import MethodRun, plot_trajectories, plot_velocities
from muster_studies.effort import Effort
from muster_studies.figures import StudyFigure
from muster_studies.rvo.runs import Job
from muster_studies.rvo.scenarios import Scenario, scenarios, tables

if TYPE_CHECKING:
    from matplotlib.figure import Figure

_BESIDE = "two methods of later years stand beside the published one"

_PICTURED = ("RVO", "HRVO", "ORCA")

Plot = Callable[[Sequence[MethodRun], str], "Figure"]


_SHOWN: tuple[tuple[str, Plot, int, str], ...] = (
    (
        "A.17",
        plot_trajectories,
        4,
        "the paths of simulated robots and the least distance between two of them over time",
    ),
    ("A.17", plot_velocities, 7, "both components of the simulated robots' velocities over time"),
    ("A.22", plot_trajectories, 15, "the paths of two Wafflebots and the distance between them over time"),
)
"""Of each three figures the table of scenarios, how they are drawn, the number of the first, and what they show."""


def _figure(number: str, table: str, scenario: str, plot: Plot, shows: str) -> StudyFigure:
    title = f"Table {table}, scenario {scenario} (as Figure {number})"
    return StudyFigure(
        number=number,
        source="tcf-thesis",
        shows=shows,
        draw=partial(_draw, table, scenario, plot, title),
        tables=(table,),
        differs=_BESIDE,
    )


def _draw(table: str, number: str, plot: Plot, title: str, effort: Effort) -> Figure:
    """Three methods in a scenario; a misprinted one as printed and as corrected."""
    variants = [scenario for scenario in scenarios(table) if scenario.number == number]
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


FIGURES = tuple(
    _figure(f"A.{first + k}", table, scenario, plot, f"{shows}, scenario {scenario}")
    for table, plot, first, shows in _SHOWN
    for k, scenario in enumerate("123")
)
