"""The areas of the study: shapes that are awkward for lanes, and maps of square cells."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass

from muster.mission.texts.packaged_files import packaged_data
from muster_studies.instances.random_areas import Ring, random_area, ring


@dataclass(frozen=True)
class Field:
    """An area, its holes, and the width of a lane; metres."""

    area: Ring
    holes: tuple[Ring, ...]
    width_m: float


def square(x: float, y: float, wide: float, high: float | None = None) -> Ring:
    """The corners of a rectangle."""
    top = y + (wide if high is None else high)
    return ((x, y), (x + wide, y), (x + wide, top), (x, top))


def star(points: int, inner: float, size: float = 100.0) -> Ring:
    """The corners of a star whose inner corners are nearer to the middle by a factor."""
    away = [size * (inner if k % 2 else 1.0) for k in range(2 * points)]
    return tuple((r * math.cos(k * math.pi / points), r * math.sin(k * math.pi / points)) for k, r in enumerate(away))


def circle(x: float, y: float, radius: float, corners: int) -> Ring:
    """The corners of a regular polygon."""
    angles = (2 * math.pi * k / corners for k in range(corners))
    return tuple((x + radius * math.cos(a), y + radius * math.sin(a)) for a in angles)


_SIDE_M = 3162.0  # of 10 square kilometres
_POST_M = 200.0

SHAPES: Mapping[str, Field] = {
    "rectangle, 100 m x 50 m": Field(square(0, 0, 100, 50), (), 5.0),
    "L": Field(((0, 0), (100, 0), (100, 20), (20, 20), (20, 100), (0, 100)), (), 5.0),
    "star of 5 points": Field(star(5, 0.4), (), 5.0),
    "circle with 16 round holes": Field(
        circle(0, 0, 1000, 100),
        tuple(circle(x, y, 50, 24) for x in (-600, -200, 200, 600) for y in (-600, -200, 200, 600)),
        20.0,
    ),
    "hole 1 cm from the border": Field(square(0, 0, 100), (square(0.01, 40, 20),), 5.0),
    "6 holes in a row": Field(square(0, 0, 100), tuple(square(5 + 16 * k, 45, 10) for k in range(6)), 5.0),
    "thin strip, 1000 m x 0.5 m": Field(square(0, 0, 1000, 0.5), (), 0.5),
    "0.1 m2": Field(square(0, 0, math.sqrt(0.1)), (), 0.01),
    "10 km2": Field(square(0, 0, _SIDE_M), (), 20.0),
    "10 km2 with 16 holes": Field(
        square(0, 0, _SIDE_M),
        tuple(square(300 + 700 * i, 300 + 700 * j, _POST_M) for i in range(4) for j in range(4)),
        20.0,
    ),
}

CELL_M = 10.0
"""Side of a cell of a grid map; a lane is half as wide, so that four pieces of it make a cell."""
_GRIDS: Mapping[str, str] = packaged_data("muster_studies.areas", "grids.yaml")
GRIDS: Mapping[str, Sequence[str]] = {name: rows.split() for name, rows in _GRIDS.items()}


def field_of_grid(rows: Sequence[str]) -> Field:
    """A grid map as an area: cells that are `.`, in one piece."""
    import shapely

    free = shapely.union_all(
        [
            shapely.box(k * CELL_M, n * CELL_M, (k + 1) * CELL_M, (n + 1) * CELL_M)
            for n, row in enumerate(reversed(rows))
            for k, cell in enumerate(row)
            if cell == "."
        ]
    )
    assert isinstance(free, shapely.Polygon)
    free = shapely.simplify(free, 0.0)
    return Field(ring(free), tuple(tuple(hole.coords)[:-1] for hole in free.interiors), CELL_M / 2)


def random_field(seed: int) -> Field:
    return Field(*random_area(seed))
