"""The geofence of a robot, and whether its path keeps to it.

A fence has no heights. A zone that the path crosses above or below is left out, since it would stop the plan.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from itertools import pairwise
from typing import TYPE_CHECKING

from muster.exchange.itinerary import Itinerary
from muster.mission.model import Mission, Point, Zone
from muster.motion.port import Place

if TYPE_CHECKING:
    import shapely

_TOUCH_M = 1e-6
"""Ways go along zones, and may touch them by rounding."""


@dataclass(frozen=True)
class Fence:
    """The fence of one robot.

    Parameters
    ----------
    boundary
        that the robot must not leave, if there is one.
    zones
        that the robot must not enter, by index in the map.
    passed
        zones left out because the path crosses above or below them.
    broken
        what the path violates: `the boundary`, `zone 2`.
    """

    boundary: tuple[Point, ...] | None
    zones: dict[int, Zone]
    passed: tuple[int, ...]
    broken: tuple[str, ...]

    @classmethod
    def of(cls, mission: Mission, itinerary: Itinerary) -> Fence:
        """The boundary of the map, and the zones that the robot may not enter."""
        if mission.map is None:
            return cls(None, {}, (), ())
        legs = list(pairwise(passage.place for passage in itinerary.passages))
        mine = {k: zone for k, zone in enumerate(mission.map.zones) if itinerary.robot.kind in zone.closed_to}
        over = {k: list(_heights_over(legs, zone.polygon)) for k, zone in mine.items()}
        if mission.dimensions == 3:
            tall = 2 * itinerary.robot.radius_m if itinerary.robot.kind == "ground" else 0.0
            entered = [k for k, zone in mine.items() if any(_within(low, high + tall, zone) for low, high in over[k])]
        else:
            entered = [k for k in mine if over[k]]
        passed = tuple(k for k in mine if over[k] and k not in entered)
        outside = [] if mission.map.boundary is None or _inside(legs, mission.map.boundary) else ["the boundary"]
        return cls(
            mission.map.boundary,
            {k: zone for k, zone in mine.items() if k not in passed},
            passed,
            (*outside, *(f"zone {k}" for k in entered)),
        )

    @property
    def polygons(self) -> list[tuple[Sequence[Point], bool]]:
        """Its polygons, and whether the robot is to stay inside."""
        bounds: list[tuple[Sequence[Point], bool]] = [] if self.boundary is None else [(self.boundary, True)]
        return [*bounds, *((zone.polygon, False) for zone in self.zones.values())]


def _heights_over(legs: Sequence[tuple[Place, Place]], polygon: Sequence[Point]) -> Iterator[tuple[float, float]]:
    """The lowest and the highest place of each piece of a way that lies over, in or under a polygon."""
    import shapely

    area = shapely.Polygon([corner[:2] for corner in polygon]).buffer(-_TOUCH_M)
    for a, b in legs:
        if math.dist(a[:2], b[:2]) <= _TOUCH_M:
            if shapely.intersects(area, shapely.Point(a[:2])):
                yield min(a[2], b[2]), max(a[2], b[2])
            continue
        for piece in shapely.get_parts(shapely.intersection(shapely.LineString([a[:2], b[:2]]), area)):
            heights = [a[2] + _share(a, b, place) * (b[2] - a[2]) for place in shapely.get_coordinates(piece)]
            if heights:  # an empty intersection is a piece, too
                yield min(heights), max(heights)


def _share(a: Place, b: Place, place: Sequence[float]) -> float:
    return math.dist(a[:2], place) / math.dist(a[:2], b[:2])


def _within(low: float, high: float, zone: Zone) -> bool:
    """Whether some height between two over a zone is one of the zone."""
    floor = -math.inf if zone.floor_m is None or zone.floor_m <= 0 else zone.floor_m
    ceiling = math.inf if zone.ceiling_m is None else zone.ceiling_m
    return high > floor + _TOUCH_M and low < ceiling - _TOUCH_M


def _inside(legs: Sequence[tuple[Place, Place]], boundary: Sequence[Point]) -> bool:
    import shapely

    area: shapely.Polygon = shapely.Polygon([corner[:2] for corner in boundary]).buffer(_TOUCH_M)
    return all(shapely.covers(area, shapely.LineString([a[:2], b[:2]])) for a, b in legs)
