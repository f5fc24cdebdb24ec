"""The fences of plan files as the map of one mission: inclusions are its boundary, exclusions its zones.

A mission has one boundary for all robots, so all fences that have one must have the same. Fences have no heights.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any

from muster.mission.geodesy import enu_to_wgs84
from muster.mission.reading.circles import SIDES, enclosing
from muster_files.qgc.fields import Degrees, PlanFields
from muster_files.qgc.flight import require_near
from muster_files.sites.areas import around

Corner = tuple[float, float]
"""Latitude and longitude in degrees, or metres of the map frame."""

_SAME_M = 0.01
_LEAST_CORNERS = 3
_AT = "geoFence"


@dataclass(frozen=True)
class Fences:
    """The rings of one file, in degrees: inclusions and exclusions."""

    inside: tuple[tuple[Corner, ...], ...] = ()
    outside: tuple[tuple[Corner, ...], ...] = ()


def read_fences(fields: PlanFields, data: object, home: Degrees) -> Fences:
    """Return the fences of the member `geoFence`: polygons and circles, in the form of version 2 or of version 1.

    Raises
    ------
    MissionError
        for anything in the fence that is not read: it may open or close a place.
    """
    if not isinstance(data, dict):
        raise fields.refused(_AT, data, "a mapping with polygons")
    fields.require_version(data, _AT, 1, 2)
    rings: dict[bool, list[tuple[Corner, ...]]] = {True: [], False: []}
    if data.get("version") == 1:
        fields.require_known(data, _AT, "version", "polygon", "polygons", "circle", "circles")
        if data.get("polygon"):
            rings[True].append(_ring(fields, data, f"{_AT}.polygon", home))
        if data.get("circle"):
            circle = fields.of(data, "circle", dict, "a mapping with center and radius", f"{_AT}.circle")
            rings[True].append(_circle(fields, circle, f"{_AT}.circle", home, inside=True))
    fields.require_known(data, _AT, "version", "polygon", "polygons", "circle", "circles")
    for key in ("polygons", "circles"):
        for k, part in enumerate(fields.items(data, key, f"{_AT}.{key}")):
            at = f"{_AT}.{key}[{k}]"
            inside = part.get("inclusion") if isinstance(part, dict) else part
            if not isinstance(inside, bool):
                raise fields.refused(f"{at}.inclusion", inside, "true or false")
            fields.require_version(part, at, 1)
            fields.require_known(part, at, "version", "inclusion", "polygon" if key == "polygons" else "circle")
            if key == "polygons":
                rings[inside].append(_ring(fields, part, f"{at}.polygon", home))
            else:
                circle = fields.of(part, "circle", dict, "a mapping with center and radius", f"{at}.circle")
                rings[inside].append(_circle(fields, circle, f"{at}.circle", home, inside=inside))
    return Fences(tuple(rings[True]), tuple(rings[False]))


def _ring(fields: PlanFields, part: dict[str, Any], at: str, home: Degrees) -> tuple[Corner, ...]:
    ring = fields.corners(part, "polygon", at)
    if len(ring) < _LEAST_CORNERS:
        raise fields.refused(at, part["polygon"], f"at least {_LEAST_CORNERS} corners")
    for k, corner in enumerate(ring):
        require_near(fields, corner, home, f"{at}[{k}]")
    return ring


def _circle(fields: PlanFields, circle: dict[str, Any], at: str, home: Degrees, *, inside: bool) -> tuple[Corner, ...]:
    fields.require_known(circle, at, "center", "radius")
    center = circle.get("center")
    if not isinstance(center, list) or len(center) != 2:
        raise fields.refused(f"{at}.center", center, "[latitude, longitude] in degrees")
    lat, lon, _ = fields.place([*center, 0.0], f"{at}.center")
    require_near(fields, (lat, lon), home, f"{at}.center")
    radius = fields.positive(circle, "radius", "metres above 0", f"{at}.radius")
    return ring_for_circle((lat, lon), radius, inside=inside)


def ring_for_circle(center: Corner, radius_m: float, *, inside: bool) -> tuple[Corner, ...]:
    """Return the polygon in place of a circle: within it if the vehicle stays inside, around it otherwise."""
    reach = radius_m * (math.cos(math.pi / SIDES) - 1e-6) if inside else radius_m
    corners = [(east, north, 0.0) for east, north in enclosing((0.0, 0.0), reach)]
    return tuple((lat, lon) for lat, lon, _ in enu_to_wgs84(corners, (*center, 0.0)).tolist())


def map_of(
    fences: Sequence[Fences],
    kinds: Sequence[str],
    metres: Callable[[Corner], Corner],
    places: Sequence[Sequence[float]],
    refused: Callable[[int], Exception],
) -> dict[str, Any] | None:
    """The `map` of a mission file; None if no file has a fence.

    Where fences exclude alone, the boundary is a rectangle around everything, as for sites.

    Parameters
    ----------
    fences, kinds
        of each file: its polygons, and whether its vehicle is of kind `ground` or `air`.
    metres
        degrees in the map frame.
    places
        where there is anything, in the map frame.
    refused
        makes the error for a file, by its index, whose fence has another boundary.
    """
    if not any(fence.inside or fence.outside for fence in fences):
        return None
    boundary: list[Corner] | None = None
    zones: list[tuple[list[Corner], list[str]]] = []
    bounded = any(fence.inside for fence in fences)
    for k, (fence, kind) in enumerate(zip(fences, kinds, strict=True)):
        bounds = [[metres(corner) for corner in ring] for ring in fence.inside]
        if bounded and (len(bounds) != 1 or not _same(bounds[0], boundary or bounds[0])):
            raise refused(k)
        boundary = boundary or (bounds[0] if bounds else None)
        for ring in fence.outside:
            corners = [metres(corner) for corner in ring]
            known = next((of for polygon, of in zones if _same(polygon, corners)), None)
            if known is None:
                zones.append((corners, [kind]))
            elif kind not in known:
                known.append(kind)
    edges = boundary or around([*places, *(corner for polygon, _ in zones for corner in polygon)])
    return {"boundary": edges, "zones": [{"polygon": polygon, "forbidden_to": of} for polygon, of in zones]}


def _same(a: Sequence[Corner], b: Sequence[Corner]) -> bool:
    return len(a) == len(b) and all(math.dist(p, q) < _SAME_M for p, q in zip(a, b, strict=True))
