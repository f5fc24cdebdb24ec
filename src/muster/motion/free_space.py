"""Where the centre of a body may be: the free space of a map for a robot's radius and kind."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

from muster.motion.grid import Grid

if TYPE_CHECKING:
    import shapely


@dataclass(frozen=True, eq=False)
class GridSpace:
    """The free cells of a grid that is inflated already: a centre anywhere in a free cell, its border included."""

    grid: Grid


@dataclass(frozen=True, eq=False)
class PolygonSpace:
    """A region of the plane, its border included: metres in the map frame, obstacles inflated already."""

    region: shapely.Polygon | shapely.MultiPolygon


@dataclass(frozen=True, eq=False)
class Prism:
    """An upright obstacle: its polygon and its height range in metres of the map frame, inflated already."""

    polygon: shapely.Polygon
    floor_m: float
    ceiling_m: float


@dataclass(frozen=True, eq=False)
class PrismSpace:
    """The air over a region of the plane without the inside of some prisms; their faces are free."""

    region: shapely.Polygon | shapely.MultiPolygon
    prisms: tuple[Prism, ...]
    lowest_m: float = 0.0


Space = GridSpace | PolygonSpace | PrismSpace
