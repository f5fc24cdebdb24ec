"""Paths that a robot with a turning radius can drive: Dubins words along the corners of the shortest path.

A robot passes near each corner of the shortest path that it does not skip, on its outside. Between two corners it takes
the shortest of the six words of [dubins1957] that is free. Which corners, with which headings, is the shortest choice
over some headings about the one that halves the turn. It is a path for forward driving with bounded curvature, and not
always the shortest such path; where none of these is free the answer is `not found`.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from muster.mission.errors import ParameterError
from muster.mission.values.arrays import Floats
from muster.mission.values.ranges import require_finite_positive
from muster.motion.free_space import Space
from muster.motion.path import NoPath, Path
from muster.motion.paths.dubins_words import Pose, words
from muster.motion.paths.on_grid import without_repetitions
from muster.motion.paths.path_finder import PathFinder
from muster.motion.paths.planner import Planner, in_plane

_OFFSETS = math.pi / 8 * np.array([0.0, 1.0, -1.0, 2.0, -2.0])
"""Of headings at a corner from the one that halves the turn."""
_CHORD = 0.05
"""Radians of an arc between two points of the path."""
_OUTSIDE = 0.01
"""By which share of the turning radius a corner is passed at a distance, so that the chords of an arc are clear."""
_AHEAD = 4
"""How many corners ahead a word may lead."""


@dataclass(frozen=True, kw_only=True)
class Parameters:
    """`turning_radius_m`; `start_heading_rad`, `goal_heading_rad`: from east, None for any."""

    turning_radius_m: float = 0.5
    start_heading_rad: float | None = None
    goal_heading_rad: float | None = None

    def __post_init__(self) -> None:
        require_finite_positive(turning_radius_m=self.turning_radius_m)
        for name in ("start_heading_rad", "goal_heading_rad"):
            value = getattr(self, name)
            if value is not None and not math.isfinite(value):
                raise ParameterError(f"{name}: {value}; expected a finite number")


@dataclass
class _Reached:
    length_m: float
    points: list[Floats]


def find_path(space: Space, start: Floats, goal: Floats, seed: int, params: Parameters) -> Path | NoPath:
    """A path of arcs and straight pieces; arcs are given by points on them, 0.05 rad apart at most."""
    finder = PathFinder(in_plane(space, "dubins"))
    found = finder.path(start, goal)
    if isinstance(found, NoPath) or len(found.points) < 2:
        return found
    radius = params.turning_radius_m
    poses = _poses(_apart(found.turns, radius / 2), params)
    reached: list[list[_Reached | None]] = [[_Reached(0.0, [start[np.newaxis]]) for _ in poses[0]]]
    for j in range(1, len(poses)):
        reached.append([_best(finder, poses, reached, j, pose, radius) for pose in poses[j]])
    ends = [end for end in reached[-1] if end is not None]
    if not ends:
        return NoPath("not found", f"no free curve with a turning radius of {radius:g} m along the shortest path")
    points = np.concatenate(min(ends, key=lambda end: end.length_m).points)
    points[-1] = goal
    return Path(without_repetitions(points))


def _best(
    finder: PathFinder, poses: list[list[Pose]], reached: list[list[_Reached | None]], j: int, pose: Pose, radius: float
) -> _Reached | None:
    """The shortest way to a pose at corner j from a pose at one of the corners before it."""
    before = [
        (way, path)
        for i in range(max(0, j - _AHEAD), j)
        for way, start in zip(reached[i], poses[i], strict=True)
        if way is not None
        for path in words(start, pose, radius)
    ]
    for way, path in sorted(before, key=lambda pair: pair[0].length_m + pair[1].length_m):
        points = path.poses(_CHORD * radius)[:, :2]
        if finder.clear(points):
            return _Reached(way.length_m + path.length_m, [*way.points, points[1:]])
    return None


def _poses(corners: Floats, params: Parameters) -> list[list[Pose]]:
    """The poses that are tried at each corner."""
    legs = np.diff(corners, axis=0)
    courses = np.arctan2(legs[:, 1], legs[:, 0])
    ends = (params.start_heading_rad, courses[0]), (params.goal_heading_rad, courses[-1])
    first, last = ([float(c + o) for o in _OFFSETS] if told is None else [told] for told, c in ends)
    found = [_headed(corners[0], first)]
    for corner, before, after in zip(corners[1:-1], courses[:-1], courses[1:], strict=True):
        turn = math.remainder(after - before, 2 * math.pi)
        halving = before + turn / 2
        out = -math.copysign(_OUTSIDE * params.turning_radius_m, turn)
        place = corner + out * np.array([-math.sin(halving), math.cos(halving)])
        found.append(_headed(place, [float(halving + offset) for offset in _OFFSETS]))
    return [*found, _headed(corners[-1], last)]


def _headed(place: Floats, headings: list[float]) -> list[Pose]:
    return [(float(place[0]), float(place[1]), heading) for heading in headings]


def _apart(corners: Floats, least_m: float) -> Floats:
    """Corners (k, 2) of which those nearer to each other than a length are one: the middle one."""
    groups: list[list[int]] = []
    for k in range(1, len(corners) - 1):
        if groups and np.linalg.norm(corners[k] - corners[groups[-1][0]]) < least_m:
            groups[-1].append(k)
        else:
            groups.append([k])
    return corners[[0, *(group[len(group) // 2] for group in groups), len(corners) - 1]]


DUBINS = Planner(
    name="dubins",
    summary="arcs and straight pieces for a robot with a turning radius, along the shortest path",
    parameters=Parameters,
    algorithm=find_path,
)
