"""QGroundControl plan files as a mission: one robot a file, every way point a task, the first home the origin.

A way point's hold is the task's duration. The order of way points is not kept, since Muster plans it
anew. Way points of take-off, landing and return to launch give the end position. Fences become the map.
"""

from __future__ import annotations

import json
import math
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any, TypeGuard

from muster.exchange import qgc_format as qgc
from muster.exchange.qgc_fences import Corner, Fences, map_of
from muster.mission.errors import Finding, MissionError
from muster.mission.from_data import mission_from
from muster.mission.geodesy import wgs84_to_enu
from muster.mission.model import SCHEMA, Mission
from muster.mission.plan import tie_order
from muster.mission.source import Source
from muster.mission.text_files import read_text
from muster.mission.value_types import shown

Degrees = tuple[float, float, float]
"""Latitude and longitude in degrees, and the height in metres in the datum of the planned home."""

_RELATIVE = (qgc.FRAME_GLOBAL_RELATIVE_ALT, qgc.FRAME_GLOBAL_RELATIVE_ALT_INT)
_FRAMES = (*_RELATIVE, qgc.FRAME_GLOBAL, qgc.FRAME_GLOBAL_INT)
_STOPS = (qgc.NAV_WAYPOINT, qgc.NAV_LOITER_TIME)
_READ = (*_STOPS, qgc.NAV_TAKEOFF, qgc.NAV_LAND, qgc.NAV_RETURN_TO_LAUNCH)
_SAME_PLACE_M = 0.01


@dataclass(frozen=True)
class _Vehicle:
    """The content of one file."""

    name: str
    home: Degrees
    ground: bool
    speed_mps: float
    stops: tuple[tuple[int, Degrees, float], ...]
    """Number of the item, place, and seconds of hold."""
    returns: bool
    lands_at: Degrees | None
    fences: Fences

    @property
    def kind(self) -> str:
        return "ground" if self.ground else "air"


def read_plan_files(path: str | Path) -> Mission:
    """The mission of a `.plan` file, or of all `.plan` files in a folder.

    The mission is in the plane if all vehicles are rovers or boats.

    Raises
    ------
    MissionError
        with the errors of the first wrong file, or of the first with another boundary.
    MissingExtraError
        if pymap3d is not installed.
    """
    path = Path(path)
    readings = [_Reading(file) for file in _files(path)]
    vehicles = [reading.vehicle() for reading in readings]
    lat, lon, alt = vehicles[0].home
    spatial = not all(vehicle.ground for vehicle in vehicles)

    def metres(place: Degrees) -> list[float]:
        point: list[float] = wgs84_to_enu([place], vehicles[0].home)[0].tolist()
        return point if spatial else point[:2]

    def on_map(corner: Corner) -> Corner:
        east, north, _ = wgs84_to_enu([(*corner, alt)], vehicles[0].home)[0].tolist()
        return east, north

    fences = [vehicle.fences for vehicle in vehicles]
    chart = map_of(fences, [v.kind for v in vehicles], on_map, lambda k: readings[k].without_boundary())
    data = {
        "schema": SCHEMA,
        "name": path.stem,
        "origin_wgs84": {"lat_deg": lat, "lon_deg": lon, "alt_m": alt},
        "robots": [_robot(vehicle, metres(vehicle.home), metres) for vehicle in vehicles],
        "tasks": [
            {"id": f"{vehicle.name}-{number}", "position": metres(place), **({"duration_s": hold} if hold else {})}
            for vehicle in vehicles
            for number, place, hold in vehicle.stops
        ],
    } | ({} if chart is None else {"map": chart})
    return mission_from(data, Source(str(path)), [])


def _files(path: Path) -> list[Path]:
    if not path.is_dir():
        return [path]
    found = [file for file in path.iterdir() if file.suffix.lower() == ".plan"]
    if not found:
        raise MissionError(
            [Finding(str(path), None, "", "Is a directory", "a file to read, or a folder of .plan files")]
        )
    return [found[k] for k in tie_order([file.stem for file in found])]


def _robot(vehicle: _Vehicle, position: list[float], metres: Callable[[Degrees], list[float]]) -> dict[str, Any]:
    data: dict[str, Any] = {
        "id": vehicle.name,
        "position": position,
        "speed_mps": vehicle.speed_mps,
        "kind": vehicle.kind,
    }
    if vehicle.returns:
        return data | {"return_to_start": True}
    here = vehicle.stops[-1][1] if vehicle.stops else vehicle.home
    if vehicle.lands_at is None or _over(vehicle.lands_at, here):
        return data
    return data | {"end_position": metres(vehicle.lands_at)}


def _over(a: Degrees, b: Degrees) -> bool:
    """Whether two places differ in height alone."""
    (apart,) = wgs84_to_enu([(*a[:2], b[2])], b)
    return math.hypot(*apart[:2]) < _SAME_PLACE_M


class _Reading:
    """Reads one file; the first error is raised."""

    def __init__(self, file: Path) -> None:
        self._file = file
        self._home: Degrees = (0.0, 0.0, 0.0)

    def vehicle(self) -> _Vehicle:
        data = self._json()
        if data.get("fileType") != "Plan":
            raise self._refused("fileType", data.get("fileType"), '"Plan"')
        mission = self._of(data, "mission", dict, "a mapping", "mission")
        if mission.get("version") != 2:
            raise self._refused("mission.version", mission.get("version"), "2")
        self._home = self._place(mission.get("plannedHomePosition"), "mission.plannedHomePosition")
        items = self._of(mission, "items", list, "a list of items", "mission.items")
        commands = list(self._commands(items))
        stops = tuple(
            (k + 1, self._spot(item, at), self._hold(item, at)) for k, item, at in commands if item["command"] in _STOPS
        )
        landings = [self._spot(item, at) for _, item, at in commands if item["command"] == qgc.NAV_LAND]
        return _Vehicle(
            name=self._file.stem,
            home=self._home,
            ground=mission.get("vehicleType") in (qgc.GROUND_ROVER, qgc.SURFACE_BOAT),
            speed_mps=self._speed(mission, items),
            stops=stops,
            returns=any(item["command"] == qgc.NAV_RETURN_TO_LAUNCH for _, item, _ in commands),
            lands_at=landings[-1] if landings else None,
            fences=self._fences(data.get("geoFence", {})),
        )

    def without_boundary(self) -> MissionError:
        """The error for a fence with no boundary, several, or another than the other files have."""
        expected = "one polygon with inclusion, the same in all files"
        return MissionError(
            [Finding(str(self._file), None, "geoFence.polygons", "not the mission's boundary", expected)]
        )

    def _fences(self, data: object) -> Fences:
        if not isinstance(data, dict):
            raise self._refused("geoFence", data, "a mapping with polygons")
        if data.get("circles"):
            raise self._refused("geoFence.circles", data["circles"], "none: polygons alone are read")
        rings: dict[bool, list[tuple[Corner, ...]]] = {True: [], False: []}
        for k, polygon in enumerate(data.get("polygons") or []):
            at = f"geoFence.polygons[{k}]"
            inside = polygon.get("inclusion") if isinstance(polygon, dict) else polygon
            if not isinstance(inside, bool):
                raise self._refused(f"{at}.inclusion", inside, "true or false")
            corners = self._of(polygon, "polygon", list, "a list of corners", f"{at}.polygon")
            rings[inside].append(tuple(self._corner(c, f"{at}.polygon[{j}]") for j, c in enumerate(corners)))
        return Fences(tuple(rings[True]), tuple(rings[False]))

    def _corner(self, value: object, at: str) -> Corner:
        if not isinstance(value, list) or len(value) != 2:
            raise self._refused(at, value, "[latitude, longitude] in degrees")
        return self._place([*value, 0.0], at)[:2]

    def _json(self) -> dict[str, Any]:
        try:
            data = json.loads(read_text(self._file))
        except json.JSONDecodeError as error:
            finding = Finding(str(self._file), error.lineno, "", error.msg, "a QGroundControl plan in JSON")
            raise MissionError([finding]) from None
        except (RecursionError, ValueError) as error:
            raise self._refused("", str(error), "a QGroundControl plan in JSON") from None
        if not isinstance(data, dict):
            raise self._refused("", data, "a mapping with fileType, mission and version")
        return data

    def _commands(self, items: Sequence[Any]) -> Iterator[tuple[int, dict[str, Any], str]]:
        """The items with a position: index, item, and place in the file."""
        for k, item in enumerate(items):
            at = f"mission.items[{k}]"
            if not isinstance(item, dict) or item.get("type") != "SimpleItem":
                kind = item.get("complexItemType", item.get("type")) if isinstance(item, dict) else item
                raise self._refused(f"{at}.type", kind, '"SimpleItem": surveys and scans are not read')
            command = item.get("command")
            if not isinstance(command, int) or isinstance(command, bool):
                raise self._refused(f"{at}.command", command, "a number of MAV_CMD")
            if command in _READ:
                yield k, item, at
            elif command <= qgc.NAV_LAST:
                raise self._refused(f"{at}.command", command, f"one of {', '.join(map(str, _READ))}, or no navigation")

    def _spot(self, item: dict[str, Any], at: str) -> Degrees:
        frame = item.get("frame")
        if frame not in _FRAMES:
            raise self._refused(f"{at}.frame", frame, f"one of {', '.join(map(str, sorted(_FRAMES)))}")
        lat, lon, height = self._place(self._params(item, at)[4:], f"{at}.params[4:]")
        return (lat, lon, self._home[2] + height) if frame in _RELATIVE else (lat, lon, height)

    def _hold(self, item: dict[str, Any], at: str) -> float:
        hold = self._params(item, at)[0]
        if hold is None:
            return 0.0
        if not _is_number(hold) or hold < 0:
            raise self._refused(f"{at}.params[0]", hold, "seconds of at least 0")
        return float(hold)

    def _params(self, item: dict[str, Any], at: str) -> list[Any]:
        params = item.get("params")
        if not isinstance(params, list) or len(params) != 7:
            raise self._refused(f"{at}.params", params, "a list of 7")
        return params

    def _place(self, value: object, at: str) -> Degrees:
        if not isinstance(value, list) or len(value) != 3 or not all(map(_is_number, value)):
            raise self._refused(at, value, "latitude and longitude in degrees, altitude in metres")
        lat, lon, height = (float(number) for number in value)
        if abs(lat) > 90 or abs(lon) > 180:
            raise self._refused(at, value, "a latitude from -90 to 90, then a longitude from -180 to 180")
        return lat, lon, height

    def _speed(self, mission: dict[str, Any], items: Sequence[dict[str, Any]]) -> float:
        """The first speed that an item sets, else that of the plan."""
        for k, item in enumerate(items):
            if item.get("command") == qgc.DO_CHANGE_SPEED:
                speed = self._params(item, f"mission.items[{k}]")[1]
                if _is_number(speed) and speed > 0:
                    return float(speed)
        speed = mission.get("hoverSpeed")
        if not _is_number(speed) or not speed > 0:
            raise self._refused("mission.hoverSpeed", speed, "metres a second above 0")
        return float(speed)

    def _of(self, data: dict[str, Any], key: str, kind: type, expected: str, at: str) -> Any:
        if not isinstance(data.get(key), kind):
            raise self._refused(at, data.get(key), expected)
        return data[key]

    def _refused(self, field: str, value: object, expected: str) -> MissionError:
        told = "missing" if value is None else shown(value)
        return MissionError([Finding(str(self._file), None, field, told, expected)])


def _is_number(value: Any) -> TypeGuard[float]:
    """Whether a value of JSON is a finite number."""
    return isinstance(value, int | float) and not isinstance(value, bool) and abs(value) < 1e300
