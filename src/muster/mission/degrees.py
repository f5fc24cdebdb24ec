"""Converts places that a file gives in degrees to metres in the map frame, before the mission is read.

A robot, a task, a tag and a `move_task` may have `lat_lon` in place of `position`; `end_position`, `entry`, `exit`,
`pickup` and the nodes of lanes may be `{lat_lon: [lat, lon]}`, the boundary of a map and the polygon of a zone
`{lat_lon: [[lat, lon], ...]}`. With an altitude a place has three coordinates, without it two: it is taken at the
altitude of the origin, and its height over the plane of the map frame is dropped.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any

from muster.mission.place_types import Corners, LatLon, Place
from muster.mission.raw_records import listed, of_events, robots_in, tasks_in
from muster.mission.records import Record
from muster.mission.site import Origin
from muster.mission.tasks import Action
from muster.mission.value_types import INVALID, Fault, Path, is_list, shown

_OTHER_PLACES = ("end_position", "entry", "exit", "pickup")
_IN_RINGS = {"area_lat_lon": "area", "holes_lat_lon": "holes"}
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
    found = list(_places(data, faults))
    if not found:
        return {}
    origin = _origin(data, found[0], faults)
    read = [_read(place, faults) for place in found]
    for place, metres in zip(found, _metres(read, origin), strict=True):
        place.put(metres)
    if any(isinstance(place.record, list) for place in found):
        _set_wrong_rings_aside(data)
    return {place.metres_at: place for place in found}


def _set_wrong_rings_aside(data: object) -> None:
    """An area with a wrong corner, of which a fault tells, is no area at all."""
    for _, record in _records(data):
        for own in _IN_RINGS.values():
            rings = record.get(own)
            rows = rings if isinstance(rings, list) else ()
            if any(row is INVALID or (isinstance(row, list) and INVALID in row) for row in rows):
                record[own] = INVALID


def in_degrees(fault: Fault, places: Mapping[Path, InDegrees]) -> Fault:
    """A fault of a place that was given in degrees, in the words of the file."""
    place = places.get(fault.path)
    if place is None:
        return _of_ring_in_degrees(fault, places)
    expected = fault.expected
    for metres, degrees in _WORDS:
        expected = expected.replace(metres, degrees)
    return replace(fault, path=place.at, value=shown(place.value), expected=expected)


def _of_ring_in_degrees(fault: Fault, places: Mapping[Path, InDegrees]) -> Fault:
    """A fault of an area or of holes by the name of the key in the file; places in it are metres of the map frame."""
    for corner in ((0,), (0, 0)):
        place = places.get((*fault.path, *corner))
        if place is not None and isinstance(place.record, list):
            return replace(fault, path=place.at[: -len(corner)])
    return fault


def _places(data: object, faults: list[Fault]) -> Iterator[InDegrees]:
    for at, record in _records(data):
        if "lat_lon" in record:
            yield InDegrees(record["lat_lon"], (*at, "lat_lon"), (*at, "position"), record)
        if dict in map(type, record.values()):
            yield from _by_key(at, record, (*_OTHER_PLACES, *_own_places(record)))
        if not _IN_RINGS.keys().isdisjoint(record):
            yield from _in_rings(at, record, faults)
    lanes = data.get("lanes") if isinstance(data, dict) else None
    nodes = lanes.get("nodes") if isinstance(lanes, dict) else None
    if isinstance(nodes, dict):
        yield from _by_key(("lanes", "nodes"), nodes, nodes, planar=True)
    area = data.get("map") if isinstance(data, dict) else None
    if isinstance(area, dict):
        yield from _corners(("map",), area, "boundary")
        for at, zone in listed(area, "zones"):
            yield from _corners(("map", *at), zone, "polygon")


def _corners(at: Path, record: dict[str, Any], key: str) -> Iterator[InDegrees]:
    """The corners of an area, each a place; a list of metres takes the place of their mapping."""
    value = record.get(key)
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


def _in_rings(at: Path, record: dict[str, Any], faults: list[Fault]) -> Iterator[InDegrees]:
    """The corners of areas and holes; what is no list of these is left to the reader of metres."""
    for key in [key for key in _IN_RINGS if key in record]:
        own, rings = _IN_RINGS[key], record.pop(key)
        if own in record:
            faults.append(Fault((*at, key), shown(rings), f"{own} or {key}, not both"))
            continue
        record[own] = metres = list(rings) if isinstance(rings, list) else rings
        if own == "area":
            yield from _of_ring(metres, (*at, key), (*at, own))
            continue
        for k, ring in enumerate(metres if isinstance(metres, list) else ()):
            metres[k] = list(ring) if isinstance(ring, list) else ring
            yield from _of_ring(metres[k], (*at, key, k), (*at, own, k))


def _of_ring(corners: object, at: Path, metres_at: Path) -> Iterator[InDegrees]:
    if isinstance(corners, list):
        yield from (
            InDegrees(value, (*at, k), (*metres_at, k), corners, planar=True) for k, value in enumerate(corners)
        )


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
