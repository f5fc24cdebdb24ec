"""What is drawn of a map in the physics world: a low fence at its boundary, buildings with roofs, walls of an image.

What stops robots are other geoms, which are not drawn: a ground robot is stopped at any height by what a drone flies
over, and a zone that is closed to one kind alone is no building. Here things are as high as they are; or, to be looked
at from above, low where they have no height of their own, with what is closed to one kind marked.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass
from itertools import pairwise
from typing import TYPE_CHECKING
from xml.etree import ElementTree as ET

import numpy as np

from muster.motion.grid import Bools, Grid
from muster.motion.map_world import Area, World
from muster_physics.bodies import quaternion
from muster_physics.xml import add

if TYPE_CHECKING:
    import shapely

Rgba = tuple[float, float, float, float]
"""Red, green, blue and how opaque: 0 to 1."""
Triangle = tuple[tuple[float, float, float], ...]
"""Three corners."""
WALL_RGBA: Rgba = (0.7, 0.71, 0.74, 1.0)
CLOSED_RGBA: Rgba = (0.85, 0.3, 0.3, 0.15)
_THICK_M, _FLAT_M = 0.04, 0.004
_SHOWN = {"contype": 0, "conaffinity": 0}


@dataclass(frozen=True)
class Heights:
    """How high is drawn what has no height of its own, metres above the ground.

    Parameters
    ----------
    fence_m, wall_m, building_m
        the boundary, walls of an image, zones without a ceiling.
    marked
        whether zones that are closed to ground robots alone are drawn like walls, and those closed to drones alone as
        a tint of the ground.
    """

    fence_m: float = 0.1
    wall_m: float = 0.8
    building_m: float = 2.5
    marked: bool = False

    @classmethod
    def low(cls, metres: float) -> Heights:
        """All alike, so that one sees over it."""
        return cls(metres, metres, metres, marked=True)


def add_buildings(root: ET.Element, place: ET.Element, world: World, ground_m: float, heights: Heights) -> None:
    """Put what is drawn of a map into the model."""
    if world.image is not None:
        for block in _blocks(world.image):
            _box(place, block, ground_m, heights.wall_m)
    if world.boundary is not None:
        for (x0, y0), (x1, y1) in pairwise(_corners(world.boundary)):
            length, yaw = math.hypot(x1 - x0, y1 - y0), math.atan2(y1 - y0, x1 - x0)
            _box(place, ((x0 + x1) / 2, (y0 + y1) / 2, length + _THICK_M, _THICK_M, yaw), ground_m, heights.fence_m)
    asset = ET.SubElement(root, "asset")
    for area in filter(world.is_closed, world.areas):
        closed_to = set(area.zone.forbidden_to)
        if closed_to == {"ground", "air"} or (closed_to == {"ground"} and heights.marked):
            low, high = _extent(area, world, ground_m, heights)
            _prism(asset, place, area, low, high, WALL_RGBA)
        elif heights.marked:
            _prism(asset, place, area, ground_m, ground_m + _FLAT_M, CLOSED_RGBA)


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


def _extent(area: Area, world: World, ground_m: float, heights: Heights) -> tuple[float, float]:
    """From where to where a zone reaches; in a mission in the plane heights do not count."""
    low = max(area.floor_m, ground_m)
    in_space = world.dimensions == 3 or not heights.marked
    return low, area.ceiling_m if in_space and math.isfinite(area.ceiling_m) else low + heights.building_m


def _blocks(grid: Grid) -> Iterator[tuple[float, float, float, float, float]]:
    """Of blocked cells: the middle of each rectangle, its length, width and yaw, in the map frame."""
    for left, right, low, high in rectangles(grid.blocked):
        x, y = grid.to_map(np.array([[(left + right) / 2, (low + high) / 2]]))[0].tolist()
        yield x, y, (right - left) * grid.resolution_m, (high - low) * grid.resolution_m, grid.origin[2]


def _box(place: ET.Element, block: tuple[float, float, float, float, float], ground_m: float, height_m: float) -> None:
    x, y, length, width, yaw = map(float, block)
    add(
        place,
        "geom",
        type="box",
        pos=(x, y, ground_m + height_m / 2),
        size=(length / 2, width / 2, height_m / 2),
        quat=quaternion(yaw),
        rgba=WALL_RGBA,
        **_SHOWN,
    )


def _prism(asset: ET.Element, place: ET.Element, area: Area, low: float, high: float, rgba: Rgba) -> None:
    """Its sides, its roof, and what is under it."""
    if high <= low:
        return
    vertices = np.array([*_sides(area.polygon, low, high), *_lids(area.polygon, low, high)]).reshape(-1, 3)
    middle = vertices.mean(axis=0)
    name = f"zone{area.number}"
    add(
        asset,
        "mesh",
        name=name,
        vertex=tuple((vertices - middle).ravel()),
        face=" ".join(map(str, range(len(vertices)))),
        inertia="shell",
    )
    add(place, "geom", type="mesh", mesh=name, pos=tuple(middle), rgba=rgba, **_SHOWN)


def _sides(polygon: shapely.Polygon, low: float, high: float) -> Iterator[Triangle]:
    """Seen from outside against the clock."""
    for (x0, y0), (x1, y1) in pairwise(_corners(polygon)):
        yield (x0, y0, low), (x1, y1, low), (x1, y1, high)
        yield (x0, y0, low), (x1, y1, high), (x0, y0, high)


def _lids(polygon: shapely.Polygon, low: float, high: float) -> Iterator[Triangle]:
    """The roof, seen from above, and the floor, seen from below."""
    import shapely

    for part in shapely.constrained_delaunay_triangles(polygon).geoms:
        assert isinstance(part, shapely.Polygon)
        a, b, c = _corners(part)[:3]
        yield (*a, high), (*b, high), (*c, high)
        yield (*c, low), (*b, low), (*a, low)


def _corners(polygon: shapely.Polygon) -> list[tuple[float, float]]:
    """Against the clock, the first again at the end."""
    ring = [(float(x), float(y)) for x, y, *_ in polygon.exterior.coords]
    return ring if polygon.exterior.is_ccw else ring[::-1]
