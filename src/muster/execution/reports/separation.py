"""Distances between routes in time, computed exactly: robots move straight between passages.

While neither robot of a pair changes its motion, the relative motion is straight. So the least distance has a closed
form, and no meeting is missed between samples.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from itertools import combinations

import numpy as np

from muster.execution.reports.itinerary import Itinerary
from muster.mission.values.arrays import Floats

_ROUNDING_M = 1e-9


@dataclass(frozen=True)
class Meeting:
    """Two robots that come too close: when, the least distance, and the distance required."""

    robots: tuple[str, str]
    time_s: float
    distance_m: float
    least_m: float

    def __str__(self) -> str:
        first, second = self.robots
        apart = f"{self.distance_m:.2f} m apart at {self.time_s:.1f} s"
        return f"{first} and {second}: {apart} of the schedule; expected at least {self.least_m:.2f} m"


def meetings(team: Sequence[Itinerary], clearance_m: float = 0.0) -> tuple[Meeting, ...]:
    """The pairs whose centres come nearer than the sum of their radii, and so many metres more, while one moves."""
    return tuple(found for pair in combinations(team, 2) for found in _meeting(*pair, clearance_m))


def _meeting(a: Itinerary, b: Itinerary, clearance_m: float) -> Iterator[Meeting]:
    least = a.robot.radius_m + b.robot.radius_m + clearance_m
    times = np.unique(np.concatenate([_times(a), _times(b)]))
    first, second = _positions(a, times), _positions(b, times)
    moving = (np.diff(first, axis=0) != 0).any(axis=1) | (np.diff(second, axis=0) != 0).any(axis=1)
    shares, distances = _closest(second - first)
    if not moving.any():
        return
    k = int(np.argmin(np.where(moving, distances, np.inf)))
    if distances[k] < least - _ROUNDING_M:
        time = times[k] + shares[k] * (times[k + 1] - times[k])
        yield Meeting((a.robot.id, b.robot.id), float(time), float(distances[k]), least)


def _times(itinerary: Itinerary) -> Floats:
    return np.array([time for p in itinerary.passages for time in (p.arrives_s, p.leaves_s)])


def _positions(itinerary: Itinerary, times: Floats) -> Floats:
    """(n, 3) metres: where the robot is at each time; before its first passage and after its last it stands still."""
    points = np.repeat(np.array([p.place for p in itinerary.passages]), 2, axis=0)
    known = _times(itinerary)
    return np.stack([np.interp(times, known, points[:, axis]) for axis in range(3)], axis=1)


def _closest(apart: Floats) -> tuple[Floats, Floats]:
    """For each piece between rows of (n, 3) relative positions: the share of the least distance, and that distance."""
    start, motion = apart[:-1], np.diff(apart, axis=0)
    square = (motion**2).sum(axis=1)
    share = np.clip(-(start * motion).sum(axis=1) / np.where(square == 0, 1.0, square), 0.0, 1.0)
    return share, np.linalg.norm(start + share[:, None] * motion, axis=1)
