"""Fly over a square in lanes: [tcf-thesis] equations (4.31)-(4.34).

The lanes run east and west, `spacing_m` apart, from the southern side of the square on. As in (4.32) the last has that
distance too, so that it lies on the northern side of the square, or less than a spacing beyond.
Who has a camera that looks ahead faces along each lane.
The cost is the length of the way; (4.35) only approximates it.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

from muster.mission.action_keys import RASTER_SEARCH, ActionKeys
from muster.mission.model import Robot, Task
from muster.motion.actions.action import Impossible, TaskMotion, along, given, raised

_STRAIGHT_DOWN = 89.0
"""Degrees of tilt from which a camera sees as much behind as ahead."""
_ROUNDING = 1e-9
"""Of a spacing: sides that are a whole number of spacings but for rounding have no lane more."""


@dataclass(frozen=True)
class RasterSearch:
    """Enters at the south-western corner, leaves from the end of the last lane."""

    name: str = "raster-search"
    keys: ActionKeys = RASTER_SEARCH

    def plan(self, task: Task, robot: Robot) -> TaskMotion | Impossible:
        side, height, spacing = given(task, "side_m", "height_m", "spacing_m")
        if robot.kind == "ground" and len(task.position) == 3:
            return Impossible(f"a ground robot cannot search from {height:g} m above the ground")
        x, y, z = raised(task.position, height)
        half = side / 2
        lanes = 1 + math.ceil(side / spacing - _ROUNDING)
        points = []
        for k in range(lanes):
            north = y - half + k * spacing
            west_to_east = [(x - half, north, z), (x + half, north, z)]
            points += west_to_east if k % 2 == 0 else west_to_east[::-1]
        return along(task, robot, points, headings=_ahead(robot, lanes))


def _ahead(robot: Robot, lanes: int) -> Sequence[float | None] | None:
    """The headings in which lanes are begun and ended, so that a camera that looks ahead sees what lies on them."""
    if robot.camera is None or robot.camera.tilt_deg >= _STRAIGHT_DOWN:
        return None
    return [math.pi * (k % 2) for k in range(lanes) for _ in range(2)]
