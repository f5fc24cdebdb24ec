"""Figures A.10 to A.14: a drone's estimates around the setpoints of Table A.21, and how far they are from the truth."""

from __future__ import annotations

from collections.abc import Mapping
from functools import partial
from typing import TYPE_CHECKING

import numpy as np

from muster.perception.drift import SETPOINTS
from muster_studies.effort import Effort
from muster_studies.figures import Draw
from muster_studies.thesis_6_1.drift_charts import plot_drift_from_above, plot_drift_of_coordinate, plot_drift_over_way
from muster_studies.thesis_6_1.drifts import SENSORS, drift
from muster_studies.thesis_6_1.published import seed_count

if TYPE_CHECKING:
    from matplotlib.figure import Figure

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
