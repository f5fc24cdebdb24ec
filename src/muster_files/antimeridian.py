"""Lines and areas cut at the meridian of 180 degrees (RFC 7946, section 3.1.9).

Without a cut, programs with flat maps draw them around the Earth the other way. Lines and areas must be less than
180 degrees wide; areas around a pole are not supported.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from itertools import pairwise

from muster_files.earth import Spot

_TURN = 360.0


def crosses(spots: Sequence[Spot]) -> bool:
    """Whether the shorter line from one of these points to the next crosses the meridian."""
    return any(abs(b.lon - a.lon) > _TURN / 2 for a, b in pairwise(spots))


def cut_line(spots: Sequence[Spot]) -> list[list[Spot]]:
    """The pieces of a line on either side of the meridian, each with its ends on it."""
    lines = [[spots[0]]]
    for a, b in pairwise(spots):
        if crosses([a, b]):
            side = 180.0 if a.lon > 0 else -180.0
            on = _between(a, replace(b, lon=unwrapped(b.lon, a.lon)), side)
            lines[-1].append(on)
            lines.append([replace(on, lon=-side)])
        lines[-1].append(b)
    return lines


def cut_ring(corners: Sequence[Spot]) -> list[list[Spot]]:
    """The parts of an area, by their corners, in the order of the whole; heights are ignored."""
    if not crosses([*corners, corners[0]]):
        return [list(corners)]
    import shapely

    west = min(corner.lon for corner in corners if corner.lon >= 0)
    whole = shapely.Polygon([(unwrapped(corner.lon, west), corner.lat) for corner in corners])
    parts = []
    for low, turn in ((0.0, 0.0), (180.0, _TURN)):
        found = shapely.intersection(whole, shapely.box(low, -90, low + 180, 90))
        for part in shapely.get_parts(found):
            if isinstance(part, shapely.Polygon):
                ring = shapely.orient_polygons(part).exterior.coords[:-1]
                parts.append([Spot(lat, lon - turn, corners[0].alt) for lon, lat in ring])
    return parts if whole.exterior.is_ccw else [part[::-1] for part in parts]


def unwrapped(lon: float, other: float) -> float:
    """The same longitude within 180 degrees of another one; it may lie beyond 180 degrees."""
    return lon + _TURN * round((other - lon) / _TURN)


def _between(a: Spot, b: Spot, lon: float) -> Spot:
    share = (lon - a.lon) / (b.lon - a.lon)
    return Spot(a.lat + share * (b.lat - a.lat), lon, a.alt + share * (b.alt - a.alt))
