"""Zones that a file gives as circles, before the mission is read: each becomes a polygon that encloses it.

The polygon has 32 sides that touch the circle, so that it is less than 1 % larger, in area as in reach. It takes the
place of the circle for good: what is checked, drawn, exported and written back is the polygon.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from typing import Any

from muster.mission.records import Record
from muster.mission.site import Circle
from muster.mission.value_types import INVALID, Fault, shown
from muster.mission.values.raw_records import Raw, listed

SIDES = 32
_DECIMALS = 6
"""Of the corners in metres; a unit of the last one is added to the radius, so that rounding takes nothing away."""


def circles_to_polygons(data: object, faults: list[Fault]) -> None:
    """Replace, within `data`, the circles of zones by polygons; by INVALID, and a fault, those that are wrong."""
    for at, zone in round_zones(data):
        given = zone.pop("circle")
        if "polygon" in zone:
            faults.append(Fault((*at, "circle"), shown(given), "polygon or circle, not both"))
            continue
        before = len(faults)
        circle: Circle = Record(Circle, "a circle").read(given, (*at, "circle"), faults)
        is_wrong = len(faults) > before or not circle.center  # a middle in degrees that is wrong was refused before
        zone["polygon"] = INVALID if is_wrong else enclosing(circle.center, circle.radius_m)


def round_zones(data: object) -> Iterator[Raw]:
    """Yield the zones of a mission's data that are circles, each with its path."""
    area = data.get("map") if isinstance(data, dict) else None
    yield from ((("map", *at), zone) for at, zone in listed(area, "zones") if "circle" in zone)


def enclosing(center: Sequence[float], radius_m: float) -> list[list[float]]:
    """Return the corners of a polygon whose sides touch a circle from outside, anticlockwise."""
    reach = (radius_m + 10**-_DECIMALS) / math.cos(math.pi / SIDES)
    turns = [2 * math.pi * (k + 0.5) / SIDES for k in range(SIDES)]
    corners: list[Any] = [(center[0] + reach * math.cos(turn), center[1] + reach * math.sin(turn)) for turn in turns]
    return [[round(x, _DECIMALS), round(y, _DECIMALS)] for x, y in corners]
