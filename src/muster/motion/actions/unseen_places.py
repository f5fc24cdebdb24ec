"""What a raster search leaves unseen: its lanes and a camera's footprint against a dense grid of the square."""

from __future__ import annotations

import math
from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from muster.mission.model import Robot, Task
from muster.motion.actions.action import TaskMotion, given
from muster.motion.actions.footprint import Footprint, footprint_of
from muster.motion.actions.raster_search import RasterSearch, scan_width
from muster.motion.actions.registry import plan
from muster.motion.grid import Floats
from muster.motion.port import Waypoint

_POINTS, _BETWEEN = 41, 60
"""Of the grid to each side; and places between lanes that are looked at besides, at most."""
_EDGE_M = 1e-6
"""By so much a place may be outside what is seen: rounding."""


@dataclass(frozen=True)
class Unseen:
    """A raster search that a robot would carry out without seeing the whole square.

    Parameters
    ----------
    task, robot
        their ids.
    spacing_m
        as the mission has it.
    width_m
        of the camera's footprint across the lanes.
    expected_m
        w_s of (4.31): the distance of lanes that follows from the camera, at most.
    share
        of the square that is not seen, about.
    never_seen
        whether no robot that may do the task sees all of it.
    """

    task: str
    robot: str
    spacing_m: float
    width_m: float
    expected_m: float
    share: float
    never_seen: bool = False

    @property
    def expected(self) -> str:
        """What was expected in place of the spacing."""
        return f"no spacing_m: lanes follow from the camera then, {self.expected_m:.2f} m apart or less"

    @property
    def detail(self) -> str:
        """What is wrong, in words."""
        share = max(1, round(100 * self.share))
        return (
            f"{self.robot} sees {self.width_m:.2f} m across its lanes and leaves about {share} % of the square unseen"
        )


def unseen(task: Task, robot: Robot) -> Unseen | None:
    """What a robot leaves unseen in a task; None where it sees all, has no camera, or the task is no raster search."""
    if task.action is None or task.action.name != RasterSearch.name or task.action.spacing_m is None:
        return None  # without a spacing lanes follow from the footprint
    if robot.camera is None:
        return None
    side, height, spacing = given(task, "side_m", "height_m", "spacing_m")
    seen_from, motion = footprint_of(robot.camera, height), plan(task, robot)
    if not isinstance(seen_from, Footprint) or not isinstance(motion, TaskMotion):
        return None
    places = _places(task, side, motion)
    missed = ~seen(motion.waypoints, seen_from, places)
    if not missed.any():
        return None
    return Unseen(task.id, robot.id, spacing, seen_from.width_m, scan_width(task, seen_from), float(missed.mean()))


def seen(waypoints: tuple[Waypoint, ...], footprint: Footprint, places: Floats) -> np.ndarray:
    """Which of the places (n, 2) a camera sees on the way; between lanes, where a robot turns, nothing counts."""
    found = np.zeros(len(places), dtype=bool)
    for start, end in pairwise(waypoints):
        begin, way = np.array(start.position[:2]), np.subtract(end.position, start.position)[:2]
        length = float(np.linalg.norm(way))
        if end.heading is None:
            found |= _distance(places, begin, way, length) <= footprint.around_m + _EDGE_M
        elif start.heading == end.heading:
            ahead = np.array([math.cos(end.heading), math.sin(end.heading)])
            if abs(way @ ahead - length) <= _EDGE_M:
                found |= _passed(places - begin, ahead, length, footprint)
    return found


def _passed(places: Floats, ahead: Floats, length: float, footprint: Footprint) -> np.ndarray:
    """Which places, from the beginning of a lane, are between near edge and middle row somewhere on the lane."""
    along, left = places @ ahead, places @ np.array([-ahead[1], ahead[0]]) - footprint.left_m
    nearest = footprint.nearest_m(np.maximum(0.0, np.abs(left) - _EDGE_M))
    return np.asarray((along >= nearest - _EDGE_M) & (along <= length + footprint.middle_m + _EDGE_M))


def _distance(places: Floats, begin: Floats, way: Floats, length: float) -> Floats:
    share = np.clip((places - begin) @ way / max(length, 1e-12) ** 2, 0.0, 1.0)
    apart: Floats = np.linalg.norm(places - begin - share[:, None] * way, axis=1)
    return apart


def _places(task: Task, side: float, motion: TaskMotion) -> Floats:
    """A grid over the square, and what lies midway between lanes."""
    x, y = task.position[:2]
    even = np.linspace(-side / 2, side / 2, _POINTS)
    lanes = np.unique([point[1] - y for point in motion.points])
    between = (lanes[1:] + lanes[:-1]) / 2
    between = between[np.abs(between) <= side / 2]
    between = between[:: max(1, -(-len(between) // _BETWEEN))]
    norths, easts = np.meshgrid(np.concatenate([even, between]), even)
    return np.column_stack([x + easts.ravel(), y + norths.ravel()])
