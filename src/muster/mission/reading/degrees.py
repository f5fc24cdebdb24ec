"""Converts places that a file gives in degrees to metres in the map frame, before the mission is read.

A robot, a task, a tag and a `move_task` may have `lat_lon` in place of `position`; `end_position`, `entry`, `exit`,
`pickup` and the nodes of lanes may be `{lat_lon: [lat, lon]}`; the boundary of a map, the polygon of a zone, an area
and each of its holes `{lat_lon: [[lat, lon], ...]}`. With an altitude a place has three coordinates, without it two: it
is taken at the altitude of the origin, and its height over the plane of the map frame is dropped.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any

from muster.mission.place_types import Corners, LatLon, Place
from muster.mission.records import Record
from muster.mission.site import Origin
from muster.mission.tasks import Action
from muster.mission.value_types import INVALID, Fault, Path, is_list, shown
from muster.mission.values.raw_records import listed, of_events, robots_in, tasks_in

_OTHER_PLACES = ("end_position", "entry", "exit", "pickup")
_FARTHEST_KM = 1000.0
_WORDS = (("x, y, z", "lat, lon, alt"), ("x, y", "lat, lon"))


@dataclass(frozen=True)
class InDegrees:
    """A place in degrees: its value and path in the file; the path, and the mapping or list, in which the metres go."""

    value: object
    at: Path
    metres_at: Path
    record: dict[str, Any] | list[Any]
    planar: bool = False

    def put(self, metres: Any) -> None:
        """Put the metres where the degrees were."""
        if isinstance(self.record, list):
            self.record[int(self.metres_at[-1])] = metres
        else:
            self.record.pop("lat_lon", None)
            self.record[str(self.metres_at[-1])] = metres


def degrees_to_metres(data: object, faults: list[Fault]) -> Mapping[Path, InDegrees]:
    """Replace, within `data`, places in degrees by metres; by INVALID, and a fault, those that are wrong.

    Returns
    -------
    what was replaced, by the path at which the metres are now.

    Raises
    ------
    MissingExtraError
        if there are such places and pymap3d is not installed.
    """
    found = list(_places(data))
    if not found:
        return {}
    origin = _origin(data, found[0], faults)
    read = [_read(place, faults) for place in found]
    for place, metres in zip(found, _metres(read, origin), strict=True):
        place.put(metres if metres is INVALID else _at_hand(metres, place, faults))
    return {place.metres_at: place for place in found}


def in_degrees(fault: Fault, places: Mapping[Path, InDegrees]) -> Fault:
    """A fault of a place that was given in degrees, in the words of the file."""
    place = places.get(fault.path)
    if place is None:
        return fault
    expected = fault.expected
    for metres, degrees in _WORDS:
        expected = expected.replace(metres, degrees)
    return replace(fault, path=place.at, value=shown(place.value), expected=expected)


def _places(data: object) -> Iterator[InDegrees]:
    for at, record in _records(data):
        if "lat_lon" in record:
            yield InDegrees(record["lat_lon"], (*at, "lat_lon"), (*at, "position"), record)
        if dict in map(type, record.values()):
            yield from _by_key(at, record, (*_OTHER_PLACES, *_own_places(record)))
        if "area" in record:
            yield from _corners(at, record, "area")
        if is_list(record.get("holes")):
            record["holes"] = holes = list(record["holes"])
            for k in range(len(holes)):
                yield from _corners((*at, "holes"), holes, k)
    lanes = data.get("lanes") if isinstance(data, dict) else None
    nodes = lanes.get("nodes") if isinstance(lanes, dict) else None
    if isinstance(nodes, dict):
        yield from _by_key(("lanes", "nodes"), nodes, nodes, planar=True)
    area = data.get("map") if isinstance(data, dict) else None
    if isinstance(area, dict):
        yield from _corners(("map",), area, "boundary")
        for at, zone in listed(area, "zones"):
            yield from _corners(("map", *at), zone, "polygon")
            if isinstance(circle := zone.get("circle"), dict):
                yield from _by_key(("map", *at, "circle"), circle, ("center",), planar=True)


def _corners(at: Path, record: Any, key: str | int) -> Iterator[InDegrees]:
    """The corners of a polygon, each a place; a list of metres takes the place of their mapping."""
    value = record[key] if isinstance(key, int) else record.get(key)
    given = value["lat_lon"] if isinstance(value, dict) and list(value) == ["lat_lon"] else None
    if is_list(given) and len(given) >= Corners().minimum:
        metres: list[Any] = [INVALID] * len(given)
        record[key] = metres
        for k, corner in enumerate(given):
            yield InDegrees(corner, (*at, key, "lat_lon", k), (*at, key, k), metres, planar=True)


def _by_key(at: Path, record: dict[str, Any], keys: Iterable[str], *, planar: bool = False) -> Iterator[InDegrees]:
    """The places of a record, by these of its keys."""
    for key in keys:
        value = record.get(key)
        if isinstance(value, dict) and list(value) == ["lat_lon"]:
            yield InDegrees(value["lat_lon"], (*at, key, "lat_lon"), (*at, key), record, planar)


def _own_places(record: Mapping[str, Any]) -> list[str]:
    """The keys of an action of another package that are places."""
    return [key for key, own in Action.further_keys(record).items() if isinstance(own.kind, Place)]


def _records(data: object) -> Iterator[tuple[Path, dict[str, Any]]]:
    """Everything in a mission that has places: robots, tasks and their actions, those of events, stations, tags."""
    yield from robots_in(data)
    for at, record in tasks_in(data):
        yield from _of_task(at, record)
    yield from of_events(data, "move_task")
    yield from listed(data, "stations")
    yield from listed(data, "tags")
    yield from listed(data, "landmarks")


def _of_task(at: Path, record: dict[str, Any]) -> Iterator[tuple[Path, dict[str, Any]]]:
    yield at, record
    if isinstance(record.get("action"), dict):
        yield (*at, "action"), record["action"]


def _read(place: InDegrees, faults: list[Fault]) -> Any:
    nested = place.at[-2:] == (place.metres_at[-1], "lat_lon")
    if not nested and isinstance(place.record, dict) and "position" in place.record:
        faults.append(Fault(place.at, shown(place.value), "position or lat_lon, not both"))
        return INVALID
    return LatLon(planar=place.planar).read(place.value, place.at, faults)


def _origin(data: object, first: InDegrees, faults: list[Fault]) -> Origin | None:
    """The mission's origin, or None where there is none or it is wrong; of the latter the mission's reader tells."""
    given = data.get("origin_wgs84") if isinstance(data, dict) else None
    if given is None:
        faults.append(Fault(first.at, shown(first.value), "origin_wgs84 in the mission, beside places in degrees"))
        return None
    wrong: list[Fault] = []
    origin: Origin = Record(Origin, "an origin").read(given, (), wrong)
    return None if wrong else origin


def _at_hand(metres: list[float], place: InDegrees, faults: list[Fault]) -> Any:
    """The metres; INVALID, and a fault, where they are so many that the plane of the map frame is of no use."""
    away_km = math.hypot(*metres) / 1000
    if away_km <= _FARTHEST_KM:
        return metres
    expected = f"a place within {_FARTHEST_KM:g} km of it: latitude comes first, then longitude"
    faults.append(Fault(place.at, f"{shown(place.value)}, {away_km:.0f} km from origin_wgs84", expected))
    return INVALID


def _metres(places: Sequence[Any], origin: Origin | None) -> list[Any]:
    """Each place as a list of metres; INVALID for those that are INVALID, and for all without an origin."""
    right = [k for k, place in enumerate(places) if place is not INVALID]
    metres: list[Any] = [INVALID] * len(places)
    if origin is None or not right:
        return metres
    from muster.mission.geodesy import wgs84_to_enu  # brings NumPy, which a server that shows missions is without

    spatial = [(*places[k][:2], places[k][2] if len(places[k]) == 3 else origin.alt_m) for k in right]
    points = wgs84_to_enu(spatial, (origin.lat_deg, origin.lon_deg, origin.alt_m))
    for k, point in zip(right, points.tolist(), strict=True):
        metres[k] = point[: len(places[k])]
    return metres
