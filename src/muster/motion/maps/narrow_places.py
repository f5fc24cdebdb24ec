"""Where a space is too narrow for any body: it touches itself in a point, or is no wider than rounding.

A body needs room, so nothing passes there. A small square is cut out of a region at each such place, and prisms that
touch are joined by small ones, so that whoever looks at the space, in whatever arithmetic, finds it closed.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from itertools import combinations, pairwise
from typing import TYPE_CHECKING, TypeGuard

import numpy as np

from muster.motion.free_space import Prism
from muster.motion.grid import Floats, Indices

if TYPE_CHECKING:
    import shapely
    from shapely.geometry.base import BaseGeometry

ROOM = 1e-7
"""Of a region's extent: what is narrower is closed."""


def without_pinches(region: BaseGeometry) -> shapely.Polygon | shapely.MultiPolygon:
    """The parts of a region that have room, apart where they only touched."""
    import shapely

    west, south, east, north = region.bounds
    room = ROOM * max(east - west, north - south)
    places = _pinches(region, room)
    if len(places):
        x, y = places.T
        region = shapely.difference(region, shapely.union_all(shapely.box(x - room, y - room, x + room, y + room)))
    parts = [part for part in shapely.get_parts(region) if _is_roomy(part, room)]
    return parts[0] if len(parts) == 1 else shapely.MultiPolygon(parts)


def necks(region: BaseGeometry, prisms: Sequence[Prism]) -> tuple[Prism, ...]:
    """Prisms that close what is too narrow between prisms, and between them and the border of their region."""
    import shapely

    west, south, east, north = region.bounds
    extent = max(east - west, north - south)
    room = ROOM * extent
    around = shapely.box(west - extent, south - extent, east + extent, north + extent)
    outside = shapely.difference(around, region)
    blocks = [*((prism.polygon, prism.floor_m, prism.ceiling_m) for prism in prisms), (outside, -math.inf, math.inf)]
    found: list[Prism] = []
    for (one, low, high), (other, bottom, top) in combinations(blocks, 2):
        floor, ceiling = max(low, bottom) - room, min(high, top) + room
        if ceiling > floor and shapely.dwithin(one, other, room):
            shape = _between(one, other, room, beside=ceiling - floor > 4 * room)
            found += [Prism(part, floor, ceiling) for part in shapely.get_parts(shape) if _is_near(part, region)]
    return tuple(found)


def _between(one: BaseGeometry, other: BaseGeometry, room: float, *, beside: bool) -> BaseGeometry:
    """What is near to both of two shapes; beside each other only where they do not share an inside."""
    near = one.buffer(room, join_style="mitre").intersection(other.buffer(room, join_style="mitre"))
    if not beside:
        return near
    inside = one.intersection(other).buffer(-room, join_style="mitre")
    return near.difference(inside.buffer(4 * room, join_style="mitre"))


def _pinches(region: BaseGeometry, room: float) -> Floats:
    """The corners (n, 2) of a region that are nearer than `room` to a side which neither begins nor ends there."""
    import shapely

    corners, ends, before, after = _sides(region)
    sides = np.asarray(shapely.linestrings(np.stack([corners, ends], axis=1)))
    near, side = shapely.STRtree(sides).query(shapely.points(corners), predicate="dwithin", distance=room)
    other = (side != before[near]) & (side != after[near])
    return np.asarray(np.unique(corners[near[other]], axis=0))


def _sides(region: BaseGeometry) -> tuple[Floats, Floats, Indices, Indices]:
    """Where sides begin and end, (n, 2) each; and for each beginning the numbers of the sides before and after it."""
    import shapely

    rings = [shapely.get_coordinates(ring)[:-1] for ring in shapely.get_rings(shapely.get_parts(region))]
    corners = np.concatenate(rings)
    ends = np.concatenate([np.roll(ring, -1, axis=0) for ring in rings])
    first = np.cumsum([0] + [len(ring) for ring in rings])
    number = np.arange(len(corners), dtype=np.int64)
    before = np.concatenate([np.roll(number[a:b], 1) for a, b in pairwise(first)])
    return corners, ends, before, number


def _is_near(part: BaseGeometry, region: BaseGeometry) -> TypeGuard[shapely.Polygon]:
    """Whether a part of a shape is a polygon that a region meets."""
    import shapely

    return isinstance(part, shapely.Polygon) and part.area > 0 and bool(shapely.intersects(region, part))


def _is_roomy(part: BaseGeometry, room: float) -> TypeGuard[shapely.Polygon]:
    """Whether a part of a region is a polygon in which there is a place with some room around it."""
    import shapely

    return isinstance(part, shapely.Polygon) and not shapely.buffer(part, -room, join_style="mitre").is_empty
