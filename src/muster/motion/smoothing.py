"""Smoothing: a path becomes a curve of cubic Bezier segments ([market-paper], section 3.2.3, equation (4)).

Straight shortcuts replace points of the path where they are free. Then each corner is rounded by arcs of a radius that
the robot can drive, where the free space and the length of the pieces allow it. Where they do not, the corner stays: a
robot that faces its way stops and turns there.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Collection, Sequence
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from muster.mission.errors import ParameterError
from muster.mission.values.arrays import Bools, Floats
from muster.motion.curve import Curve
from muster.motion.path import Path
from muster.motion.rounding import Rounding

Clear = Callable[[Floats], bool]
"""Whether straight pieces through points (k, d) are free from end to end."""


@dataclass(frozen=True, eq=False)
class Smoothed:
    """A smoothed path.

    Parameters
    ----------
    curve
        its curvature is at most 1 / radius, but for `corners`.
    corners
        (c, d) metres: the points at which no radius fitted.
    before
        how many segments come before each point of the path; empty where shortcuts were taken.
    """

    curve: Curve
    corners: Floats
    before: tuple[int, ...] = ()


def clear_by_points(free: Callable[[Floats], Bools], step_m: float) -> Clear:
    """Test points at most `step_m` apart with `free`, (n, d) to (n,); thinner obstacles may be missed."""
    if not step_m > 0:
        raise ParameterError(f"step_m: {step_m}; expected metres above 0")

    def clear(points: Floats) -> bool:
        pieces = np.diff(points, axis=0)
        counts = np.maximum(1, np.ceil(np.linalg.norm(pieces, axis=1) / step_m)).astype(np.intp)
        which = np.repeat(np.arange(len(pieces)), counts)
        share = (np.arange(len(which)) - np.repeat(np.cumsum(counts) - counts, counts)) / counts[which]
        tested = points[:-1][which] + share[:, None] * pieces[which]
        return bool(free(np.concatenate([tested, points[-1:]])).all())

    return clear


def clear_by_segments(free: Callable[[Floats, Floats], Bools]) -> Clear:
    """Test each straight piece with `free`, starts (n, d) and ends (n, d) to (n,)."""
    return lambda points: bool(free(points[:-1], points[1:]).all())


def smoothed(
    path: Path,
    clear: Clear,
    *,
    radii_m: Sequence[float],
    keep: Collection[int] | None = None,
    tolerance_m: float = 1e-3,
) -> Smoothed:
    """A curve along a path that stays where `clear` says, and turns no sharper than the least radius.

    Parameters
    ----------
    path
        free itself: where it is not, it is followed all the same.
    radii_m
        turning radii in the order in which they are tried at a corner, metres.
    keep
        the numbers of points through which the curve passes; it goes near all others. None: it may take shortcuts.
    tolerance_m
        how far the chords that are tested may lie from the curve, in metres.

    Raises
    ------
    ParameterError
        if there is no radius, one is not a finite number above 0, or `tolerance_m` is not above 0.
    """
    if not radii_m or not all(0 < radius < math.inf for radius in radii_m):
        raise ParameterError(f"radii_m: {list(radii_m)}; expected finite metres above 0")
    if not tolerance_m > 0:
        raise ParameterError(f"tolerance_m: {tolerance_m}; expected metres above 0")
    points, numbers = _distinct(np.asarray(path.points, dtype=np.float64))
    kept = frozenset(int(numbers[k]) for k in keep or ())
    if keep is None:
        points, numbers = shortened(Path(points).turns, clear), numbers[:0]
    if len(points) < 3:
        return Smoothed(Curve.along(Path(points)), points[:0], tuple(numbers.tolist()))
    rounding = Rounding(points, lambda segments: clear(_chords_of(segments, tolerance_m)), clear, kept)
    for radius in radii_m:
        rounding.round(radius)
    control, before = rounding.control()
    return Smoothed(Curve(control), points[rounding.sharp], tuple(before[k] for k in numbers))


def shortened(points: Floats, clear: Clear) -> Floats:
    """From each point straight to the farthest later one that can be reached freely."""
    kept, last = [0], len(points) - 1
    while kept[-1] < last:
        at = kept[-1]
        sights = (k for k in range(last, at + 1, -1) if clear(points[[at, k]]))
        kept.append(next(sights, at + 1))
    return np.asarray(points[kept])


def _distinct(points: Floats) -> tuple[Floats, npt.NDArray[np.intp]]:
    """The points without those that repeat the one before; and the number that each point has then."""
    new = np.append(True, np.any(np.diff(points, axis=0) != 0, axis=1))
    return np.asarray(points[new]), np.cumsum(new) - 1


def _chords_of(segments: Floats, tolerance_m: float) -> Floats:
    """The chords of segments, each from where the one before ends."""
    chords = [_chords(segment, tolerance_m) for segment in segments]
    return np.concatenate([chords[0], *(chord[1:] for chord in chords[1:])])


def _chords(segment: Floats, tolerance_m: float) -> Floats:
    """Points (k, d) of a segment whose chords are nowhere further from it: |S''| h^2 / 8 bounds the distance."""
    bend = 6 * np.linalg.norm(np.diff(segment, n=2, axis=0), axis=1).max()
    count = max(1, math.ceil(math.sqrt(bend / (8 * tolerance_m))))
    parts = np.linspace(0.0, 1.0, count + 1)
    return Curve(segment[None]).points_at(np.zeros(count + 1, dtype=np.intp), parts)
