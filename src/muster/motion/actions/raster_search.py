"""Fly over a square in lanes: [tcf-thesis] equations (4.31)-(4.34).

The lanes run east and west. Without `spacing_m` they follow from the camera's footprint, so that the whole square is
seen: as many as strips of w_s = k w_c (4.31) need, k = 1 - `overlap`, all of one width, and the middle of the picture,
not the body, goes along the middle of each strip, from one side of the square to the other. (4.32) has a lane on either
side of the square instead, and the body above it, so that half a strip is outside and a camera that looks ahead misses
corners.

With `spacing_m` they are as printed: the first on the southern side, the others so far apart, the last on the northern
side or less than a spacing beyond it. Who has a camera that looks ahead faces along each lane.
The cost is the length of the way; (4.35) only approximates it.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

from muster.mission.action_keys import RASTER_SEARCH, ActionKeys
from muster.mission.model import Point, Robot, Task
from muster.motion.actions.action import Impossible, TaskMotion, along, given, raised
from muster.motion.actions.footprint import Footprint, footprint_of

OVERLAP = 0.1
"""Of neighbouring strips, as a share of what the camera sees; the thesis asks for k < 1 and prints no value."""
_STRAIGHT_DOWN = 89.0
"""Degrees of tilt from which a camera sees as much behind as ahead."""
_ROUNDING = 1e-9
"""Of a spacing: sides that are a whole number of spacings but for rounding have no lane more."""
_MOST_LANES = 10_000


@dataclass(frozen=True)
class RasterSearch:
    """Enters at the beginning of the southern lane, leaves from the end of the last one."""

    name: str = "raster-search"
    keys: ActionKeys = RASTER_SEARCH

    def plan(self, task: Task, robot: Robot) -> TaskMotion | Impossible:
        side, height, spacing = given(task, "side_m", "height_m", "spacing_m")
        if robot.kind == "ground" and len(task.position) == 3:
            return Impossible(f"a ground robot cannot search from {height:g} m above the ground")
        if spacing is not None:
            return _printed_lanes(task, robot, side, height, spacing)
        if robot.camera is None:
            return Impossible("it has no camera from which the distance of lanes follows; expected one, or spacing_m")
        seen = footprint_of(robot.camera, height)
        return seen if isinstance(seen, Impossible) else _lanes_of_footprint(task, robot, side, height, seen)


def scan_width(task: Task, seen: Footprint) -> float:
    """w_s of (4.31) for a camera, metres."""
    (overlap,) = given(task, "overlap")
    return (1 - (OVERLAP if overlap is None else overlap)) * seen.width_m


def _printed_lanes(task: Task, robot: Robot, side: float, height: float, spacing: float) -> TaskMotion:
    x, y, z = raised(task.position, height)
    half = side / 2
    lanes = 1 + math.ceil(side / spacing - _ROUNDING)
    points: list[Point] = []
    for k in range(lanes):
        north = y - half + k * spacing
        west_to_east = [(x - half, north, z), (x + half, north, z)]
        points += west_to_east if k % 2 == 0 else west_to_east[::-1]
    looks_ahead = robot.camera is not None and robot.camera.tilt_deg < _STRAIGHT_DOWN
    return along(task, robot, points, headings=_ahead(lanes) if looks_ahead else None)


def _lanes_of_footprint(
    task: Task, robot: Robot, side: float, height: float, seen: Footprint
) -> TaskMotion | Impossible:
    strips = side / scan_width(task, seen) - _ROUNDING
    if strips > _MOST_LANES:
        return Impossible(f"it would need {strips:.3g} lanes; expected at most {_MOST_LANES}: a greater height_m")
    lanes = max(1, math.ceil(strips))
    x, y, z = raised(task.position, height)
    points: list[Point] = []
    for k in range(lanes):
        middle, way = y - side / 2 + (k + 0.5) * side / lanes, 1 - 2 * (k % 2)  # way: 1 to the east, -1 to the west
        north = middle - way * seen.left_m
        points += [(x + way * (end * side / 2 - seen.middle_m), north, z) for end in (-1, 1)]
    return along(task, robot, points, headings=_ahead(lanes))


def _ahead(lanes: int) -> Sequence[float]:
    """The headings in which lanes are begun and ended, so that a camera that looks ahead sees what lies on them."""
    return [math.pi * (k % 2) for k in range(lanes) for _ in range(2)]
