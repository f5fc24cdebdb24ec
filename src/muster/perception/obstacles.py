"""Obstacles in a laser scan: position, size and shape ([tcf-thesis], section 2.1.2).

The steps of its reference [22]: a median filter against salt and pepper, angle and distance to points (2.8), clusters,
shapes by rules (circle, line, rectangle). Of its reference [23] (Figure 2.1): the obstacle is inflated, and its left
and right edges are where a robot may go to pass it. The thesis prints no numbers of the rules; they are parameters.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from muster.mission.errors import ParameterError
from muster.mission.values.ranges import require_counts, require_finite_positive
from muster.perception.kalman import Floats
from muster.perception.laser import points_of, require_scan
from muster.perception.shapes import Shape, shape_of


@dataclass(frozen=True, kw_only=True)
class Detection:
    """The rules.

    Parameters
    ----------
    window
        beams over which the median is taken; odd, 1 for none.
    gap_m
        between two points beside each other from which they are of two obstacles; where beams are further apart, three
        times their distance.
    fewest
        points of an obstacle.
    tolerance_m
        root mean square by which points may be off a shape.

    Raises
    ------
    ParameterError
        if a number is out of range.
    """

    window: int = 3
    gap_m: float = 0.1
    fewest: int = 3
    tolerance_m: float = 0.01

    def __post_init__(self) -> None:
        if self.window < 1 or self.window % 2 == 0:
            raise ParameterError(f"window: {self.window}; expected an odd number of at least 1")
        require_counts(1, fewest=self.fewest)
        require_finite_positive(gap_m=self.gap_m, tolerance_m=self.tolerance_m)


@dataclass(frozen=True, eq=False)
class Obstacle:
    """A cluster of points.

    Parameters
    ----------
    points
        (n, 2) metres in the scanner's frame, from right to left.
    shape
        what the points show: its name, position, length and width.
    """

    points: Floats
    shape: Shape

    def edges(self, margin_m: float) -> tuple[tuple[float, float], tuple[float, float]]:
        """(x_f, y_f), (x_l, y_l) of Figure 2.1: the farthest left and right points of the obstacle grown by a margin.

        Where a line from the scanner touches the grown obstacle; the scanner's own place where that is within it.
        """
        away = np.hypot(*self.points.T)
        bearings = np.arctan2(self.points[:, 1], self.points[:, 0])
        turns = np.arcsin(np.minimum(margin_m / away, 1.0))
        tangents = np.sqrt(np.maximum(away**2 - margin_m**2, 0.0))
        left, right = int(np.argmax(bearings + turns)), int(np.argmin(bearings - turns))
        return (
            _at(tangents[left], bearings[left] + turns[left]),
            _at(tangents[right], bearings[right] - turns[right]),
        )


def obstacles(ranges: Floats, bearings: Floats, detection: Detection | None = None) -> tuple[Obstacle, ...]:
    """The obstacles of a scan, from right to left.

    Parameters
    ----------
    ranges
        (n,) metres, inf where a beam met nothing.
    bearings
        (n,) radians, evenly spaced, rising.

    Raises
    ------
    ParameterError
        if the shapes differ.
    """
    require_scan(ranges, bearings)
    detection = detection or Detection()
    smooth = median(ranges, detection.window)
    return tuple(
        Obstacle(points, shape_of(points, detection.tolerance_m))
        for points in clusters(smooth, bearings, detection.gap_m)
        if len(points) >= detection.fewest
    )


def median(ranges: Floats, window: int) -> Floats:
    """Each range (n,) the median of the window around it; at the ends of what of the window there is twice."""
    if window == 1:
        return ranges
    fenced = np.pad(ranges, window // 2, mode="reflect")
    filtered: Floats = np.median(np.lib.stride_tricks.sliding_window_view(fenced, window), axis=1)
    return filtered


def clusters(ranges: Floats, bearings: Floats, gap_m: float) -> list[Floats]:
    """The points (n, 2) of a scan, cut where two beside each other are further apart than a gap."""
    hit = np.isfinite(ranges)
    points, far = points_of(ranges, bearings), ranges[hit]
    if not len(points):
        return []
    apart = np.hypot(*np.diff(points, axis=0).T)
    beams_apart = np.maximum(far[1:], far[:-1]) * (bearings[1] - bearings[0])
    return np.split(points, np.flatnonzero(apart > np.maximum(gap_m, 3 * beams_apart)) + 1)


def _at(away: float, bearing: float) -> tuple[float, float]:
    return float(away * math.cos(bearing)), float(away * math.sin(bearing))
