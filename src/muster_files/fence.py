"""The geofence of a robot, whose path keeps out of closed areas (see `open_ways`).

A fence has no heights. A zone that the path crosses above or below is left out, since it would stop the plan.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise

from muster.execution.reports.itinerary import Itinerary
from muster.mission.model import Mission, Point, Zone
from muster.motion.port import Place

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
    """

    boundary: tuple[Point, ...] | None
    zones: dict[int, Zone]
    passed: tuple[int, ...]

    @classmethod
    def of(cls, mission: Mission, itinerary: Itinerary) -> Fence:
        """The boundary of the map, and the zones that the robot may not enter."""
        if mission.map is None:
            return cls(None, {}, ())
        legs = list(pairwise(passage.place for passage in itinerary.passages))
        mine = {k: zone for k, zone in enumerate(mission.map.zones) if itinerary.robot.kind in zone.closed_to}
        passed = tuple(k for k, zone in mine.items() if _is_crossed(legs, zone.polygon))
        return cls(mission.map.boundary, {k: zone for k, zone in mine.items() if k not in passed}, passed)

    @property
    def polygons(self) -> list[tuple[Sequence[Point], bool]]:
        """Its polygons, and whether the robot is to stay inside."""
        bounds: list[tuple[Sequence[Point], bool]] = [] if self.boundary is None else [(self.boundary, True)]
        return [*bounds, *((zone.polygon, False) for zone in self.zones.values())]


def _is_crossed(legs: Sequence[tuple[Place, Place]], polygon: Sequence[Point]) -> bool:
    """Return whether a piece of a way lies over, in or under a polygon."""
    import shapely

    area = shapely.Polygon([corner[:2] for corner in polygon]).buffer(-_TOUCH_M)
    return any(
        shapely.intersects(area, shapely.Point(a[:2]) if a[:2] == b[:2] else shapely.LineString([a[:2], b[:2]]))
        for a, b in legs
    )
