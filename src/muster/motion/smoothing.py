"""Smoothing: cubic Bezier splines through the points of a path ([market-paper], section 3.2.3, equation (4)).

Between two points of the path lies one segment. At a point both its segments have the direction that halves the turn,
so that the curve swings out of a corner and not into what the path goes around. Where a segment would leave the free
space its handles are halved, and in the end it is the straight piece of the path.
"""

from __future__ import annotations

import math
from collections.abc import Callable

import numpy as np
import numpy.typing as npt

from muster.mission.errors import ParameterError
from muster.motion.curve import Curve
from muster.motion.path import Path

Floats = npt.NDArray[np.float64]
Bools = npt.NDArray[np.bool_]

Clear = Callable[[Floats], bool]
"""Whether straight pieces through points (k, d) are free from end to end."""

_HALVINGS = 5
_REVERSAL = 1e-6  # a turn so near to a half one has no direction that halves it


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


def smoothed(path: Path, clear: Clear, *, handle: float = 1 / 3, tolerance_m: float = 1e-3) -> Curve:
    """A curve through all points of a path that stays where `clear` says.

    Parameters
    ----------
    path
        free itself: where it is not, it is followed all the same.
    handle
        length of a handle, as a share of its segment's; 1/3 draws a straight segment at an even rate.
    tolerance_m
        how far the chords that are tested may lie from the curve, in metres.

    Raises
    ------
    ParameterError
        if `handle` is not in (0, 1] or `tolerance_m` not above 0.
    """
    if not 0 < handle <= 1:
        raise ParameterError(f"handle: {handle}; expected a share above 0 and at most 1")
    if not tolerance_m > 0:
        raise ParameterError(f"tolerance_m: {tolerance_m}; expected metres above 0")
    points = _distinct(np.asarray(path.points, dtype=np.float64))
    if len(points) < 3:
        return Curve.along(Path(points))
    control = Curve.along(Path(points)).control.copy()
    leaving, arriving = _tangents(points)
    for k, chord in enumerate(np.linalg.norm(np.diff(points, axis=0), axis=1)):
        for halving in range(_HALVINGS + 1):
            reach = handle * chord * 0.5**halving
            segment = np.stack(
                [points[k], points[k] + reach * leaving[k], points[k + 1] - reach * arriving[k], points[k + 1]]
            )
            if clear(_chords(segment, tolerance_m)):
                control[k] = segment
                break
    return Curve(control)


def _distinct(points: Floats) -> Floats:
    """The points without those that repeat the one before."""
    new = np.append(True, np.any(np.diff(points, axis=0) != 0, axis=1))
    return np.asarray(points[new])


def _tangents(points: Floats) -> tuple[Floats, Floats]:
    """Unit vectors (k - 1, d): of each segment where it leaves its first point and where it arrives at its last."""
    pieces = np.diff(points, axis=0)
    units = pieces / np.linalg.norm(pieces, axis=1, keepdims=True)
    halves = units[:-1] + units[1:]
    length = np.linalg.norm(halves, axis=1, keepdims=True)
    turns = length > _REVERSAL
    halves = halves / np.where(turns, length, 1.0)
    leaving = np.concatenate([units[:1], np.where(turns, halves, units[1:])])
    arriving = np.concatenate([np.where(turns, halves, units[:-1]), units[-1:]])
    return leaving, arriving


def _chords(segment: Floats, tolerance_m: float) -> Floats:
    """Points (k, d) of a segment whose chords are nowhere further from it: |S''| h^2 / 8 bounds the distance."""
    bend = 6 * np.linalg.norm(np.diff(segment, n=2, axis=0), axis=1).max()
    count = max(1, math.ceil(math.sqrt(bend / (8 * tolerance_m))))
    parts = np.linspace(0.0, 1.0, count + 1)
    return Curve(segment[None]).points_at(np.zeros(count + 1, dtype=np.intp), parts)
