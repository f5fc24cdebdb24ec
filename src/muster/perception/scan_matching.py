"""Lidar odometry: by how much a robot moved between two scans ([tcf-thesis], section 2.1.1).

Point-to-line iterative closest point ([censi2008]): each point of the new scan is compared with the line through the
nearest points of the old scan; the worst pairs are left out, and the pose that makes the distances smallest is found by
least squares, again and again.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from muster.mission.errors import ParameterError
from muster.motion.frames import wrapped
from muster.perception.kalman import Floats

LINE_POINTS = 9
"""Of the old scan, through which a line is laid: enough that errors of ranges do not turn it."""
LINE_M = 0.03
"""Root mean square distance of these points from the line, at most."""
LEAST_POINTS = 10
"""Of a scan; with fewer there is no match."""


@dataclass(frozen=True, kw_only=True)
class Matching:
    """How scans are matched.

    Parameters
    ----------
    rounds
        at most.
    farthest_m
        points farther from the old scan than this have no partner.
    kept_share
        share of the pairs, the nearest first, that count.
    settled_m
        a round that moves the scan by less is the last.

    Raises
    ------
    ParameterError
        if a number is out of range.
    """

    rounds: int = 30
    farthest_m: float = 0.5
    kept_share: float = 0.85
    settled_m: float = 1e-5

    def __post_init__(self) -> None:
        if not (self.rounds >= 1 and self.farthest_m > 0 and 0 < self.kept_share <= 1 and self.settled_m > 0):
            raise ParameterError(f"{self}; expected numbers above 0, kept_share at most 1")


@dataclass(frozen=True, eq=False)
class ScanMatch:
    """The result of a match.

    Parameters
    ----------
    pose
        (3,): where the new scan was taken in the frame of the old one: metres ahead, metres to the left, radians.
    rms_m
        root mean square distance of the pairs that counted.
    share
        of the points of the new scan that have a partner.
    """

    pose: Floats
    rms_m: float
    share: float


def matched(
    before: Floats, after: Floats, guess: npt.ArrayLike = (0.0, 0.0, 0.0), matching: Matching | None = None
) -> ScanMatch | None:
    """Match two scans; None where too few points agree, or they do not fix the pose, as in a corridor without ends.

    Parameters
    ----------
    before, after
        (n, 2) and (m, 2) metres, each in the robot's frame of its time, in order of bearing (`laser.points_of`).
    guess
        (3,): the pose by other odometry, as in `ScanMatch.pose`.

    Raises
    ------
    ParameterError
        for other shapes.
    """
    for name, points in (("before", before), ("after", after)):
        if points.ndim != 2 or points.shape[1] != 2:
            raise ParameterError(f"{name}: shape {points.shape}; expected (any, 2)")
    matching = matching or Matching()
    pose = np.array(guess, dtype=np.float64)
    if min(len(before), len(after)) < LEAST_POINTS:
        return None
    from scipy.spatial import cKDTree

    tree = cKDTree(before)
    normals = _normals(before, tree.query(before, k=LINE_POINTS)[1])
    for _ in range(matching.rounds):
        moved = _placed(after, pose)
        apart, partner = tree.query(moved, distance_upper_bound=matching.farthest_m)
        near = np.flatnonzero(np.isfinite(apart))
        near = near[np.argsort(apart[near])[: math.ceil(matching.kept_share * len(near))]]
        if len(near) < LEAST_POINTS:
            return None
        normal = normals[partner[near]]
        off = ((before[partner[near]] - moved[near]) * normal).sum(axis=1)
        step = _step(moved[near] - pose[:2], normal, off)
        if step is None:
            return None
        pose = np.array([*(pose[:2] + step[:2]), wrapped(pose[2] + step[2])])
        if np.abs(step).max() < matching.settled_m:
            break
    return ScanMatch(pose, float(np.sqrt((off**2).mean())), float(np.isfinite(apart).mean()))


def _normals(points: Floats, nearest: npt.NDArray[np.int64]) -> Floats:
    """(n, 2): at right angles to the line through the points that are nearest to each, (n, k) of them.

    (0, 0) where these are on no line, as in corners and where points are far apart: a distance to it counts nothing.
    """
    around = points[nearest] - points[nearest].mean(axis=1, keepdims=True)
    spreads, axes = np.linalg.eigh(around.transpose(0, 2, 1) @ around)
    on_a_line = spreads[:, 0] <= LINE_POINTS * LINE_M**2
    normals: Floats = axes[:, :, 0] * on_a_line[:, None]
    return normals


def _placed(points: Floats, pose: Floats) -> Floats:
    c, s = math.cos(pose[2]), math.sin(pose[2])
    placed: Floats = points @ np.array([[c, s], [-s, c]]) + pose[:2]
    return placed


def _step(arms: Floats, normals: Floats, off: Floats) -> Floats | None:
    """The change (3,) of a pose that brings points nearest to their lines; None where they leave it free.

    `arms` (n, 2) are the points seen from the pose.
    """
    turning = arms[:, 0] * normals[:, 1] - arms[:, 1] * normals[:, 0]
    system = np.column_stack([normals, turning])
    information = system.T @ system
    if np.linalg.eigvalsh(information[:2, :2])[0] < _LEAST_INFORMATION * len(off):
        return None
    step: Floats = np.linalg.solve(information, system.T @ off)
    return step


_LEAST_INFORMATION = 0.01
"""Mean square sine of the angle between the walls and the direction in which they say least."""
