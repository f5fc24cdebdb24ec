"""Figures A.10 to A.14: a drone's estimates around the setpoints of Table A.21, and how far they are from the truth.

Draws how far estimated places drift from the true ones: from above, by coordinate, and over the way travelled.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from functools import partial
from typing import TYPE_CHECKING, Any

import numpy as np

from muster.perception.drift import SETPOINTS, Drift
from muster.report.figures.canvas import new_figure
from muster.report.figures.styles import ALARM, DASHED, QUIET_TEXT, TEXT, robot_style
from muster_studies.effort import Effort
from muster_studies.figures import Draw
from muster_studies.thesis_6_1.drifts import SENSORS, drift
from muster_studies.thesis_6_1.published import seed_count
from muster_studies.tracking_pictures import finish

if TYPE_CHECKING:
    from matplotlib.figure import Figure

_WIDTH_IN = 7.6


def plot_drift_from_above(drift: Drift, names: Sequence[str], setpoints: Any, title: str) -> Figure:
    """Draw the true way, the estimated ones and the setpoints (n, 3) from above.

    Raises
    ------
    MissingExtraError
        if matplotlib is not installed.
    """
    figure = new_figure(_WIDTH_IN, 5.8)
    ax = figure.subplots()
    for index, (name, places) in enumerate(zip(names, drift.places, strict=True)):
        ax.plot(*places[:, :2].T, color=robot_style(index).color, linewidth=0.9, label=name)
    ax.plot(*drift.truth[:, :2].T, color=TEXT, linestyle=DASHED, linewidth=1.0, label="true")
    ax.plot(*np.asarray(setpoints)[:, :2].T, "x", color=ALARM, markersize=7, label="setpoint")
    ax.set_aspect("equal", adjustable="datalim")
    ax.set_xlabel("x [m]")
    ax.set_ylabel("y [m]")
    ax.legend(loc="best", fontsize=7, frameon=False)
    finish(figure, title)
    return figure


def plot_drift_of_coordinate(drift: Drift, names: Sequence[str], axis: int, title: str) -> Figure:
    """Draw one coordinate over time, 0 for x: true and estimated; beneath it the errors of the estimates.

    Raises
    ------
    MissingExtraError
        if matplotlib is not installed.
    """
    figure = new_figure(_WIDTH_IN, 5.6)
    above, below = figure.subplots(2, 1, sharex=True, height_ratios=(3, 2))
    for index, (name, places) in enumerate(zip(names, drift.places, strict=True)):
        look: dict[str, Any] = {"color": robot_style(index).color, "linewidth": 0.9, "label": name}
        above.plot(drift.times, places[:, axis], **look)
        below.plot(drift.times, places[:, axis] - drift.truth[:, axis], **look)
    above.plot(drift.times, drift.truth[:, axis], color=TEXT, linestyle=DASHED, linewidth=1.0, label="true")
    below.axhline(0.0, color=QUIET_TEXT, linewidth=0.8)
    above.set_ylabel(f"{'xyz'[axis]} [m]")
    below.set_ylabel("error [m]")
    below.set_xlabel("time [s]")
    above.legend(loc="best", fontsize=7, frameon=False, ncols=2)
    finish(figure, title)
    return figure


def plot_drift_over_way(
    drifts: Sequence[Drift], errors: Mapping[str, str], pass_ends_m: Sequence[float], title: str
) -> Figure:
    """Draw each flight's errors over the way travelled, their means bold, and where each pass ends.

    `errors` are the kinds, attributes of a drift, by their names in the legend.

    Raises
    ------
    MissingExtraError
        if matplotlib is not installed.
    """
    figure = new_figure(_WIDTH_IN, 4.4)
    ax = figure.subplots()
    for end in pass_ends_m:
        ax.axvline(end, color=QUIET_TEXT, linestyle=DASHED, linewidth=0.7)
    for index, (name, kind) in enumerate(errors.items()):
        color = robot_style(index).color
        for each in drifts:
            ax.plot(each.travelled, getattr(each, kind), color=color, linewidth=0.4, alpha=0.5)
        mean = np.mean([getattr(each, kind) for each in drifts], axis=0)
        ax.plot(drifts[0].travelled, mean, color=color, linewidth=1.8, label=f"{name}, mean of {len(drifts)}")
    ax.set_xlabel("way travelled [m]; dashed: a pass ends")
    ax.set_ylabel("error of the place [m]")
    ax.set_ylim(bottom=0.0)
    ax.legend(loc="upper left", fontsize=7, frameon=False)
    finish(figure, title)
    return figure


_NAMES = tuple(SENSORS.values())


def _from_above(effort: Effort) -> Figure:
    return plot_drift_from_above(drift(0), _NAMES, SETPOINTS, "The way around the setpoints, true and estimated")


def _coordinate(axis: int, effort: Effort) -> Figure:
    return plot_drift_of_coordinate(drift(0), _NAMES, axis, f"Coordinate {'xyz'[axis]}, true and estimated")


def _over_way(effort: Effort) -> Figure:
    drifts = [drift(seed) for seed in range(seed_count(effort))]
    errors = {name: kind for kind, name in SENSORS.items()}
    title = "Error of the place over the way travelled"
    return plot_drift_over_way(drifts, errors, _pass_ends_m(), title)


def _pass_ends_m() -> list[float]:
    """The metres at which the drone comes back to the first setpoint, each time."""
    flown = drift(0)
    near = np.linalg.norm(flown.truth - np.array(SETPOINTS[0]), axis=1) < 1e-9
    arrivals = np.flatnonzero(near[1:] & ~near[:-1]) + 1
    return [float(flown.travelled[arrival]) for arrival in arrivals]


DRAWINGS: Mapping[str, Draw] = {
    "A.10": _from_above,
    **{f"A.{11 + axis}": partial(_coordinate, axis) for axis in range(3)},
    "A.14": _over_way,
}
"""By number of a figure."""
