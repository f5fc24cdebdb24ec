"""Quality measures of a motion: length, error, risk, distance, smoothness, time ([market-paper], section 4.2)."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from muster.mission.errors import ParameterError
from muster.mission.values.arrays import Floats


@dataclass(frozen=True)
class TrajectoryError:
    """Distances between reference and actual places, in metres: `total` is (7), the others are of figure 8."""

    total: float
    mean: float
    most: float


@dataclass(frozen=True)
class Closest:
    """The least distance between two of a team: metres between their centres, when, and which two."""

    distance_m: float
    time_s: float
    pair: tuple[int, int]


def path_length(points: Floats) -> float:
    """Metres along the straight pieces between points (n, d)."""
    return float(np.linalg.norm(np.diff(points, axis=0), axis=1).sum())


def travel_time(times: Floats) -> float:
    """Seconds from the first moment (n,) to the last."""
    return float(times[-1] - times[0])


def trajectory_error(reference: Floats, actual: Floats) -> TrajectoryError:
    """(7): between places (n, d) at the same moments. A sum grows with the number of samples; a mean does not.

    Raises
    ------
    ParameterError
        if the shapes differ or there is no sample.
    """
    if reference.shape != actual.shape or not len(reference):
        raise ParameterError(f"places of shapes {reference.shape} and {actual.shape}; expected the same, not empty")
    off = np.linalg.norm(reference - actual, axis=1)
    return TrajectoryError(float(off.sum()), float(off.mean()), float(off.max()))


def risk_factor(clearances: Floats) -> float:
    """(8): the sum of 1 / distance to the nearest obstacle over samples (n,), in 1/m; inf where one touches.

    It grows with the number of samples: compare motions that are sampled alike. Section 5 of the paper calls the least
    distance the risk factor too; that is `clearances.min()`.

    Raises
    ------
    ParameterError
        if a distance is negative.
    """
    if (clearances < 0).any():
        raise ParameterError(f"clearance: {clearances.min()}; expected metres of at least 0")
    with np.errstate(divide="ignore"):
        return float((1 / clearances).sum())


def turning(points: Floats) -> float:
    """Smoothness: by how much the direction changes along points (n, d) in all, in radians; 0 on a straight line."""
    pieces = np.diff(points, axis=0)
    length = np.linalg.norm(pieces, axis=1)
    units = pieces[length > 0] / length[length > 0, None]
    apart = np.linalg.norm(np.diff(units, axis=0), axis=1)
    together = np.linalg.norm(units[1:] + units[:-1], axis=1)
    return float(2 * np.arctan2(apart, together).sum())


def closest(times: Floats, positions: Floats) -> Closest:
    """The least distance between any two robots at any moment, between the samples too.

    Parameters
    ----------
    times
        (t,) seconds, never falling.
    positions
        (t, n, d) metres, n >= 2; between samples each robot goes straight and evenly.

    Raises
    ------
    ParameterError
        for other shapes.
    """
    if positions.ndim != 3 or len(times) != len(positions) or not len(times) or positions.shape[1] < 2:
        raise ParameterError(f"shapes {times.shape}, {positions.shape}; expected (t,) and (t, n, d) with n >= 2")
    best = Closest(np.inf, float(times[0]), (0, 1))
    for first in range(positions.shape[1] - 1):
        apart = positions[:, first + 1 :] - positions[:, first, None]
        distance, when, other = _least(times, apart)
        if distance < best.distance_m:
            best = Closest(distance, when, (first, first + 1 + other))
    return best


def _least(times: Floats, apart: Floats) -> tuple[float, float, int]:
    """The least length of vectors (t, k, d) that change evenly between samples: it, when, and of which."""
    apart = np.concatenate([apart, apart[-1:]])
    times = np.append(times, times[-1])
    start, change = apart[:-1], np.diff(apart, axis=0)
    square = np.sum(change**2, axis=2)
    share = np.clip(-np.sum(start * change, axis=2) / np.where(square > 0, square, 1.0), 0.0, 1.0)
    lengths = np.linalg.norm(start + share[:, :, None] * change, axis=2)
    k, other = np.unravel_index(np.argmin(lengths), lengths.shape)
    when = times[k] + share[k, other] * (times[k + 1] - times[k])
    return float(lengths[k, other]), float(when), int(other)
