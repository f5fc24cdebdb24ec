"""A curve of cubic Bezier segments, by arc length ([market-paper], section 3.2.3, equation (4))."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from itertools import pairwise

import numpy as np
import numpy.typing as npt

from muster.mission.values.arrays import Bools, Floats
from muster.motion.path import Path

_PIECES = 32  # of a segment, in the table of arc lengths
_NODES, _WEIGHTS = np.polynomial.legendre.leggauss(5)


@dataclass(frozen=True, eq=False)
class Curve:
    """Cubic Bezier segments, each from where the one before ends. In the plane or in space.

    Parameters
    ----------
    control
        (m, 4, d): P_0 to P_3 of (4) for each of m >= 1 segments; metres in the map frame.
    """

    control: Floats

    @staticmethod
    def along(path: Path) -> Curve:
        """The straight pieces of a path as segments."""
        ends = path.points
        if len(ends) == 1:
            ends = np.repeat(ends, 2, axis=0)
        thirds = np.linspace(0.0, 1.0, 4)[None, :, None]
        return Curve(ends[:-1, None] + thirds * np.diff(ends, axis=0)[:, None])

    @property
    def length_m(self) -> float:
        return float(self._table[-1])

    @property
    def max_curvature(self) -> float:
        """The greatest curvature, 1/m, at 33 points of each segment; at corners between segments there is none."""
        which, parts = np.divmod(np.arange(len(self.control) * (_PIECES + 1)), _PIECES + 1)
        return float(np.abs(self.curvature_at(which, parts / _PIECES)).max())

    @cached_property
    def straight(self) -> Bools:
        """(m,) whether a segment is a straight line without a turn."""
        chord = self.control[:, 3] - self.control[:, 0]
        length = np.linalg.norm(chord, axis=1)
        unit = chord / np.where(length > 0, length, 1.0)[:, None]
        legs = np.diff(self.control, axis=1)
        along = np.einsum("mkd,md->mk", legs, unit)
        off = np.linalg.norm(legs - along[:, :, None] * unit[:, None], axis=2)
        rounding = 1e-12 * np.abs(self.control).max(axis=(1, 2))
        return np.asarray((off.max(axis=1) <= rounding) & (along.min(axis=1) >= -rounding))

    def points(self, s: npt.ArrayLike) -> Floats:
        """(n, d): the places at arc lengths `s` (n,) from the start, cut to the curve."""
        return self.points_at(*self.parameters(s))

    def tangents(self, s: npt.ArrayLike) -> Floats:
        """(n, d): unit vectors of the direction at arc lengths `s`."""
        return self.tangents_at(*self.parameters(s))

    def curvature(self, s: npt.ArrayLike) -> Floats:
        """(n,) 1/m at arc lengths `s`; in the plane positive to the left, in space never negative."""
        return self.curvature_at(*self.parameters(s))

    def sample(self, step_m: float) -> Floats:
        """(k, d): the ends of all segments and, evenly between them, points at most `step_m` of arc length apart."""
        which, parts = self.even_parameters(step_m)
        return self.points_at(which, parts)

    def even_parameters(self, step_m: float) -> tuple[npt.NDArray[np.intp], Floats]:
        """Segment and parameter of the places of `sample`."""
        ends = self._table[::_PIECES]
        spans = [
            np.linspace(a, b, max(1, int(np.ceil((b - a) / step_m - 1e-9))), endpoint=False) for a, b in pairwise(ends)
        ]
        which = np.repeat(np.arange(len(spans)), [len(span) for span in spans])
        parts = self.parts_at(which, np.concatenate(spans))
        return np.append(which, len(spans) - 1), np.append(parts, 1.0)

    def parameters(self, s: npt.ArrayLike) -> tuple[npt.NDArray[np.intp], Floats]:
        """Segment (n,) and parameter tau in [0, 1] (n,) at arc lengths from the start."""
        way = np.clip(np.atleast_1d(np.asarray(s, dtype=np.float64)), 0.0, self.length_m)
        ends = self._table[_PIECES::_PIECES]
        which = np.minimum(np.searchsorted(ends, way, side="right"), len(self.control) - 1)
        return which, self.parts_at(which, way)

    def points_at(self, which: npt.NDArray[np.intp], parts: Floats) -> Floats:
        """S of (4) at parameters of segments."""
        t = parts[:, None]
        p0, p1, p2, p3 = (self.control[which, k] for k in range(4))
        cubic, square = -p0 + 3 * p1 - 3 * p2 + p3, 3 * p0 - 6 * p1 + 3 * p2
        return np.asarray(cubic * t**3 + square * t**2 + (-3 * p0 + 3 * p1) * t + p0)

    def tangents_at(self, which: npt.NDArray[np.intp], parts: Floats) -> Floats:
        """Unit vectors (n, d); zero where the segment is a point."""
        speed = self._velocity(which, parts)
        length = np.linalg.norm(speed, axis=1, keepdims=True)
        return speed / np.where(length > 0, length, 1.0)

    def curvature_at(self, which: npt.NDArray[np.intp], parts: Floats) -> Floats:
        """Like `curvature`, at parameters of segments."""
        first, second = self._velocity(which, parts), self._second(which, parts)
        speed = np.linalg.norm(first, axis=1)
        safe = np.where(speed > 0, speed, 1.0) ** 3
        if first.shape[1] == 2:
            bend = first[:, 0] * second[:, 1] - first[:, 1] * second[:, 0]
        else:
            bend = np.linalg.norm(np.cross(first, second), axis=1)
        return np.where((speed > 0) & ~self.straight[which], bend / safe, 0.0)

    def turning_at(self, which: npt.NDArray[np.intp], parts: Floats) -> Floats:
        """(n,) rad/m: the rate at which the heading over ground turns along the path, positive to the left."""
        first, second = self._velocity(which, parts), self._second(which, parts)
        over_ground = np.sum(first[:, :2] ** 2, axis=1) * np.linalg.norm(first, axis=1)
        bend = first[:, 0] * second[:, 1] - first[:, 1] * second[:, 0]
        moving = (over_ground > 0) & ~self.straight[which]
        return np.where(moving, bend / np.where(moving, over_ground, 1.0), 0.0)

    def arc_lengths(self, which: npt.NDArray[np.intp], parts: Floats) -> Floats:
        """(n,) metres from the start at parameters of segments; the inverse of `parameters`."""
        piece = np.minimum((parts * _PIECES).astype(np.intp), _PIECES - 1)
        return self._table[which * _PIECES + piece] + self._way(which, piece / _PIECES, parts)

    @cached_property
    def _table(self) -> Floats:
        """(32 m + 1,) arc length at the ends of 32 pieces of each segment."""
        which, piece = np.divmod(np.arange(len(self.control) * _PIECES), _PIECES)
        lengths = self._way(which, piece / _PIECES, (piece + 1) / _PIECES)
        return np.concatenate([[0.0], np.cumsum(lengths)])

    def _way(self, which: npt.NDArray[np.intp], start: Floats, end: Floats) -> Floats:
        """The arc length between two parameters of one segment, by Gauss's quadrature."""
        half = (end - start) / 2
        at = (start + end)[:, None] / 2 + half[:, None] * _NODES
        many = np.repeat(which, len(_NODES))
        speeds = np.linalg.norm(self._velocity(many, at.ravel()), axis=1).reshape(at.shape)
        return np.asarray(half * (speeds @ _WEIGHTS))

    def parts_at(self, which: npt.NDArray[np.intp], way: Floats) -> Floats:
        """Parameters of segments at arc lengths: from the table, then by two steps of Newton's."""
        index = np.clip(np.searchsorted(self._table, way, side="right") - 1, which * _PIECES, (which + 1) * _PIECES - 1)
        span = self._table[index + 1] - self._table[index]
        low = (index - which * _PIECES) / _PIECES
        parts = low + (way - self._table[index]) / np.where(span > 0, span, 1.0) / _PIECES
        for _ in range(2):
            speed = np.linalg.norm(self._velocity(which, parts), axis=1)
            off = self._table[index] + self._way(which, low, parts) - way
            parts = np.clip(parts - off / np.where(speed > 0, speed, np.inf), low, low + 1 / _PIECES)
        return parts

    def _velocity(self, which: npt.NDArray[np.intp], parts: Floats) -> Floats:
        """dS/dtau."""
        t = parts[:, None]
        legs = np.diff(self.control[which], axis=1)
        return 3 * ((1 - t) ** 2 * legs[:, 0] + 2 * (1 - t) * t * legs[:, 1] + t**2 * legs[:, 2])

    def _second(self, which: npt.NDArray[np.intp], parts: Floats) -> Floats:
        t = parts[:, None]
        bends = np.diff(self.control[which], n=2, axis=1)
        return 6 * ((1 - t) * bends[:, 0] + t * bends[:, 1])
