"""A laser scanner in the plane: ranges from a pose to walls and round things ([market-paper], section 4.3).

Bearings are from straight ahead, anticlockwise; beams go from right to left. Where a beam meets nothing within reach
its range is infinite, as in ROS (REP-117).
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from muster.mission.errors import ParameterError
from muster.perception.kalman import Floats

NO_WALLS = np.empty((0, 4))
NO_DISCS = np.empty((0, 3))
_SEAM = 1e-9
"""By which share a wall is longer than it says, so that no beam slips through where two walls join."""
_ALONG = 1e-12
"""Sine of the angle between a beam and a wall below which the wall is seen edge on, and so not at all."""


@dataclass(frozen=True, kw_only=True)
class Scanner:
    """A scanner; by default that of the paper's Khepera III: 240 degrees, 4 m, 0.36 degrees.

    Parameters
    ----------
    field_rad
        from the first beam to the last, at most; below a full turn.
    reach_m
        as far as it sees.
    step_rad
        between beams. One beam looks straight ahead, so the field is filled to both sides as far as it goes.
    range_m
        standard deviation of a range.
    stray_share
        share of beams that return anything from 0 to `reach_m`: what the median of the thesis is for.

    Raises
    ------
    ParameterError
        if a number is out of range.
    """

    field_rad: float = math.radians(240)
    reach_m: float = 4.0
    step_rad: float = math.radians(0.36)
    range_m: float = 0.0
    stray_share: float = 0.0

    def __post_init__(self) -> None:
        _require("field_rad", self.field_rad, 0 < self.field_rad < 2 * math.pi, "a number above 0 and below 2 pi")
        _require("step_rad", self.step_rad, 0 < self.step_rad <= self.field_rad, "a number above 0, at most field_rad")
        _require("reach_m", self.reach_m, 0 < self.reach_m < math.inf, "a finite number above 0")
        _require("range_m", self.range_m, 0 <= self.range_m < math.inf, "a finite number of at least 0")
        _require("stray_share", self.stray_share, 0 <= self.stray_share <= 1, "a number from 0 to 1")

    @property
    def bearings(self) -> Floats:
        """Bearings of the beams, (n,) radians, rising."""
        to_a_side = math.floor(self.field_rad / 2 / self.step_rad + 1e-9)
        return np.arange(-to_a_side, to_a_side + 1, dtype=np.float64) * self.step_rad

    def ranges(self, pose: tuple[float, float, float], walls: Floats = NO_WALLS, discs: Floats = NO_DISCS) -> Floats:
        """Ranges without errors: (n,) metres, inf beyond reach.

        Parameters
        ----------
        pose
            x, y in metres and heading in radians, map frame.
        walls
            (k, 4), the x, y of both ends of straight walls.
        discs
            (m, 3), x, y, radius of what is round: landmarks, other robots. From within one the far side is seen.

        Raises
        ------
        ParameterError
            for other shapes, or what is not finite.
        """
        x, y, heading = pose
        _require("pose", pose, all(map(math.isfinite, pose)), "three finite numbers")
        walls, discs = _table("walls", walls, 4), _table("discs", discs, 3)
        angles = heading + self.bearings
        beams = np.column_stack([np.cos(angles), np.sin(angles)])
        walls = walls - [x, y, x, y]
        met = np.minimum(_to_walls(beams, walls[_near(walls, self.reach_m)]), _to_discs(beams, discs - [x, y, 0.0]))
        return np.where(met <= self.reach_m, met, math.inf)

    def measured(self, ranges: Floats, random: np.random.Generator) -> Floats:
        """Exact ranges (n,) with this scanner's errors."""
        noisy = np.maximum(ranges + random.normal(0.0, self.range_m, ranges.shape), 0.0) if self.range_m else ranges
        noisy = np.where(noisy <= self.reach_m, noisy, math.inf)
        stray = random.random(ranges.shape) < self.stray_share
        return np.where(stray, random.uniform(0.0, self.reach_m, ranges.shape), noisy)


def require_scan(ranges: Floats, bearings: Floats) -> None:
    """Raise ParameterError unless ranges and bearings are those of one scan: (n,) each, n at least 2."""
    if ranges.ndim != 1 or ranges.shape != bearings.shape or len(ranges) < 2:
        raise ParameterError(f"ranges, bearings: shapes {ranges.shape}, {bearings.shape}; expected (n,) twice, n >= 2")


def points_of(ranges: Floats, bearings: Floats) -> Floats:
    """[tcf-thesis] (2.8): the points that were hit, (m, 2) in the scanner's frame; infinite ranges hit nothing."""
    hit = np.isfinite(ranges)
    return np.column_stack([ranges[hit] * np.cos(bearings[hit]), ranges[hit] * np.sin(bearings[hit])])


def faces_at(faces: Floats, height_m: float) -> Floats:
    """The walls (j, 4) at a height, from upright faces (k, 6): both ends' x, y, lowest and highest z."""
    return faces[(faces[:, 4] <= height_m) & (height_m <= faces[:, 5]), :4]


def _to_walls(beams: Floats, walls: Floats) -> Floats:
    """Along each beam (n, 2) from the origin to the first wall (k, 4): (n,).

    With a the wall's one end and w the way to the other, t d = a + s w gives t = a x w / d x w, s = a x d / d x w.
    A wall along a beam is not met: what rounding leaves of d x w says nothing.
    """
    if not len(walls):
        return np.full(len(beams), math.inf)
    ax, ay = walls[:, 0], walls[:, 1]
    wx, wy = walls[:, 2] - ax, walls[:, 3] - ay
    dx, dy = beams[:, :1], beams[:, 1:]
    with np.errstate(divide="ignore", invalid="ignore", over="ignore"):  # of walls along a beam
        across = dx * wy - dy * wx
        across = np.where(np.abs(across) > _ALONG * np.hypot(wx, wy), across, np.nan)
        along = (ax * wy - ay * wx) / across
        share = (ax * dy - ay * dx) / across
    met = (along >= 0) & (share >= -_SEAM) & (share <= 1 + _SEAM)
    first: Floats = np.where(met, along, math.inf).min(axis=1)
    return first


def _to_discs(beams: Floats, discs: Floats) -> Floats:
    """Along each beam (n, 2) from the origin to the first disc (m, 3): (n,)."""
    if not len(discs):
        return np.full(len(beams), math.inf)
    middle = beams @ discs[:, :2].T
    half = discs[:, 2] ** 2 - (discs[:, 0] ** 2 + discs[:, 1] ** 2 - middle**2)
    chord = np.sqrt(np.maximum(half, 0.0))
    near, far = middle - chord, middle + chord
    met = np.where(near >= 0, near, far)
    first: Floats = np.where((half >= 0) & (far >= 0), met, math.inf).min(axis=1)
    return first


def _near(walls: Floats, reach_m: float) -> Floats:
    """Which walls (k, 4) come within reach of the origin, as booleans (k,)."""
    one, way = walls[:, :2], walls[:, 2:] - walls[:, :2]
    square = (way**2).sum(axis=1)
    share = np.clip(-(one * way).sum(axis=1) / np.where(square > 0, square, 1.0), 0.0, 1.0)
    return np.asarray(np.hypot(*(one + share[:, None] * way).T) <= reach_m)


def _table(name: str, rows: Floats, columns: int) -> Floats:
    table = np.asarray(rows, dtype=np.float64)
    if table.ndim != 2 or table.shape[1] != columns:
        raise ParameterError(f"{name}: shape {table.shape}; expected (any, {columns})")
    if not np.isfinite(table).all():
        raise ParameterError(f"{name}: a number that is not finite; expected metres")
    return table


def _require(name: str, value: object, holds: bool, expected: str) -> None:
    if not holds:
        raise ParameterError(f"{name}: {value}; expected {expected}")


LIDAR = Scanner(field_rad=math.radians(359), reach_m=12.0, step_rad=math.radians(1.0))
"""A small lidar that looks all around, as robots have that build maps."""
