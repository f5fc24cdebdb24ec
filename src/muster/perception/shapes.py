"""The shape that points on one side of an obstacle show: a line, a circle, a rectangle's corner, or none.

Rules for what [tcf-thesis], section 2.1.2, calls shape association. A circle bulges towards the scanner, which is at
the origin.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Literal

import numpy as np

from muster.perception.kalman import Floats

_SQUARE = math.radians(15)
"""By how much the corner of a rectangle may differ from a right angle."""


@dataclass(frozen=True)
class Shape:
    """A shape that was seen.

    Parameters
    ----------
    name
        what it is.
    position
        of its middle, metres in the frame of the points. Of a line the middle of what is seen.
    length_m, width_m
        the longer and the shorter side; of a circle both its diameter, of a line 0 wide.
    misfit_m
        root mean square of the points' distances from it; of `unknown`, whose box is around all points, 0.
    """

    name: Literal["circle", "line", "rectangle", "unknown"]
    position: tuple[float, float]
    length_m: float
    width_m: float
    misfit_m: float


def shape_of(points: Floats, tolerance_m: float) -> Shape:
    """The shape of points (n, 2): a line if they are one within the tolerance, else what fits best of the others."""
    if len(points) < 3:
        return _box(points)
    line = _line(points)
    if line.misfit_m <= tolerance_m:
        return line
    others = [shape for shape in (_circle(points), _corner(points)) if shape is not None]
    best = min(others, key=lambda shape: shape.misfit_m, default=None)
    return _box(points) if best is None or best.misfit_m > tolerance_m else best


def _axes(points: Floats) -> tuple[Floats, Floats]:
    """The mean (2,) of points and their principal axes as rows (2, 2), the longer first."""
    middle = points.mean(axis=0)
    near = points - middle
    return middle, np.linalg.eigh(near.T @ near)[1].T[::-1]


def _line(points: Floats) -> Shape:
    middle, axes = _axes(points)
    along, across = axes @ (points - middle).T
    centre = middle + (along.max() + along.min()) / 2 * axes[0]
    return Shape("line", _place(centre), float(np.ptp(along)), 0.0, _rms(across))


def _circle(points: Floats) -> Shape | None:
    """Least squares of x^2 + y^2 = 2 a x + 2 b y + c; None where the points do not bulge towards the origin."""
    middle = points.mean(axis=0)
    near = points - middle
    table = np.column_stack([2 * near, np.ones(len(near))])
    a, b, c = np.linalg.lstsq(table, (near**2).sum(axis=1), rcond=None)[0]
    radius = math.sqrt(max(a * a + b * b + c, 0.0))
    centre = middle + np.array([a, b])
    if np.hypot(*centre) <= np.hypot(*middle):
        return None
    off = np.hypot(*(points - centre).T) - radius
    return Shape("circle", _place(centre), 2 * radius, 2 * radius, _rms(off))


def _corner(points: Floats) -> Shape | None:
    """Two sides that meet where the points are furthest from the line between their ends; None without right angle."""
    way = points[-1] - points[0]
    length = float(np.hypot(*way))
    if length == 0:
        return None
    normal = np.array([-way[1], way[0]]) / length
    at = int(np.argmax(np.abs((points - points[0]) @ normal)))
    sides = points[: at + 1], points[at:]
    if min(map(len, sides)) < 3:
        return None
    (middle, axes), (other_middle, other_axes) = map(_axes, sides)
    if abs(math.asin(min(abs(float(axes[0] @ other_axes[0])), 1.0))) > _SQUARE:
        return None
    corner = _crossing(middle, axes[0], other_middle, other_axes[0])
    ends = points[0] - corner, points[-1] - corner
    width, length = sorted((float(np.hypot(*ends[0])), float(np.hypot(*ends[1]))))
    off = np.concatenate([(sides[0] - middle) @ axes[1], (sides[1] - other_middle) @ other_axes[1]])
    return Shape("rectangle", _place(corner + (ends[0] + ends[1]) / 2), length, width, _rms(off))


def _box(points: Floats) -> Shape:
    middle, axes = _axes(points)
    sides = axes @ (points - middle).T
    centre = middle + (sides.max(axis=1) + sides.min(axis=1)) / 2 @ axes
    length, width = np.ptp(sides, axis=1)
    return Shape("unknown", _place(centre), float(length), float(width), 0.0)


def _crossing(a: Floats, along_a: Floats, b: Floats, along_b: Floats) -> Floats:
    shares = np.linalg.solve(np.column_stack([along_a, -along_b]), b - a)
    corner: Floats = a + shares[0] * along_a
    return corner


def _place(point: Floats) -> tuple[float, float]:
    return float(point[0]), float(point[1])


def _rms(off: Floats) -> float:
    return float(np.sqrt(np.mean(off**2)))
