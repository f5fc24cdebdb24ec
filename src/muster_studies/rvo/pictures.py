"""Figures A.4 to A.9 and A.15 to A.17: trajectories, least distances and velocities of three methods.

Draws robots' trajectories and distances for several methods of collision avoidance side by side.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import cache, partial
from typing import TYPE_CHECKING, Any

import numpy as np

from muster.mission.values.arrays import Floats
from muster.report.figures.canvas import new_figure, quiet_frame
from muster.report.figures.styles import ALARM, DASHED, QUIET_TEXT, TEXT, robot_style
from muster_studies.descriptions import captioned
from muster_studies.effort import Effort
from muster_studies.rvo.runs import Job
from muster_studies.rvo.scenarios import Scenario, scenarios, tables

if TYPE_CHECKING:
    from matplotlib.figure import Figure

_INCHES = 3.6
"""Width and height of one panel."""


@dataclass(frozen=True, kw_only=True, eq=False)
class MethodRun:
    """The result of one method in one scenario.

    Parameters
    ----------
    goals
        (n, 2) metres.
    positions, velocities
        (steps + 1, n, 2) metres and (steps, n, 2) metres a second.
    least_distances_m
        (steps,) between two centres.
    touch_m, inflated_m
        the sum of two radii, and of two inflated ones.
    """

    method: str
    robots: tuple[str, ...]
    goals: Floats
    positions: Floats
    velocities: Floats
    least_distances_m: Floats
    dt: float
    touch_m: float
    inflated_m: float


def plot_trajectories(ways: Sequence[MethodRun], title: str) -> Figure:
    """For each method draw from above the trajectories, beneath them the least distance over time.

    Raises
    ------
    MissingExtraError
        if matplotlib is not installed.
    """
    figure, rows = _panels(len(ways), (1.6, 1.0), title)
    for column, one in enumerate(ways):
        _draw_ways(rows[0][column], one)
        _draw_distances(rows[1][column], one)
    rows[1][0].set_ylim(bottom=0.0)
    for row in rows:
        row[0].legend(loc="best", fontsize=7, frameon=False)
    return figure


def plot_velocities(ways: Sequence[MethodRun], title: str) -> Figure:
    """For each method draw both components of the velocities over time.

    Raises
    ------
    MissingExtraError
        if matplotlib is not installed.
    """
    figure, rows = _panels(len(ways), (1.0, 1.0), title)
    for column, one in enumerate(ways):
        rows[0][column].set_title(one.method, fontsize=10, color=TEXT)
        for axis, name in enumerate("xy"):
            _draw_velocities(rows[axis][column], one, axis, name)
    rows[0][0].sharey(rows[1][0])
    rows[0][0].legend(loc="best", fontsize=7, frameon=False)
    return figure


def _panels(columns: int, heights: tuple[float, ...], title: str) -> tuple[Figure, Any]:
    """A figure of rows of panels; those over time have one scale a row, so that methods can be compared."""
    figure = new_figure(_INCHES * columns, sum(heights) * _INCHES)
    rows = figure.subplots(len(heights), columns, squeeze=False, height_ratios=heights)
    for row, height in zip(rows, heights, strict=True):
        for ax in row:
            quiet_frame(ax)
            if height == 1.0 and ax is not row[0]:
                ax.sharex(row[0])
                ax.sharey(row[0])
    figure.suptitle(title, fontsize=11, fontweight="bold", color=TEXT)
    return figure, rows


def _draw_ways(ax: Any, ways: MethodRun) -> None:
    for index, robot in enumerate(ways.robots):
        color, (x, y) = robot_style(index).color, ways.positions[:, index].T
        ax.plot(x, y, color=color, linewidth=1.2, label=robot)
        ax.plot(x[0], y[0], "o", color=color, markersize=9, markerfacecolor="none", markeredgewidth=1.4)
        ax.plot(*ways.goals[index], "x", color=color, markersize=6, markeredgewidth=1.4)
    ax.set_aspect("equal", adjustable="datalim")
    ax.set_title(ways.method, fontsize=10, color=TEXT)
    ax.set_xlabel("x (m); o start, x goal")
    ax.set_ylabel("y (m)")


def _draw_distances(ax: Any, ways: MethodRun) -> None:
    ax.plot(_times(ways), ways.least_distances_m, color=TEXT, linewidth=1.2, label="least distance")
    ax.axhline(ways.inflated_m, color=QUIET_TEXT, linestyle=DASHED, linewidth=1.0, label="inflated radii")
    ax.axhline(ways.touch_m, color=ALARM, linewidth=1.0, label="contact")
    ax.set_xlabel("time (s)")
    ax.set_ylabel("least distance of centres (m)")


def _draw_velocities(ax: Any, ways: MethodRun, axis: int, name: str) -> None:
    for index, robot in enumerate(ways.robots):
        look: dict[str, Any] = {"color": robot_style(index).color, "linewidth": 0.9, "label": robot}
        ax.plot(_times(ways), ways.velocities[:, index, axis], **look)
    ax.set_xlabel("time (s)")
    ax.set_ylabel(f"velocity, {name} (m/s)")


def _times(ways: MethodRun) -> Floats:
    return np.arange(1, len(ways.velocities) + 1, dtype=np.float64) * ways.dt


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
