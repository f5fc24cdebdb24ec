"""Corners of a path rounded by arcs of one radius, as cubic Bezier segments ([market-paper], equation (4)).

A corner turns by an angle; its inner side is where it turns to. The middle arc lies around a centre on the line that
halves the corner. It touches both straight pieces, or runs wider: then an arc to the other side leads from each piece
to it, and at the widest it passes through the corner itself. A path around an obstacle touches the obstacle at its
corners, so that there only the widest is free.

With the radius R, the angle theta, the centre's distances c from the corner and q = c cos(theta / 2) from the pieces:
R <= c <= R / cos(theta / 2); each outer arc turns by alpha, cos(alpha) = (R + q) / (2 R); and the curve leaves a piece
at c sin(theta / 2) + sqrt(4 R^2 - (R + q)^2) from the corner.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from muster.mission.values.arrays import Floats

_PIECE = math.pi / 6
"""The largest angle of one segment: its curvature differs from its arc's by less than 1e-4."""
_WIDTHS = (1.0, 0.75, 0.5, 0.25, 0.0)
"""Where the centre is tried, from the arc that touches both pieces (1) to the one through the corner (0)."""
_STRAIGHT = 1e-9
_REVERSAL = 1e-3
"""Radians: a turn of less needs no arc; one so near to a half turn has no inner side."""


@dataclass(frozen=True, eq=False)
class Corner:
    """A corner of a path, in the plane or in space.

    Parameters
    ----------
    point
        (d,) metres in the map frame.
    along, inward
        (d,) unit vectors: of the piece that arrives, and square to it, to the inner side.
    angle
        radians by which the path turns, above 0.
    """

    point: Floats
    along: Floats
    inward: Floats
    angle: float

    @classmethod
    def between(cls, before: Floats, point: Floats, after: Floats) -> Corner | None:
        """The corner of two straight pieces, each of some length; None where they go on straight, or right back."""
        along, leaving = _unit(point - before), _unit(after - point)
        aside = leaving - (leaving @ along) * along
        size = float(np.linalg.norm(aside))
        angle = math.atan2(size, float(leaving @ along))
        if angle < _STRAIGHT or angle > math.pi - _REVERSAL:
            return None
        return cls(point, along, aside / size, angle)

    def rounded(self, radius_m: float, *, through: bool) -> Iterator[tuple[float, Floats]]:
        """Segments (k, 4, d) instead of the corner, and the length of each piece that they replace; shortest first.

        Parameters
        ----------
        through
            whether the curve has to pass through the corner.
        """
        for width in (0.0,) if through else _WIDTHS:
            length, outer = self._extent(radius_m, width)
            inner = self.angle / 2 + outer
            yield length, self._segments(length, (-outer, inner, inner, -outer), radius_m)

    def reach_m(self, radius_m: float) -> float:
        """The length of each piece that the widest arcs replace."""
        return self._extent(radius_m, 0.0)[0]

    def _extent(self, radius_m: float, width: float) -> tuple[float, float]:
        """Metres from the corner to where the curve leaves a piece, and the angle of the outer arcs."""
        half = self.angle / 2
        centre = radius_m * (1.0 + width * (1.0 / math.cos(half) - 1.0))
        apart = radius_m + min(radius_m, centre * math.cos(half))
        length = centre * math.sin(half) + math.sqrt(max(0.0, 4 * radius_m**2 - apart**2))
        return length, math.acos(min(1.0, apart / (2 * radius_m)))

    def _segments(self, length: float, turns: tuple[float, ...], radius_m: float) -> Floats:
        """Arcs of these turns, left above 0, from the place at `length` before the corner."""
        place, heading = np.array([-length, 0.0]), 0.0
        found: list[Floats] = []
        for number, turn in enumerate(turns):
            if number == 2 and np.linalg.norm(place) < _STRAIGHT:
                place = found[-1][3] = np.zeros(2)  # the corner itself
            count = math.ceil(abs(turn) / _PIECE - 1e-9) if abs(turn) > _STRAIGHT else 0
            for _ in range(count):
                segment = _arc(place, heading, turn / count, radius_m)
                found.append(segment)
                place, heading = segment[3], heading + turn / count
        return np.asarray(self.point + np.array(found) @ np.stack([self.along, self.inward]))


def _arc(start: Floats, heading: float, turn: float, radius_m: float) -> Floats:
    """P_0 to P_3 (4, 2) of the cubic for an arc."""
    handle = 4 / 3 * math.tan(abs(turn) / 4) * radius_m
    middle, chord = heading + turn / 2, 2 * radius_m * math.sin(abs(turn) / 2)
    end = start + chord * np.array([math.cos(middle), math.sin(middle)])
    leaving = np.array([math.cos(heading), math.sin(heading)])
    arriving = np.array([math.cos(heading + turn), math.sin(heading + turn)])
    return np.stack([start, start + handle * leaving, end - handle * arriving, end])


def _unit(vector: Floats) -> Floats:
    return np.asarray(vector / np.linalg.norm(vector))
