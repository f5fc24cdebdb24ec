"""QGroundControl plan files as a mission: one robot a file, every way point a task, the first home the origin.

A way point's hold is the task's duration, a survey an area to cover. The order of way points is not kept, since Muster
plans it anew. Way points of take-off, landing and return to launch give the end position. Fences become the map.
"""

from __future__ import annotations

import json
import math
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from muster.exchange import qgc_format as qgc
from muster.exchange.qgc_fences import Corner, Fences, map_of
from muster.exchange.qgc_fields import Degrees, PlanFields, is_number
from muster.exchange.qgc_survey_reader import Survey, read_survey
from muster.mission.errors import Finding, MissionError
from muster.mission.from_data import mission_from
from muster.mission.geodesy import wgs84_to_enu
from muster.mission.model import SCHEMA, Mission
from muster.mission.plan import tie_order
from muster.mission.source import Source
from muster.mission.text_files import read_text

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
    surveys: tuple[Survey, ...]
    returns: bool
    lands_at: Degrees | None
    fences: Fences

    @property
    def kind(self) -> str:
        return "ground" if self.ground else "air"

    @property
    def last_at(self) -> Degrees:
        """Where it is after its last stop or survey."""
        ends = {number: place for number, place, _ in self.stops}
        ends |= {survey.number: (*survey.ends_at, self.home[2]) for survey in self.surveys if survey.ends_at}
        return ends[max(ends)] if ends else self.home


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
        "tasks": [task for vehicle in vehicles for task in _tasks(vehicle, metres)],
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


def _tasks(vehicle: _Vehicle, metres: Callable[[Degrees], list[float]]) -> Iterator[dict[str, Any]]:
    stops = {
        number: {"position": metres(place)} | ({"duration_s": hold} if hold else {})
        for number, place, hold in vehicle.stops
    }
    surveys = {
        survey.number: {"action": survey.action([metres((*at, vehicle.home[2]))[:2] for at in survey.corners])}
        for survey in vehicle.surveys
    }
    for number, task in sorted((stops | surveys).items()):
        yield {"id": f"{vehicle.name}-{number}"} | task


def _robot(vehicle: _Vehicle, position: list[float], metres: Callable[[Degrees], list[float]]) -> dict[str, Any]:
    data: dict[str, Any] = {
        "id": vehicle.name,
        "position": position,
        "speed_mps": vehicle.speed_mps,
        "kind": vehicle.kind,
    }
    if (lens := next((survey.lens for survey in vehicle.surveys if survey.lens), None)) is not None:
        data["camera"] = lens.camera()
    if vehicle.returns:
        return data | {"return_to_start": True}
    if vehicle.lands_at is None or _over(vehicle.lands_at, vehicle.last_at):
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
        self._fields = PlanFields(file)
        self._home: Degrees = (0.0, 0.0, 0.0)

    def vehicle(self) -> _Vehicle:
        data = self._json()
        if data.get("fileType") != "Plan":
            raise self._fields.refused("fileType", data.get("fileType"), '"Plan"')
        mission = self._fields.of(data, "mission", dict, "a mapping", "mission")
        if mission.get("version") != 2:
            raise self._fields.refused("mission.version", mission.get("version"), "2")
        self._home = self._fields.place(mission.get("plannedHomePosition"), "mission.plannedHomePosition")
        items = self._fields.of(mission, "items", list, "a list of items", "mission.items")
        surveys = {k: survey for k, item in enumerate(items) if (survey := self._survey(k, item)) is not None}
        commands = list(self._commands([(k, item) for k, item in enumerate(items) if k not in surveys]))
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
            surveys=tuple(surveys.values()),
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
            raise self._fields.refused("geoFence", data, "a mapping with polygons")
        if data.get("circles"):
            raise self._fields.refused("geoFence.circles", data["circles"], "none: polygons alone are read")
        rings: dict[bool, list[tuple[Corner, ...]]] = {True: [], False: []}
        for k, polygon in enumerate(data.get("polygons") or []):
            at = f"geoFence.polygons[{k}]"
            inside = polygon.get("inclusion") if isinstance(polygon, dict) else polygon
            if not isinstance(inside, bool):
                raise self._fields.refused(f"{at}.inclusion", inside, "true or false")
            rings[inside].append(self._fields.corners(polygon, "polygon", f"{at}.polygon"))
        return Fences(tuple(rings[True]), tuple(rings[False]))

    def _json(self) -> dict[str, Any]:
        try:
            data = json.loads(read_text(self._file))
        except json.JSONDecodeError as error:
            finding = Finding(str(self._file), error.lineno, "", error.msg, "a QGroundControl plan in JSON")
            raise MissionError([finding]) from None
        except (RecursionError, ValueError) as error:
            raise self._fields.refused("", str(error), "a QGroundControl plan in JSON") from None
        if not isinstance(data, dict):
            raise self._fields.refused("", data, "a mapping with fileType, mission and version")
        return data

    def _survey(self, k: int, item: Any) -> Survey | None:
        """The survey that an item is; None for any other."""
        if not isinstance(item, dict) or item.get("complexItemType") != "survey":
            return None
        return read_survey(self._fields, item, f"mission.items[{k}]", k + 1)

    def _commands(self, items: Sequence[tuple[int, Any]]) -> Iterator[tuple[int, dict[str, Any], str]]:
        """The items with a position: index, item, and place in the file."""
        for k, item in items:
            at = f"mission.items[{k}]"
            if not isinstance(item, dict) or item.get("type") != "SimpleItem":
                kind = item.get("complexItemType", item.get("type")) if isinstance(item, dict) else item
                expected = '"SimpleItem", or a survey: scans and landing patterns are not read'
                raise self._fields.refused(f"{at}.type", kind, expected)
            command = item.get("command")
            if not isinstance(command, int) or isinstance(command, bool):
                raise self._fields.refused(f"{at}.command", command, "a number of MAV_CMD")
            if command in _READ:
                yield k, item, at
            elif command <= qgc.NAV_LAST:
                expected = f"one of {', '.join(map(str, _READ))}, or no navigation"
                raise self._fields.refused(f"{at}.command", command, expected)

    def _spot(self, item: dict[str, Any], at: str) -> Degrees:
        frame = item.get("frame")
        if frame not in _FRAMES:
            raise self._fields.refused(f"{at}.frame", frame, f"one of {', '.join(map(str, sorted(_FRAMES)))}")
        lat, lon, height = self._fields.place(self._params(item, at)[4:], f"{at}.params[4:]")
        return (lat, lon, self._home[2] + height) if frame in _RELATIVE else (lat, lon, height)

    def _hold(self, item: dict[str, Any], at: str) -> float:
        hold = self._params(item, at)[0]
        if hold is None:
            return 0.0
        if not is_number(hold) or hold < 0:
            raise self._fields.refused(f"{at}.params[0]", hold, "seconds of at least 0")
        return float(hold)

    def _params(self, item: dict[str, Any], at: str) -> list[Any]:
        params = item.get("params")
        if not isinstance(params, list) or len(params) != 7:
            raise self._fields.refused(f"{at}.params", params, "a list of 7")
        return params

    def _speed(self, mission: dict[str, Any], items: Sequence[dict[str, Any]]) -> float:
        """The first speed that an item sets, else that of the plan."""
        for k, item in enumerate(items):
            if item.get("command") == qgc.DO_CHANGE_SPEED:
                speed = self._params(item, f"mission.items[{k}]")[1]
                if is_number(speed) and speed > 0:
                    return float(speed)
        return self._fields.positive(mission, "hoverSpeed", "metres a second above 0", "mission.hoverSpeed")
