"""Dubins paths ([dubins1957]): the shortest between two poses for who drives forward with a turning radius.

Such a path has three pieces: turns to the left (L), to the right (R), and straight ones (S), in one of six words. The
formulas are those of [shkel2001] for L S L, L S R and R L R; the other three words are their mirror images.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from muster.mission.values.arrays import Floats

Pose = tuple[float, float, float]
"""x, y in metres and heading in radians from east."""
_Angles = tuple[float, float, float]

_ROUNDING = 1e-7
_TURN = {"L": 1.0, "S": 0.0, "R": -1.0}
_MIRRORED = str.maketrans("LR", "RL")


@dataclass(frozen=True)
class DubinsPath:
    """One word between two poses.

    Parameters
    ----------
    word
        three letters of L, S and R.
    lengths_m
        of its three pieces.
    """

    start: Pose
    radius_m: float
    word: str
    lengths_m: tuple[float, float, float]

    @property
    def length_m(self) -> float:
        return sum(self.lengths_m)

    @property
    def end(self) -> Pose:
        """The pose at its end."""
        x, y, heading = self.start
        for letter, length in zip(self.word, self.lengths_m, strict=True):
            x, y, heading = _driven((x, y, heading), _TURN[letter] / self.radius_m, length)
        return x, y, heading

    def after(self, length_m: float) -> Pose:
        """The pose at a length along it."""
        at = self.start
        for letter, length in zip(self.word, self.lengths_m, strict=True):
            at = _driven(at, _TURN[letter] / self.radius_m, min(length, length_m))
            length_m = max(0.0, length_m - length)
        return at

    def poses(self, step_m: float) -> Floats:
        """Poses (k, 3) along it at most a step apart, both ends and those between pieces among them."""
        found, at = [self.start], self.start
        for letter, length in zip(self.word, self.lengths_m, strict=True):
            count = max(1, math.ceil(length / step_m)) if _TURN[letter] else 1
            bend = _TURN[letter] / self.radius_m
            if length > 0:
                found += [_driven(at, bend, length * k / count) for k in range(1, count + 1)]
            at = found[-1]
        return np.array(found)


def words(start: Pose, end: Pose, radius_m: float) -> list[DubinsPath]:
    """The paths of all words that lead from one pose to another, the shortest first."""
    east, north = end[0] - start[0], end[1] - start[1]
    bearing, away = math.atan2(north, east), math.hypot(east, north) / radius_m
    found = [
        DubinsPath(start, radius_m, word, (t * radius_m, p * radius_m, q * radius_m))
        for word, (t, p, q) in _all(start[2] - bearing, end[2] - bearing, away)
    ]
    return sorted(found, key=lambda path: path.length_m)


def _all(a: float, b: float, d: float) -> Iterator[tuple[str, _Angles]]:
    for word, formula in (("LSL", _lsl), ("LSR", _lsr), ("RLR", _rlr)):
        for name, angles in ((word, formula(a, b, d)), (word.translate(_MIRRORED), formula(-a, -b, d))):
            if angles is not None:
                yield name, angles


def _lsl(a: float, b: float, d: float) -> _Angles | None:
    across, along = math.cos(b) - math.cos(a), d + math.sin(a) - math.sin(b)
    straight = math.hypot(across, along)
    if straight < _ROUNDING:  # both arcs are of one circle, and the course between them is but rounding
        return _turn(b - a), 0.0, 0.0
    course = math.atan2(across, along)
    return _turn(course - a), straight, _turn(b - course)


def _lsr(a: float, b: float, d: float) -> _Angles | None:
    across, along = -math.cos(a) - math.cos(b), d + math.sin(a) + math.sin(b)
    squared = across**2 + along**2 - 4
    if squared < -_ROUNDING:
        return None
    straight = math.sqrt(max(squared, 0.0))
    course = math.atan2(across, along) + math.atan2(2.0, straight)
    return _turn(course - a), straight, _turn(course - b)


def _rlr(a: float, b: float, d: float) -> _Angles | None:
    cosine = (6 - d * d + 2 * math.cos(a - b) + 2 * d * (math.sin(a) - math.sin(b))) / 8
    if abs(cosine) > 1:
        return None
    middle = 2 * math.pi - math.acos(cosine)
    course = math.atan2(math.cos(a) - math.cos(b), d - math.sin(a) + math.sin(b))
    first = _turn(a - course + middle / 2)
    return first, middle, _turn(a - b - first + middle)


def _turn(angle: float) -> float:
    """An angle from 0 to 2 pi; what is short of a full turn by rounding is none."""
    found = angle % (2 * math.pi)
    return 0.0 if 2 * math.pi - found < _ROUNDING else found


def _driven(pose: Pose, bend: float, length: float) -> Pose:
    """The pose after a length with a curvature, 1 / m, which is above 0 to the left."""
    x, y, heading = pose
    half = bend * length / 2
    chord = length * float(np.sinc(half / math.pi))
    return x + chord * math.cos(heading + half), y + chord * math.sin(heading + half), heading + 2 * half
