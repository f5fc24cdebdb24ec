"""Random areas with holes: star-shaped outlines, thin and thick, holes that lie apart, lanes fine and coarse."""

from __future__ import annotations

import math
from random import Random
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    import shapely

Ring = tuple[tuple[float, ...], ...]

SIZES_M = (3.0, 100.0, 2000.0)
WIDTHS = (0.03, 0.05, 0.1, 0.3)
"""Of a lane, as shares of the size."""


def random_area(seed: int) -> tuple[Ring, tuple[Ring, ...], float]:
    """An area, its holes, and the width of a lane; simple polygons, and holes that do not cut the area apart."""
    draw = Random(seed)
    size = draw.choice(SIZES_M)
    area = _star(draw, (0.0, 0.0), 0.35 * size, size, draw.randint(3, 14))
    while area.area < 0.05 * size**2:
        area = _star(draw, (0.0, 0.0), 0.35 * size, size, draw.randint(3, 14))
    inner = area.buffer(-0.003 * size)
    holes: list[shapely.Polygon] = []
    for _ in range(draw.randint(1, 30)):
        place = (draw.uniform(-size, size), draw.uniform(-size, size))
        hole = _star(draw, place, 0.01 * size, draw.uniform(0.02, 0.2) * size, draw.randint(3, 8))
        if inner.contains(hole) and all(hole.disjoint(other) for other in holes):
            holes.append(hole)
    return ring(area), tuple(map(ring, holes)), size * draw.choice(WIDTHS)


def ring(polygon: shapely.Polygon) -> Ring:
    """The corners of a polygon's outline, each once."""
    return tuple(polygon.exterior.coords)[:-1]


def surface(area: Ring, holes: tuple[Ring, ...]) -> shapely.Polygon:
    """The area without its holes, which lie apart."""
    import shapely

    return shapely.Polygon(area, holes)


def _star(draw: Random, middle: tuple[float, float], least: float, most: float, corners: int) -> shapely.Polygon:
    """A polygon with a corner in each of so many directions."""
    import shapely

    found = shapely.Polygon()
    while not found.is_valid or not found.area:
        angles = sorted(draw.uniform(0, 2 * math.pi) for _ in range(corners))
        away = [draw.uniform(least, most) for _ in angles]
        found = shapely.Polygon(
            [(middle[0] + r * math.cos(a), middle[1] + r * math.sin(a)) for r, a in zip(away, angles, strict=True)]
        )
    return found
