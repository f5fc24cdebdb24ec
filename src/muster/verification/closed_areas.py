"""The judge's own test of straight legs against the boundary and zones of a mission's file (docs/design.md, Meaning).

A leg enters a zone where some point of it, at a height that the zone reaches for the robot's body, is nearer to the
zone than the robot's radius; it leaves the boundary where a point is nearer to the boundary than that, or outside. What
is deeper by no more than `_TOUCH` of the area's extent touches it. In the plane a zone counts at every height, as
heights are unknown. In space a robot on the ground passes below a zone that begins higher than its body, and a drone
over and below zones; it climbs and lands upright, so that a leg with an end on the ground is closed, too, where the
column over that end or the level leg from its top is.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import TYPE_CHECKING, NamedTuple

from muster.mission.errors import MissionError
from muster.mission.mission_parts import positions
from muster.mission.model import Mission, Point, Robot, Zone
from muster.mission.records import findings
from muster.mission.value_types import Fault
from muster.motion.maps.optional_parts import require_map_extra
from muster.motion.maps.polygons import read_polygon

if TYPE_CHECKING:
    import shapely

_TOUCH_M, _TOUCH, _ROUNDING = 2e-9, 1e-9, 1e-14  # metres, of an area's extent, and of its greatest coordinate

Spot = tuple[float, float, float]


class _Area(NamedTuple):
    """A zone as one kind of body meets it: what it may not touch or come near to, and between which heights."""

    name: str
    polygon: shapely.Polygon
    core: shapely.Polygon  # without what may be touched
    touch_m: float
    floor_m: float
    ceiling_m: float
    closed_to: tuple[str, ...]


class ClosedAreas:
    """The areas of a mission's map that are closed to its robots before any event.

    Raises
    ------
    MissionError, MissingExtraError
        if a polygon is wrong, or Shapely is absent.
    """

    def __init__(self, mission: Mission) -> None:
        chart = mission.map
        self._areas: list[_Area] = []
        self._boundary: _Area | None = None
        self._in_space = mission.dimensions == 3
        self._known: dict[tuple[float, str, Point, Point], str | None] = {}
        self._ground_m = min([0.0, *(place[2] for _, place in positions(mission) if len(place) > 2)])
        if chart is None or not (chart.boundary or chart.zones):
            return
        require_map_extra()
        faults: list[Fault] = []
        for number, zone in enumerate(chart.zones):
            polygon = read_polygon(zone.polygon, ("map", "zones", number, "polygon"), faults)
            if polygon is not None:
                self._areas.append(_area(number, zone, polygon))
        outline = None if chart.boundary is None else read_polygon(chart.boundary, ("map", "boundary"), faults)
        if faults:
            raise MissionError(findings(faults, mission.source))
        if outline is not None:
            self._boundary = _Area("the boundary", outline, outline, _touch_m(outline), -math.inf, math.inf, ())

    def obstacle(self, robot: Robot, start: Point, end: Point) -> str | None:
        """Return what a robot does on the straight leg between two points: `enters zone 2`; None: nothing closed."""
        if not self._areas and self._boundary is None:
            return None
        key = (robot.radius_m, robot.kind, start, end)
        if key not in self._known:
            self._known[key] = self._found(robot, _spot(start), _spot(end))
        return self._known[key]

    def _found(self, robot: Robot, start: Spot, end: Spot) -> str | None:
        for begin, over, how in self._flown(robot, start, end):
            for area in self._areas:
                if robot.kind in area.closed_to and self._enters(robot, area, begin, over):
                    return f"enters {area.name}{how}"
        return "leaves the boundary" if self._boundary and _leaves(robot, self._boundary, start, end) else None

    def _flown(self, robot: Robot, start: Spot, end: Spot) -> Iterator[tuple[Spot, Spot, str]]:
        """The leg, and for a drone that stands on the ground at its one end the column and the level leg as well."""
        yield start, end, ""
        low, high = sorted((start, end), key=lambda spot: spot[2])
        if self._in_space and robot.kind == "air" and low[2] <= self._ground_m and high[2] > low[2]:
            top = (low[0], low[1], high[2])
            yield low, top, " on take-off or landing"
            yield top, high, " on take-off or landing"

    def _enters(self, robot: Robot, area: _Area, start: Spot, end: Spot) -> bool:
        import shapely

        radius_m, part = robot.radius_m, (start[:2], end[:2])
        if self._in_space and robot.kind == "ground" and area.floor_m > 2 * radius_m:
            return False
        if self._in_space and robot.kind == "air":
            low, high = area.floor_m - radius_m + area.touch_m, area.ceiling_m + radius_m - area.touch_m
            between = _between_heights(start, end, low, high)
            if between is None:
                return False
            part = between
        leg = _leg(*part)
        if radius_m > 2 * area.touch_m:
            return bool(shapely.distance(area.polygon, leg) <= radius_m - area.touch_m)
        return bool(shapely.intersects(area.core, leg))


def _area(number: int, zone: Zone, polygon: shapely.Polygon) -> _Area:
    import shapely

    touch_m = _touch_m(polygon)
    core = shapely.buffer(polygon, -touch_m, join_style="mitre")
    name = f"zone {number}" + ("" if zone.id is None else f" ({zone.id})")
    floor_m = -math.inf if zone.floor_m is None or zone.floor_m <= 0 else zone.floor_m
    ceiling_m = math.inf if zone.ceiling_m is None else zone.ceiling_m
    return _Area(name, polygon, core, touch_m, floor_m, ceiling_m, zone.closed_to)


def _leaves(robot: Robot, boundary: _Area, start: Spot, end: Spot) -> bool:
    import shapely

    leg, keep_m = _leg(start[:2], end[:2]), robot.radius_m - boundary.touch_m
    if not shapely.covers(shapely.buffer(boundary.polygon, boundary.touch_m, join_style="mitre"), leg):
        return True
    return keep_m > 0 and bool(shapely.distance(boundary.polygon.exterior, leg) <= keep_m)


def _between_heights(
    start: Spot, end: Spot, low: float, high: float
) -> tuple[tuple[float, float], tuple[float, float]] | None:
    """The part of a leg in the plane above `low` and below `high`; None where it is nowhere there."""
    rise = end[2] - start[2]
    if rise == 0:
        return (start[:2], end[:2]) if low < start[2] < high else None
    first, last = sorted(((low - start[2]) / rise, (high - start[2]) / rise))
    first, last = max(first, 0.0), min(last, 1.0)
    if first > last:
        return None
    at = [(start[0] + share * (end[0] - start[0]), start[1] + share * (end[1] - start[1])) for share in (first, last)]
    return at[0], at[1]


def _leg(start: tuple[float, float], end: tuple[float, float]) -> shapely.Geometry:
    import shapely

    return shapely.Point(start) if start == end else shapely.LineString([start, end])


def _touch_m(polygon: shapely.Polygon) -> float:
    west, south, east, north = polygon.bounds
    return _TOUCH_M + _TOUCH * max(east - west, north - south) + _ROUNDING * max(map(abs, polygon.bounds))


def _spot(point: Point) -> Spot:
    return point[0], point[1], point[2] if len(point) > 2 else 0.0
