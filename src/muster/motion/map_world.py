"""The mission's map, ready for use: the free space of a body, and the distance to obstacles.

The boundary holds for all robots, a zone for the kinds it is `forbidden_to`. Heights count in a 3-D mission:

- a ground robot stays on the ground; it passes below a zone whose floor is higher than twice its radius;
- a drone over a polygon map passes over and below zones; the boundary has no ceiling;
- the walls of an image have no height, so over an image a drone is stopped by its zones at every height.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Collection, Iterable
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from muster.mission.errors import MissionError, ParameterError
from muster.mission.mission_parts import positions
from muster.mission.model import Map, Mission, Point, Robot, Zone
from muster.mission.records import findings
from muster.mission.value_types import Fault
from muster.motion.free_space import GridSpace, PolygonSpace, Prism, PrismSpace, Space
from muster.motion.grid import Floats, Grid
from muster.motion.leg_times import LegTimes
from muster.motion.maps.distances import clearance_to_blocked, inflated
from muster.motion.maps.narrow_places import necks
from muster.motion.maps.occupancy_rules import read_grid
from muster.motion.maps.optional_parts import require_map_extra
from muster.motion.maps.polygons import free_region, grown, read_polygon
from muster.motion.maps.raster import in_cells, touched

if TYPE_CHECKING:
    import shapely


_FAR_M, _FAR = 1000.0, 10.0  # m, and of the extent: beyond all places, where there is no boundary


@dataclass(frozen=True)
class Body:
    """The properties of a robot that matter for its ways: `radius_m`, `kind` (`ground` or `air`), `times` along lanes.

    Parameters
    ----------
    times
        by which it chooses among ways along lanes; None where it keeps to none.
    """

    radius_m: float
    kind: str
    times: LegTimes | None = None

    @property
    def off_lanes(self) -> Body:
        """The body of the robot where it keeps to no lanes."""
        return self if self.times is None else replace(self, times=None)


def body_of(robot: Robot, mission: Mission | None = None) -> Body:
    """Return the body of a robot; for its ways along lanes that of a robot in its mission."""
    times = None if mission is None else LegTimes.in_mission(robot, mission)
    return Body(robot.radius_m, robot.kind, times if times is not None and times.along_lanes else None)


@dataclass(frozen=True, eq=False)
class Area:
    """A zone of the map: its number, from 0, its entry in the mission, and its polygon."""

    number: int
    zone: Zone
    polygon: shapely.Polygon

    @property
    def floor_m(self) -> float:
        """-inf where it has none, or begins at or below the ground."""
        floor = self.zone.floor_m
        return -math.inf if floor is None or floor <= 0 else floor

    @property
    def ceiling_m(self) -> float:
        return math.inf if self.zone.ceiling_m is None else self.zone.ceiling_m


@dataclass(frozen=True, eq=False)
class World:
    """A map that was read, and spaces that are made once for each body. Made by `World.of`.

    Parameters
    ----------
    dimensions
        of the mission: 2 or 3.
    lowest_m
        where the ground is: 0, or the lowest place of the mission where that is lower.
    image
        the cells of a map that is an image, without zones; None for a map of polygons.
    boundary
        the arena of a map of polygons; None for an image, and where there is no map.
    areas
        the zones.
    closed
        the ids of the zones that are closed, of those that have one.
    is_unbounded
        whether the boundary is none of the mission's, but far away from all there is.
    """

    dimensions: int
    lowest_m: float
    image: Grid | None
    boundary: shapely.Polygon | None
    areas: tuple[Area, ...]
    closed: frozenset[str] = frozenset()
    is_unbounded: bool = False
    _made: dict[object, object] = field(default_factory=dict, init=False, repr=False)

    def __getstate__(self) -> dict[str, Any]:
        """What is pickled: the map; spaces are made again."""
        return {**self.__dict__, "_made": {}}

    @classmethod
    def of(cls, mission: Mission, image: Grid | None = None) -> World:
        """The world of a mission with a map; files are found from the folder of the mission's file.

        `image` has the cells of a map that is an image, where its file is not at hand.

        Raises
        ------
        MissionError
            with everything that is wrong with the map.
        MissingExtraError
            if the extra `map` is not installed.
        ParameterError
            if the mission has no map.
        """
        if mission.map is None:
            raise ParameterError("mission: no map; expected a mission with a map")
        require_map_extra()
        faults: list[Fault] = []
        boundary = None
        if mission.map.boundary is None:
            image = image or read_grid(mission.map, Path(mission.source.file).parent, faults)
        else:
            boundary = read_polygon(mission.map.boundary, ("map", "boundary"), faults)
        areas = _areas(mission.map, faults)
        if faults:
            raise MissionError(findings(faults, mission.source))
        return cls(*_extent(mission), image, boundary, areas, _closed(areas))

    @classmethod
    def of_travel(cls, mission: Mission) -> World:
        """What a mission's rule of travel keeps robots out of: straight legs pass the walls of an image, but no zones.

        Raises
        ------
        MissionError, MissingExtraError, ParameterError
            as `World.of`.
        """
        if mission.map is None and mission.driven_lanes is not None:
            return cls(*_extent(mission), None, None, ())
        if mission.map is None or mission.map.boundary is not None or mission.travel_off_lanes == "map":
            return cls.of(mission)
        require_map_extra()
        faults: list[Fault] = []
        areas = _areas(mission.map, faults)
        if faults:
            raise MissionError(findings(faults, mission.source))
        corners = [place[:2] for _, place in positions(mission)] + [
            c for zone in mission.map.zones for c in zone.polygon
        ]
        return cls(*_extent(mission), None, _far_around(corners), areas, _closed(areas), is_unbounded=True)

    @property
    def is_empty(self) -> bool:
        """Whether there is no map: nothing stops a robot."""
        return self.image is None and self.boundary is None

    def with_closed(self, closed: Collection[str]) -> World:
        """The world when these of its zones that have an id are closed, and the others of them open."""
        return self if self.closed == frozenset(closed) else replace(self, closed=frozenset(closed))

    def is_closed(self, area: Area) -> bool:
        """Whether a zone is no door, or a closed one."""
        return area.zone.id is None or area.zone.id in self.closed

    def holds_open(self, door: str, bodies: Iterable[tuple[Body, Floats]]) -> bool:
        """Whether one of some bodies, each with its place (3,), is in a door that is closed to its kind."""
        import shapely

        areas = [area for area in self.areas if area.zone.id == door]
        return any(
            body.kind in area.zone.forbidden_to
            and area.floor_m <= place[2] + body.radius_m
            and place[2] - body.radius_m <= area.ceiling_m
            and shapely.distance(area.polygon, shapely.Point(place[:2])) < body.radius_m
            for area in areas
            for body, place in bodies
        )

    def free_space(self, radius_m: float, kind: str, three_d: bool | None = None) -> Space:
        """Where the centre of a body may be. The same arguments give the same object.

        Parameters
        ----------
        radius_m, kind
            of the body; the kind is `ground` or `air`.
        three_d
            whether heights count; by default whether the mission has them.
        """
        three_d = self.dimensions == 3 if three_d is None else three_d
        key = ("space", radius_m, kind, three_d)
        space: Space = self._once(key, lambda: self._space(Body(radius_m, kind), three_d))
        return space

    def clearance(self, points: Floats, kind: str, radius_m: float = 0.0) -> Floats:
        """Metres (n,) from points (n, 2) or (n, 3) to the nearest obstacle of a kind of robot; 0 within one.

        Exact: to polygons and the boundary, or to the squares of blocked cells. For a drone over a map of polygons that
        has a height, the distance is in space; the ground is no obstacle. `radius_m` only tells under which zones a
        ground robot passes.
        """
        places = np.asarray(points, dtype=np.float64)
        in_space = self.dimensions == 3 and places.shape[1] == 3
        body = Body(radius_m, kind)
        if self.image is not None:
            grid = self.blocked(body, in_space)
            measure = self._once(("clearance", *self._numbers(body, in_space)), lambda: clearance_to_blocked(grid))
            metres: Floats = measure(places)
            return metres
        return self._clearance_in_polygons(places, body, in_space)

    def stopping(self, body: Body, three_d: bool) -> tuple[Area, ...]:
        """The zones that a body may not enter, be it at some heights only."""
        stopping = [area for area in self.areas if self.is_closed(area) and body.kind in area.zone.forbidden_to]
        if three_d and body.kind == "ground":
            stopping = [area for area in stopping if area.floor_m <= 2 * body.radius_m]
        return tuple(stopping)

    def blocked(self, body: Body, three_d: bool) -> Grid:
        """The cells of an image and, blocked with them, those that a zone reaches into; not inflated."""
        grid = self.image
        assert grid is not None
        areas = self.stopping(body, three_d)

        def with_zones() -> Grid:
            blocked = grid.blocked.copy()
            for area in areas:
                blocked |= touched(in_cells(area.polygon, grid), grid.shape)
            return Grid(blocked, grid.resolution_m, grid.origin)

        return self._once(("blocked", *self._numbers(body, three_d)), with_zones) if areas else grid

    def _numbers(self, body: Body, three_d: bool) -> tuple[int, ...]:
        return tuple(area.number for area in self.stopping(body, three_d))

    def _space(self, body: Body, three_d: bool) -> Space:
        if self.image is not None:
            return GridSpace(inflated(self.blocked(body, three_d), body.radius_m))
        assert self.boundary is not None
        areas = self.stopping(body, three_d)
        if three_d and body.kind == "air":
            region = free_region(self.boundary, (), body.radius_m)
            if region.is_empty:
                return PrismSpace(region, (), self.lowest_m)
            prisms = tuple(_prism(area, body.radius_m) for area in areas)
            return PrismSpace(region, (*prisms, *necks(region, prisms)), self.lowest_m)
        return PolygonSpace(free_region(self.boundary, (a.polygon for a in areas), body.radius_m))

    def _clearance_in_polygons(self, places: Floats, body: Body, in_space: bool) -> Floats:
        import shapely

        assert self.boundary is not None
        feet = shapely.points(places[:, :2])
        metres = np.where(shapely.intersects(self.boundary, feet), shapely.distance(self.boundary.exterior, feet), 0.0)
        for area in self.stopping(body, in_space):
            away = shapely.distance(area.polygon, feet)
            if in_space and body.kind == "air":
                heights = places[:, 2]
                away = np.hypot(away, np.maximum(np.maximum(area.floor_m - heights, heights - area.ceiling_m), 0.0))
            metres = np.minimum(metres, away)
        return metres

    def _once(self, key: object, make: Callable[[], Any]) -> Any:
        """What was made under this key, or is made now."""
        if key not in self._made:
            self._made[key] = make()
        return self._made[key]


def _prism(area: Area, radius_m: float) -> Prism:
    return Prism(grown(area.polygon, radius_m), area.floor_m - radius_m, area.ceiling_m + radius_m)


def _extent(mission: Mission) -> tuple[int, float]:
    """The dimensions of a mission, and where its ground is."""
    lowest = min((place[2] for _, place in positions(mission) if len(place) == 3), default=0.0)
    return mission.dimensions, min(0.0, lowest)


def _closed(areas: Iterable[Area]) -> frozenset[str]:
    """The ids of the doors that are closed before any event."""
    return frozenset(area.zone.id for area in areas if area.zone.id and not area.zone.open)


def _far_around(corners: Iterable[Point]) -> shapely.Polygon:
    """A box around places that no robot gets to the sides of."""
    import shapely

    points = np.array(list(corners), dtype=np.float64)
    (west, south), (east, north) = points.min(axis=0), points.max(axis=0)
    margin = _FAR_M + _FAR * max(east - west, north - south)
    box: shapely.Polygon = shapely.box(west - margin, south - margin, east + margin, north + margin)
    return box


def _areas(chart: Map, faults: list[Fault]) -> tuple[Area, ...]:
    areas = []
    for number, zone in enumerate(chart.zones):
        polygon = read_polygon(zone.polygon, ("map", "zones", number, "polygon"), faults)
        if polygon is not None:
            areas.append(Area(number, zone, polygon))
    return tuple(areas)
