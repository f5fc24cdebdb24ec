"""Geometries of shapely as those of features, and back; areas without holes; what is wrong with an area."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Sequence
from typing import TYPE_CHECKING, Any

from muster.mission.system.extras import needs_extra
from muster_files.sites.features import Coordinate, Geometry, Ring, Shape

if TYPE_CHECKING:
    import shapely

_DEEPEST = 8
_POINTS, _LINES, _AREAS = (0, 4), (1, 2, 5), (3, 6)
"""Numbers of shapely's types."""


def geometries_of(found: Any, transform: Callable[[Coordinate], Coordinate] | None = None) -> Iterator[Geometry]:
    """The parts of a geometry of shapely, in degrees or in what `transform` makes degrees of.

    Raises
    ------
    ValueError
        if its coordinates are none, or none of degrees.
    """
    import shapely

    number = int(shapely.get_type_id(found))
    if number == 7:
        for part in shapely.get_parts(found):
            yield from geometries_of(part, transform)
        return
    parts = [part for part in shapely.get_parts(found) if not shapely.is_empty(part)]
    shapes: list[tuple[tuple[int, ...], Shape]] = [(_POINTS, "point"), (_LINES, "line"), (_AREAS, "area")]
    shape = next((shape for numbers, shape in shapes if number in numbers), None)
    if shape is None:
        raise ValueError(f"a {getattr(found, 'geom_type', 'geometry')}")
    if parts:
        yield Geometry(shape, tuple(tuple(_rings(part, transform)) for part in parts))


def _rings(part: Any, transform: Callable[[Coordinate], Coordinate] | None) -> Iterator[Ring]:
    import shapely

    for line in [part.exterior, *part.interiors] if part.geom_type == "Polygon" else [part]:
        spatial = bool(shapely.has_z(line)) and part.geom_type == "Point"
        rows = shapely.get_coordinates(line, include_z=spatial).tolist()
        ring = tuple(tuple(row) if transform is None else transform(tuple(row)) for row in rows)
        for place in ring:
            if not all(map(math.isfinite, place)) or abs(place[1]) > 90 or abs(place[0]) > 360:
                raise ValueError(f"coordinates {list(place)}, not longitude and latitude in degrees")
        yield ring


def from_text(told: str) -> list[Geometry]:
    """The geometries in well-known text; raises ValueError where it is none."""
    with needs_extra("map", "a geometry as text (WKT)"):
        import shapely
    try:
        found = shapely.from_wkt(told)
    except shapely.errors.ShapelyError as error:
        raise ValueError(" ".join(str(error).split())) from None
    return list(geometries_of(found))


def require_valid(rings: Sequence[Sequence[Sequence[float]]]) -> shapely.Polygon:
    """The area of an outer ring and its holes, in metres.

    Raises
    ------
    ValueError
        where it is none: with what is wrong, and perhaps the place in metres.
    """
    import shapely

    try:
        area = shapely.Polygon(rings[0], rings[1:])
    except (ValueError, shapely.errors.ShapelyError):
        raise ValueError("fewer than 3 corners") from None
    if not area.is_valid:
        told, _, place = str(shapely.is_valid_reason(area)).partition("[")
        raise ValueError(told.strip().lower(), *[tuple(map(float, place.strip("]").split()))][: bool(place)])
    if area.area == 0:
        raise ValueError("no area")
    return area


def mended(rings: Sequence[Sequence[Sequence[float]]]) -> list[shapely.Polygon]:
    """Return areas that contain all that a ring encloses in any sense, where its sides cross; holes are filled.

    Raises
    ------
    ValueError
        if the ring encloses nothing.
    """
    import shapely

    line = shapely.LineString([*rings[0], rings[0][0]]) if len(rings[0]) > 1 else shapely.LineString()
    faces = shapely.get_parts(shapely.polygonize([shapely.node(line)]))
    whole = shapely.union_all(list(faces))
    found = [shapely.Polygon(one.exterior) for one in shapely.get_parts(whole) if one.area > 0]
    if not found:
        raise ValueError("no area")
    return found


def without_holes(area: shapely.Polygon) -> list[shapely.Polygon]:
    """The same area as polygons without holes: cut through the middle of a hole, as often as there are any."""
    import shapely

    if not area.interiors:
        return [area]
    middle = shapely.Polygon(area.interiors[0]).centroid.x
    west, south, east, north = area.bounds
    halves = (shapely.box(west - 1, south - 1, middle, north + 1), shapely.box(middle, south - 1, east + 1, north + 1))
    parts = [part for half in halves for part in shapely.get_parts(shapely.intersection(area, half))]
    return [whole for part in parts if part.geom_type == "Polygon" for whole in without_holes(part)]
