"""What lies on top of walls, so that they look like the blocks that they go around; and no-fly zones on the ground."""

from __future__ import annotations

import math
from collections.abc import Iterator

import numpy as np

from muster.mission.model import Mission, Zone
from muster.motion.grid import Bools, Floats, Grid
from muster.motion.world import World
from muster.simulation.physics.marks import Mark, Rgba, plate, triangle
from muster.simulation.physics.tableau import WALL_RGBA

MOST_M = 0.5
_ABOVE_M, _SAME_M = 0.012, 1e-6
_FORBIDDEN_RGBA: Rgba = (0.85, 0.3, 0.3, 0.1)


class Walls:
    """How the walls of a mission are shown.

    Zones of a mission in space are as high as they are; all else is low, so that one sees over it.

    Parameters
    ----------
    low_m
        how low, above the ground, at most `MOST_M`.
    """

    def __init__(self, mission: Mission, low_m: float) -> None:
        self._low_m = min(low_m, MOST_M)
        stopped = mission.map is not None and mission.travel_rule == "map"
        self._image = World.of(mission).image if stopped else None
        self._zones = mission.map.zones if stopped and mission.map is not None else ()
        self._with_heights = self._image is None and mission.dimensions == 3

    def top(self, x: float, y: float) -> float:
        """The height to which a wall is shown that has its middle there."""
        return max((self._height(zone) for zone in self._zones if _is_side(zone, (x, y))), default=self._low_m)

    def lids(self, ground_m: float) -> list[Mark]:
        """What lies on top, and no-fly zones on the ground."""
        lids = [] if self._image is None else list(_of_cells(self._image, self._low_m + _ABOVE_M))
        for zone in self._zones:
            top, color = self._height(zone) + _ABOVE_M, WALL_RGBA
            if "ground" not in zone.forbidden_to:
                top, color = ground_m + _ABOVE_M / 4, _FORBIDDEN_RGBA
            for corners in triangles(np.array([corner[:2] for corner in zone.polygon], dtype=np.float64)):
                lids.append(triangle(np.column_stack([corners, np.full(3, top)]), color))
        return lids

    def _height(self, zone: Zone) -> float:
        return zone.ceiling_m if self._with_heights and zone.ceiling_m is not None else self._low_m


def rectangles(blocked: Bools) -> list[tuple[int, int, int, int]]:
    """Cut blocked cells into few rectangles: first and last column, first and last row, the last ones not within."""
    begun: dict[tuple[int, int], int] = {}
    found: list[tuple[int, int, int, int]] = []
    for row in range(len(blocked) + 1):
        cells = blocked[row] if row < len(blocked) else np.zeros(blocked.shape[1], dtype=bool)
        steps = np.diff(np.pad(cells.astype(np.int8), 1))
        runs = set(zip(np.flatnonzero(steps == 1).tolist(), np.flatnonzero(steps == -1).tolist(), strict=True))
        found += [(*run, begun.pop(run), row) for run in list(begun) if run not in runs]
        for run in runs:
            begun.setdefault(run, row)
    return found


def triangles(polygon: Floats) -> list[Floats]:
    """Cut a simple polygon (n, 2) into triangles (3, 2), counter-clockwise, by its ears (Meisters 1975)."""
    corners = [corner for k, corner in enumerate(polygon) if not np.array_equal(corner, polygon[k - 1])]
    if _area(np.array(corners)) < 0:
        corners.reverse()
    found: list[Floats] = []
    while len(corners) > 3:
        ear = next((k for k in range(len(corners)) if _is_ear(corners, k)), None)
        if ear is None:  # it crosses itself
            return found
        found.append(np.array([corners[ear - 1], corners[ear], corners[(ear + 1) % len(corners)]]))
        del corners[ear]
    return [*found, np.array(corners)]


def _of_cells(grid: Grid, top_m: float) -> Iterator[Mark]:
    for left, right, low, high in rectangles(grid.blocked):
        middle = grid.to_map(np.array([[(left + right) / 2, (low + high) / 2]]))[0]
        length, width = (right - left) * grid.resolution_m, (high - low) * grid.resolution_m
        yield plate(np.array([*middle, top_m]), length, width, grid.origin[2], WALL_RGBA)


def _is_side(zone: Zone, middle: tuple[float, float]) -> bool:
    """Whether this is the middle of one of its sides."""
    sides = zip(zone.polygon, (*zone.polygon[1:], zone.polygon[0]), strict=True)
    return any(math.dist(middle, ((a[0] + b[0]) / 2, (a[1] + b[1]) / 2)) < _SAME_M for a, b in sides)


def _area(corners: Floats) -> float:
    x, y = corners.T
    return float(x @ np.roll(y, -1) - y @ np.roll(x, -1)) / 2


def _is_ear(corners: list[Floats], k: int) -> bool:
    before, tip, after = corners[k - 1], corners[k], corners[(k + 1) % len(corners)]
    if _area(np.array([before, tip, after])) <= 0:
        return False
    others = [c for c in corners if c is not before and c is not tip and c is not after]
    return not any(_within(other, before, tip, after) for other in others)


def _within(place: Floats, *corners: Floats) -> bool:
    sides = zip(corners, (*corners[1:], corners[0]), strict=True)
    return all(_area(np.array([start, end, place])) >= 0 for start, end in sides)
