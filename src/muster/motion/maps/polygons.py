"""Polygons of a map: checked, grown by a body's radius, shrunk by it.

Growing is exact along edges. Round corners become polygons that circumscribe the arc, so that no clearance is lost;
the way around one of them is longer than the arc by at most tan(h) / h - 1 < 0.1 %, with h half the angle of a side.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from typing import TYPE_CHECKING

import numpy as np

from muster.mission.areas.polygons import polygon_fault
from muster.mission.model import Point
from muster.mission.value_types import Fault, Path
from muster.motion.grid import Floats
from muster.motion.maps.narrow_places import without_pinches
from muster.motion.maps.occupancy_rules import FARTHEST_M

if TYPE_CHECKING:
    import shapely

    Region = shapely.Polygon | shapely.MultiPolygon

_SIDE = math.pi / 30  # angle of a corner's side: 15 sides a quarter turn, 0.092 % too long
_STRAIGHT = 1e-9  # m: a corner this near to the line past it only costs time


def read_polygon(corners: Sequence[Point], at: Path, faults: list[Fault]) -> shapely.Polygon | None:
    """The polygon with these corners; None where it is none, which is appended to `faults`."""
    import shapely

    wrong = polygon_fault(corners, FARTHEST_M)
    if wrong is not None:
        faults.append(Fault(at, *wrong))
        return None
    return shapely.Polygon(corners)


def grown(polygon: shapely.Polygon, radius_m: float) -> shapely.Polygon:
    """All points nearer than the radius to a polygon, and at convex corners a little more."""
    import shapely

    result = shapely.union_all([polygon, *_band(polygon, radius_m)])
    assert isinstance(result, shapely.Polygon)  # a union of connected parts that all meet the polygon
    return shapely.simplify(result, _STRAIGHT)


def free_region(boundary: shapely.Polygon, obstacles: Iterable[shapely.Polygon], radius_m: float) -> Region:
    """Where a centre may be: within a boundary, at least the radius from it and from all obstacles.

    A gap that is exactly as wide as the body is closed; where two obstacles touch, nothing passes between them.
    """
    import shapely

    west, south, east, north = boundary.bounds
    if 2 * radius_m > min(east - west, north - south):
        return shapely.MultiPolygon()
    taken = _band(boundary, radius_m)
    for obstacle in obstacles:
        taken += [obstacle, *_band(obstacle, radius_m)]
    left = shapely.difference(boundary, shapely.union_all(taken))
    return shapely.MultiPolygon() if left.is_empty else without_pinches(shapely.simplify(left, _STRAIGHT))


def _band(polygon: shapely.Polygon, radius_m: float) -> list[shapely.Polygon]:
    """All points nearer than the radius to a polygon's outline: a rectangle along each edge, a fan at each corner."""
    import shapely

    if radius_m <= 0:
        return []
    corners = np.asarray(polygon.exterior.coords)[:-1]
    steps = np.roll(corners, -1, axis=0) - corners
    lengths = np.hypot(*steps.T)
    corners, steps = corners[lengths > 0], steps[lengths > 0] / lengths[lengths > 0, None]
    following = np.roll(corners, -1, axis=0)
    aside = radius_m * np.column_stack([-steps[:, 1], steps[:, 0]])  # to the left of each edge
    sides = np.stack([corners + aside, following + aside, following - aside, corners - aside], axis=1)
    lap = 0.5 * min(radius_m, float(lengths[lengths > 0].min()))
    fans = [_fan(corners[k], steps[[k - 1, k]], aside[[k - 1, k]], radius_m, lap) for k in range(len(corners))]
    return [*map(shapely.Polygon, sides), *fans]


def _fan(corner: Floats, steps: Floats, aside: Floats, radius_m: float, lap: float) -> shapely.Polygon:
    """What the rectangles of two edges leave open at their corner, on the outer side of the turn.

    It overlaps both by the length `lap`: rounding would leave slits where they only met.
    """
    import shapely

    coming, going = steps
    turn = math.atan2(coming[0] * going[1] - coming[1] * going[0], float(coming @ going))
    outer = -1 if turn > 0 else 1  # a turn to the left opens a gap on the right
    first, last = corner + outer * aside
    count = max(1, math.ceil(abs(turn) / _SIDE))
    start = math.atan2(*(outer * aside[0])[::-1])
    angles = start + turn * (np.arange(count) + 0.5) / count
    tips = corner + radius_m / math.cos(turn / (2 * count)) * np.column_stack([np.cos(angles), np.sin(angles)])
    back, on = lap * coming, lap * going
    return shapely.Polygon([corner - back, first - back, first, *tips, last, last + on, corner + on])
