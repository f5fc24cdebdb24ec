"""The corners of a path while they are rounded, one radius after the other.

Corners that turn to the same side and lie nearer to each other than their arcs need are rounded as one: the curve
leaves the piece before the first and meets the piece after the last, as if both went on to where they cross.
"""

from __future__ import annotations

from collections.abc import Callable, Generator, Iterator
from dataclasses import dataclass

import numpy as np

from muster.mission.values.arrays import Floats
from muster.motion.corners import Corner
from muster.motion.curve import Curve
from muster.motion.path import Path

_SPARE = 1e-9
"""Metres: what remains of a piece may be so much shorter than nothing."""
_MEET = 1e-6
"""Metres between two lines in space that cross."""
_MOST_TURN = 2.6
"""Radians by which corners that are rounded as one turn in all: beyond, where the pieces cross is far away."""
_MOST_CORNERS = 40


@dataclass(frozen=True, eq=False)
class _Turn:
    """Corners `first` to `last` as one, and by how much the pieces around them go on to where they cross."""

    first: int
    last: int
    corner: Corner
    beyond: tuple[float, float]


class Rounding:
    """What is left of the straight pieces of a path, and the arcs that replace its corners.

    Parameters
    ----------
    points
        (k, d) metres, no point the same as the next.
    are_free, clear
        whether segments (m, 4, d), and straight pieces through points, are free.
    kept
        numbers of points through which the curve has to pass.
    """

    def __init__(
        self,
        points: Floats,
        are_free: Callable[[Floats], bool],
        clear: Callable[[Floats], bool],
        kept: frozenset[int],
    ) -> None:
        self._points = points
        self._are_free, self._clear = are_free, clear
        self._kept = kept
        self._left = np.linalg.norm(np.diff(points, axis=0), axis=1)
        self._arcs: dict[int, tuple[int, Floats]] = {}
        self._corners = {k: Corner.between(*points[k - 1 : k + 2]) for k in range(1, len(points) - 1)}
        self.sharp = [k for k, corner in self._corners.items() if corner is not None or self._goes_back(k)]
        """The numbers of the points that are corners so far."""

    def round(self, radius_m: float) -> None:
        """Round what can be rounded by a radius: near corners as one, then gentle ones first, which need the least."""
        for run in self._runs(radius_m):
            self._round_as_one(run, radius_m)
        for k in sorted(self.sharp, key=self._angle):
            if (corner := self._corners[k]) is not None:
                self._try(_Turn(k, k, corner, (0.0, 0.0)), radius_m)

    def control(self) -> tuple[Floats, tuple[int, ...]]:
        """The segments (m, 4, d), straight pieces and arcs in place of corners; and how many come before each point.

        A point that the curve does not pass through counts as in the middle of the arcs that replace it.
        """
        found: list[Floats] = []
        before, count = [0], 0
        place, k = self._points[0], 1
        while k < len(self._points):
            last, arcs = self._arcs.get(k, (k, self._points[k][None, None]))
            if np.linalg.norm(arcs[0, 0] - place) > _SPARE:
                found.append(Curve.along(Path(np.stack([place, arcs[0, 0]]))).control)
                count += 1
            rounded = arcs.shape[1] == 4
            before += [count + (len(arcs) // 2 if rounded else 0)] * (last + 1 - k)
            if rounded:
                found.append(arcs)
                count += len(arcs)
            place, k = arcs[-1, -1], last + 1
        return np.concatenate(found), tuple(before)

    def _angle(self, k: int) -> float:
        corner = self._corners[k]
        return np.pi if corner is None else corner.angle

    def _goes_back(self, k: int) -> bool:
        before, after = self._points[k] - self._points[k - 1], self._points[k + 1] - self._points[k]
        return bool(before @ after < 0)

    def _runs(self, radius_m: float) -> Iterator[list[int]]:
        """Corners one after the other, none to be kept, each nearer to the next than their arcs need."""
        run: list[int] = []
        for k in self.sharp:
            corner = self._corners[k]
            if corner is None or k in self._kept:
                run = yield from _ended(run)
                continue
            if run and not self._are_near(run[-1], k, radius_m):
                run = yield from _ended(run)
            run.append(k)
        yield from _ended(run)

    def _are_near(self, k: int, then: int, radius_m: float) -> bool:
        one, other = self._corners[k], self._corners[then]
        assert one is not None
        assert other is not None
        same_side = bool(one.inward @ other.inward > 0)
        return then == k + 1 and same_side and one.reach_m(radius_m) + other.reach_m(radius_m) > self._left[k]

    def _round_as_one(self, run: list[int], radius_m: float) -> None:
        """As many corners at once as can be, from the first on."""
        start = 0
        while start < len(run) - 1:
            for end in range(min(len(run), start + _MOST_CORNERS) - 1, start, -1):
                turn = self._as_one(run[start], run[end])
                if turn is not None and self._try(turn, radius_m):
                    start = end
                    break
            start += 1

    def _as_one(self, first: int, last: int) -> _Turn | None:
        """Where the piece before the first and the one after the last cross, if they do beyond both."""
        p = self._points
        a, b = p[first], p[last]
        u, v = a - p[first - 1], p[last + 1] - b
        u, v = u / np.linalg.norm(u), v / np.linalg.norm(v)
        cosine = float(u @ v)
        if sum(map(self._angle, range(first, last + 1))) > _MOST_TURN or abs(cosine) > 1 - 1e-9:
            return None
        way = b - a  # a + s u = b - t v
        s, t = np.linalg.solve([[1.0, cosine], [cosine, 1.0]], [way @ u, way @ v])
        point = a + s * u
        if s < 0 or t < 0 or np.linalg.norm(point - (b - t * v)) > _MEET:
            return None
        corner = Corner.between(point - u, point, point + v)
        return None if corner is None else _Turn(first, last, corner, (float(s), float(t)))

    def _try(self, turn: _Turn, radius_m: float) -> bool:
        """Round a turn if its arcs fit between those around, and are free."""
        pieces, beyond = [turn.first - 1, turn.last], np.array(turn.beyond)
        through = turn.first == turn.last and turn.first in self._kept
        for length, segments in turn.corner.rounded(radius_m, through=through):
            taken = length - beyond
            if (taken > self._left[pieces] + _SPARE).any() or not self._is_free(turn, segments):
                continue
            self._left[pieces] -= taken
            self._arcs[turn.first] = turn.last, segments
            self.sharp = [k for k in self.sharp if not turn.first <= k <= turn.last]
            return True
        return False

    def _is_free(self, turn: _Turn, segments: Floats) -> bool:
        """Whether the arcs are, and where they begin and end beyond their pieces the ways there."""
        ends = (self._points[turn.first], segments[0, 0]), (segments[-1, 3], self._points[turn.last])
        return self._are_free(segments) and (turn.first == turn.last or all(self._clear(np.stack(end)) for end in ends))


def _ended(run: list[int]) -> Generator[list[int], None, list[int]]:
    """A run of more than one corner; what it returns is the next run, empty."""
    if len(run) > 1:
        yield run
    return []
