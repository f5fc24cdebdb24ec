"""The region that is to be seen, and the region in which a robot may move, turned so that lanes run along x."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from typing import TYPE_CHECKING, TypeAlias, cast

import numpy as np

from muster.mission.values.arrays import Floats

if TYPE_CHECKING:
    import shapely

Surface: TypeAlias = "shapely.Polygon | shapely.MultiPolygon"

Ring = tuple[tuple[float, ...], ...]

_ROUNDING = 1e-7
"""Of the size of an area."""
_OVER = 1e-3
"""Of the width of a lane: by so much a way may lie outside the border, so that slivers at its ends cost no lanes."""


@dataclass(frozen=True, eq=False)
class Region:
    """An area with holes.

    Parameters
    ----------
    seen
        all that is to be seen: the area without its holes.
    free
        where a robot may move: the same, or with the holes where these may be crossed.
    rounding_m
        by how much a way may lie in a hole, metres.
    over_m
        by how much it may lie outside the border, metres.
    """

    seen: Surface
    free: Surface
    rounding_m: float
    over_m: float

    @classmethod
    def of(cls, area: Ring, holes: Sequence[Ring], width_m: float, *, cross_holes: bool) -> Region:
        """The region of an area and its holes, which are simple polygons, for lanes of a width; metres, map frame."""
        import shapely

        whole = shapely.Polygon(area)
        without = shapely.union_all([shapely.Polygon(hole) for hole in holes])
        seen = cast("Surface", shapely.difference(whole, without))
        west, south, east, north = whole.bounds
        rounding_m = _ROUNDING * math.hypot(east - west, north - south)
        return cls(seen, whole if cross_holes else seen, rounding_m, max(rounding_m, _OVER * width_m))

    def turned(self, radians: float) -> Region:
        """The same region, turned about the origin."""
        return replace(self, seen=turned(self.seen, radians), free=turned(self.free, radians))

    @cached_property
    def within(self) -> Surface:
        """Where ways may lie: the free region, a little over its borders; prepared for many questions."""
        import shapely

        parts = shapely.get_parts(self.free)
        inside = [shapely.Polygon(shapely.get_exterior_ring(part)) for part in parts]
        holes = [shapely.Polygon(ring) for part in parts for ring in part.interiors]
        grown = shapely.union_all(shapely.buffer(inside, self.over_m, join_style="mitre", quad_segs=1))
        shrunk = shapely.union_all(shapely.buffer(holes, -self.rounding_m, join_style="mitre", quad_segs=1))
        found = cast("Surface", shapely.difference(grown, shrunk))
        shapely.prepare(found)
        return found

    @property
    def middle(self) -> Floats:
        """(2) metres: about the middle of it."""
        west, south, east, north = self.free.bounds
        return np.array([(west + east) / 2, (south + north) / 2])

    def moved(self, by: Floats) -> Region:
        """The same region, translated by (2) metres; near the origin rounding is least."""
        import shapely

        def translated(surface: Surface) -> Surface:
            found: Surface = shapely.transform(surface, lambda points: points + by)
            return found

        return replace(self, seen=translated(self.seen), free=translated(self.free))

    @property
    def edges(self) -> Floats:
        """(n, 2) metres: the steps from corner to corner, of all outlines."""
        import shapely

        rings = shapely.get_rings(shapely.get_parts(self.seen))
        return np.vstack([np.diff(shapely.get_coordinates(ring), axis=0) for ring in rings])


def turned(surface: Surface, radians: float) -> Surface:
    """A surface turned about the origin."""
    import shapely

    found: Surface = shapely.transform(surface, lambda points: turned_points(points, radians))
    return found


def turned_points(points: Floats, radians: float) -> Floats:
    """Points (..., 2) turned about the origin."""
    cos, sin = math.cos(radians), math.sin(radians)
    found: Floats = points @ np.array([[cos, sin], [-sin, cos]])
    return found
