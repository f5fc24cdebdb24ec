"""The site of a mission: its origin on Earth, its map and zones, its tags, landmarks and travel tables."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from typing import Any

from muster.mission.place_types import Corners, LatLon, Place
from muster.mission.records import Checked, Record, record, spec
from muster.mission.value_types import Choice, Fault, Flag, Many, Number, Position, Text, Whole, shown

Point = tuple[float, ...]

IN_DEGREES = ("lat_lon", LatLon(), "in place of position, beside origin_wgs84")


@record
class Origin(Checked):
    """Where on Earth the map frame's origin is."""

    lat_deg: float = spec(Number(minimum=-90, maximum=90), "latitude")
    lon_deg: float = spec(Number(minimum=-180, maximum=180), "longitude")
    alt_m: float = spec(Number(), "altitude above the ellipsoid", default=0.0)


@record
class Circle(Checked):
    """A circle of a file; a polygon around it takes its place."""

    center: Point = spec(Place(planar=True), "where its middle is")
    radius_m: float = spec(Number(above=0), "its radius")


IN_CIRCLE = ("circle", Record(Circle, "a circle"), "in place of polygon: the zone is the polygon of 32 sides around it")


@record
class Zone(Checked):
    """A part of the map that some robots may not enter; with an id a door, which events close and open."""

    polygon: tuple[Point, ...] = spec(Corners(), "corners in order", instead=IN_CIRCLE)
    floor_m: float | None = spec(Number(), "lower end of the zone", default=None)
    ceiling_m: float | None = spec(Number(), "upper end of the zone", default=None)
    forbidden_to: tuple[str, ...] = spec(
        Many(Choice(("ground", "air")), minimum=1), "kinds of robot that may not enter", default=("ground", "air")
    )
    id: str | None = spec(Text(), "what events call it that close and open it", default=None)
    open: bool = spec(Flag(), "whether all may enter until an event closes it", default=False)

    @property
    def closed_to(self) -> tuple[str, ...]:
        """The kinds of robot that may not enter before any event."""
        return () if self.open else self.forbidden_to

    @classmethod
    def cross_check(cls, values: Mapping[str, Any]) -> Iterable[Fault]:
        if values.get("open") and values.get("id") is None:
            yield Fault(("id",), "missing", "an id beside open: true, by which events close the zone")
        floor, ceiling = values.get("floor_m"), values.get("ceiling_m")
        if floor is not None and ceiling is not None and floor >= ceiling:
            yield Fault(("ceiling_m",), shown(ceiling), f"a number above floor_m ({floor:g})")


@record
class Map(Checked):
    """The map: one of a ROS map file, an image, or polygons."""

    ros_yaml: str | None = spec(Text(), "a map in the form of ROS map_server", default=None)
    image: str | None = spec(Text(), "an image of the floor", default=None)
    resolution_m: float | None = spec(Number(above=0), "side of one pixel of the image", default=None)
    origin: Point | None = spec(
        Position(third="yaw"), "[x, y, yaw] of the image's lower left corner, metres and radians", default=None
    )
    boundary: tuple[Point, ...] | None = spec(Corners(), "corners of the arena in order", default=None)
    zones: tuple[Zone, ...] = spec(Many(Record(Zone, "a zone")), "parts that some robots may not enter", default=())

    @classmethod
    def cross_check(cls, values: Mapping[str, Any]) -> Iterable[Fault]:
        forms = [name for name in ("ros_yaml", "image", "boundary") if values.get(name) is not None]
        if len(forms) != 1:
            yield Fault((), ", ".join(forms) or "no form", "exactly one of ros_yaml, image, boundary")
        if "image" in forms and values.get("resolution_m") is None:
            yield Fault(("resolution_m",), "missing", "a finite number above 0, beside image")
        if forms in (["ros_yaml"], ["boundary"]):
            for key in ("resolution_m", "origin"):
                if values.get(key) is not None:
                    yield Fault((key,), shown(values[key]), f"no such key beside {forms[0]}: it goes with image")


@record
class Tag(Checked):
    """A tag that lies there to be found: simulated worlds show it to cameras.

    Nobody else knows of it, except robots that localise themselves by tags.
    """

    id: int = spec(Whole(maximum=586), "which tag of the AprilTag family 36h11")
    position: Point = spec(Position(), "where its middle is", instead=IN_DEGREES)
    heading_deg: float = spec(Number(), "where its upper edge is, from east, anticlockwise", default=0.0)
    size_m: float = spec(Number(above=0), "side of its black square", default=0.4)


@record
class Landmark(Checked):
    """An upright cylinder that lasers see and bodies do not touch."""

    position: Point = spec(Position(), "where it stands", instead=IN_DEGREES)
    radius_m: float = spec(Number(above=0), "its radius", default=0.025)
    known: bool = spec(Flag(), "whether robots know its place, and localise themselves by it", default=True)


@dataclass(frozen=True)
class TravelTable:
    """Travel between places for one robot type: `metres[from][to]`, inf where there is no way."""

    places: tuple[str, ...]
    metres: tuple[tuple[float, ...], ...]
