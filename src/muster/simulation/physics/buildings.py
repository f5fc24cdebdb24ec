"""What is drawn of a map in the physics world: a low fence at its boundary, buildings with roofs, walls of an image.

What stops robots are other geoms, which are not drawn: a ground robot is stopped at any height by what a drone flies
over, and a zone that is closed to one kind alone is no building. Here things are as high as they are.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from itertools import pairwise
from typing import TYPE_CHECKING
from xml.etree import ElementTree as ET

import numpy as np

from muster.motion.grid import Floats
from muster.motion.world import World
from muster.simulation.physics.bodies import quaternion
from muster.simulation.physics.xml import add
from muster.simulation.walls import borders_of

if TYPE_CHECKING:
    import shapely

FENCE_M, WALL_M, BUILDING_M = 0.1, 0.8, 2.5
"""Heights above the ground: of the boundary; of the walls of an image, which have none; of zones without a ceiling."""
THICKNESS_M = 0.04
WALLS_RGBA, ROOFS_RGBA = (0.62, 0.58, 0.53, 1.0), (0.72, 0.68, 0.63, 1.0)
Triangle = tuple[tuple[float, float, float], ...]
"""Three corners."""
_SHOWN = {"contype": 0, "conaffinity": 0}


def add_buildings(root: ET.Element, place: ET.Element, world: World | None, ground_m: float) -> None:
    """Put what is drawn of a map into the model."""
    if world is None:
        return
    if world.image is not None:
        for piece in borders_of(world.image):
            _wall(place, piece, ground_m, ground_m + WALL_M)
    if world.boundary is not None:
        ring = np.array(world.boundary.exterior.coords)[:, :2]
        for piece in np.hstack([ring[:-1], ring[1:]]):
            _wall(place, piece, ground_m, ground_m + FENCE_M)
    asset = ET.SubElement(root, "asset")
    for area in world.areas:
        if {"ground", "air"} <= set(area.zone.forbidden_to):
            low = max(area.floor_m, ground_m)
            high = area.ceiling_m if math.isfinite(area.ceiling_m) else low + BUILDING_M
            _building(asset, place, f"zone{area.number}", area.polygon, low, high)


def _wall(place: ET.Element, piece: Floats, low: float, high: float) -> None:
    x0, y0, x1, y1 = map(float, piece)
    length = math.hypot(x1 - x0, y1 - y0)
    if length == 0:
        return
    add(
        place,
        "geom",
        type="box",
        pos=((x0 + x1) / 2, (y0 + y1) / 2, (low + high) / 2),
        size=((length + THICKNESS_M) / 2, THICKNESS_M / 2, (high - low) / 2),
        quat=quaternion(math.atan2(y1 - y0, x1 - x0)),
        rgba=WALLS_RGBA,
        **_SHOWN,
    )


def _building(
    asset: ET.Element, place: ET.Element, name: str, polygon: shapely.Polygon, low: float, high: float
) -> None:
    """A prism: its sides, its roof, and what is under it."""
    if high <= low:
        return
    vertices = np.array([*_sides(polygon, low, high), *_lids(polygon, low, high)]).reshape(-1, 3)
    middle = vertices.mean(axis=0)
    add(
        asset,
        "mesh",
        name=name,
        vertex=tuple((vertices - middle).ravel()),
        face=" ".join(map(str, range(len(vertices)))),
        inertia="shell",
    )
    add(place, "geom", type="mesh", mesh=name, pos=tuple(middle), rgba=ROOFS_RGBA, **_SHOWN)


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
