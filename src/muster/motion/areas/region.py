"""The region that is to be seen, and the region in which a robot may move, turned so that lanes run along x."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING, TypeAlias, cast

import numpy as np
import numpy.typing as npt

if TYPE_CHECKING:
    import shapely

Surface: TypeAlias = "shapely.Polygon | shapely.MultiPolygon"

Floats = npt.NDArray[np.float64]
Ring = tuple[tuple[float, ...], ...]

_ROUNDING = 1e-7
"""Of the size of an area: by so much a way may lie outside it."""


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
        by how much a way may lie outside, metres.
    """

    seen: Surface
    free: Surface
    rounding_m: float

    @classmethod
    def of(cls, area: Ring, holes: Sequence[Ring], *, cross_holes: bool) -> Region:
        """The region of an area and its holes, which are simple polygons; metres in the map frame."""
        import shapely

        whole = shapely.Polygon(area)
        without = shapely.union_all([shapely.Polygon(hole) for hole in holes])
        seen = cast("Surface", shapely.difference(whole, without))
        west, south, east, north = whole.bounds
        return cls(seen, whole if cross_holes else seen, _ROUNDING * math.hypot(east - west, north - south))

    def turned(self, radians: float) -> Region:
        """The same region, turned about the origin."""
        return Region(turned(self.seen, radians), turned(self.free, radians), self.rounding_m)

    @cached_property
    def within(self) -> Surface:
        """Where ways may lie: the free region, grown by rounding; prepared for many questions."""
        import shapely

        found: Surface = shapely.buffer(self.free, self.rounding_m, join_style="mitre", quad_segs=1)
        shapely.prepare(found)
        return found

    @property
    def middle(self) -> Floats:
        """(2) metres: about the middle of it."""
        west, south, east, north = self.free.bounds
        return np.array([(west + east) / 2, (south + north) / 2])

    def moved(self, by: Floats) -> Region:
        """The same region, shifted by (2) metres; near the origin rounding is least."""
        import shapely

        def shifted(surface: Surface) -> Surface:
            found: Surface = shapely.transform(surface, lambda points: points + by)
            return found

        return Region(shifted(self.seen), shifted(self.free), self.rounding_m)

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
