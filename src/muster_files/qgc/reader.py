"""QGroundControl plan files as a mission: one robot a file, every way point a task, the first home the origin.

A way point's hold is the task's duration, a survey an area to cover. The order of way points is not kept, since Muster
plans it anew; rounds of a jump follow each other. Way points of take-off, landing and return to launch give the end
position. Fences become the map.

The vehicles of plan files (MAV_TYPE): where they move, and which speed of the plan is theirs.

Source: MAVLink, `common.xml`; QGroundControl developer guide, "Plan File Format": `hoverSpeed` is of multi-rotors,
`cruiseSpeed` of fixed wings, rovers and boats.
"""

from __future__ import annotations

import json
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Literal

from muster.mission.errors import Finding, MissionError
from muster.mission.import_ledger import EMPTY, Fate, LedgerBook, passed_over
from muster.mission.plan import tie_order
from muster.mission.texts.text_files import LARGEST_FILE, read_text
from muster.planning.mission_readers import Noted
from muster_files.qgc import plan_format as qgc
from muster_files.qgc.commands import name_of, param_of
from muster_files.qgc.fences import read_fences
from muster_files.qgc.fields import Degrees, PlanFields
from muster_files.qgc.flight import Command, Flight, flight_of, require_near
from muster_files.qgc.flight_missions import FlownFile, mission_of
from muster_files.qgc.survey_reader import Survey, read_survey
from muster_files.sites.file_sizes import require_moderate_json
from muster_files.tracked_json import Tracked, enter_json, parse_tracked

_HOVER, _CRUISE = ("hoverSpeed",), ("cruiseSpeed",)


@dataclass(frozen=True)
class Vehicle:
    """A type of vehicle: where it moves, its speeds in a plan, of which the slowest is taken, and what is not kept."""

    kind: Literal["ground", "air"]
    speeds: tuple[str, ...]
    note: str = ""


_WINGED = "a fixed wing: here it stops at every stop, and flies straight between them"
_VTOL = "a VTOL: here it stops at every stop, at the slower of hoverSpeed and cruiseSpeed"
VEHICLES = {
    **dict.fromkeys((0, qgc.QUADROTOR, 3, 4, 13, 14, 15, 29, 35, 43), Vehicle("air", _HOVER)),
    1: Vehicle("air", _CRUISE, _WINGED),
    **dict.fromkeys((*range(19, 26), 47), Vehicle("air", (*_HOVER, *_CRUISE), _VTOL)),
    **dict.fromkeys((qgc.GROUND_ROVER, 11, 46), Vehicle("ground", _CRUISE)),
}
_NAMED = {5: "ANTENNA_TRACKER", 6: "GCS", 7: "AIRSHIP", 8: "FREE_BALLOON", 9: "ROCKET", 12: "SUBMARINE"}
EXPECTED = "a copter, a fixed wing, a VTOL, a rover or a boat"


def told_vehicle(number: object) -> str:
    """Return a type as errors name it: `MAV_TYPE_SUBMARINE (12)`."""
    return f"MAV_TYPE_{_NAMED[number]} ({number})" if isinstance(number, int) and number in _NAMED else str(number)


_TWICE = passed_over("stands in the parameters too", minor=True)
_RALLY = passed_over("is a point to go to in an emergency: Muster's drones return or land")
_SAID = passed_over("is said anew by what is exported", minor=True)


def read_flight_plans(path: str | Path, origin: Sequence[float] | None = None) -> Noted:
    """The mission of a `.plan` file, or of all `.plan` files in a folder, with what became of each element.

    The mission is in the plane if all vehicles are rovers or boats. `origin` as `mission_of` has it.

    Raises
    ------
    MissionError
        with the errors of the first wrong file, or of the first with another boundary.
    MissingExtraError
        if pymap3d is not installed.
    """
    path = Path(path)
    return mission_of(path, [_Reading(file).file() for file in _files(path)], origin)


def _files(path: Path) -> list[Path]:
    if not path.is_dir():
        return [path]
    found = [file for file in path.iterdir() if file.suffix.lower() == ".plan"]
    if not found:
        raise MissionError(
            [Finding(str(path), None, "", "Is a directory", "a file to read, or a folder of .plan files")]
        )
    return [found[k] for k in tie_order([file.stem for file in found])]


class _Document:
    """The members of a plan, and the parameters of its commands that say anything."""

    def __init__(self, root: Tracked) -> None:
        self._root = root
        self.commands: dict[int, tuple[Command, int]] = {}
        """By the id of their items, each with how many parameters stand in its list."""

    def enter(self, book: LedgerBook) -> None:
        """Give the ledger every member and parameter."""
        enter_json(book, self._root, self._fate)
        for command, own in self.commands.values():
            for k, value in enumerate(command.params[:own]):
                if value is not None:
                    kind = name_of(command.command)
                    kind += "" if command.whole else f" {param_of(command.command, k)}"
                    book.add(kind, command.fate(k), command.names[k])

    def _fate(self, item: Tracked, _: str) -> Fate | None:
        command = self.commands.get(id(item))
        return None if command is None else command[0].whole


class _Reading:
    """Reads one file; the first error is raised."""

    def __init__(self, file: Path) -> None:
        self._file = file
        self._fields = PlanFields(file)
        self._home: Degrees = (0.0, 0.0, 0.0)

    def file(self) -> FlownFile:
        data = self._json()
        self._document = _Document(data)
        if data.get("fileType") != "Plan":
            raise self._fields.refused("fileType", data.get("fileType"), '"Plan"')
        self._fields.require_version(data, "", 1)
        mission = self._fields.of(data, "mission", Tracked, "a mapping", "mission")
        if mission.get("version") != 2:
            raise self._fields.refused("mission.version", mission.get("version"), "2")
        self._home = self._fields.place(mission.get("plannedHomePosition"), "mission.plannedHomePosition")
        items = self._fields.of(mission, "items", list, "a list of items", "mission.items")
        surveys = [survey for k, item in enumerate(items) if (survey := self._survey(k, item)) is not None]
        ends = {s.number: None if s.ends_at is None else (*s.ends_at, self._home[2]) for s in surveys}
        commands = [self._command(k, item) for k, item in enumerate(items) if k + 1 not in ends]
        flight = flight_of(commands, ends, self._home)
        vehicle = self._vehicle(mission)
        data.say(_SAID, "groundStation")
        if isinstance(rally := data.get("rallyPoints"), Tracked):
            self._fields.require_version(rally, "rallyPoints", 1, 2)
            rally.say(_RALLY if rally.peek("points") else EMPTY, "points")
        mission.say(_SAID, "firmwareType", "globalPlanAltitudeMode")
        return FlownFile(
            name=self._file.stem,
            fields=self._fields,
            home=self._home,
            kind=vehicle.kind,
            speed_mps=self._speed(mission, vehicle, flight),
            flight=flight,
            surveys=tuple(surveys),
            fences=read_fences(self._fields, data.get("geoFence", {}), self._home),
            notes=self._notes(mission, vehicle, flight),
            document=self._document,
        )

    def _json(self) -> Tracked:
        text = read_text(self._file, LARGEST_FILE)
        require_moderate_json(text, str(self._file))
        try:
            data = parse_tracked(text)
        except json.JSONDecodeError as error:
            finding = Finding(str(self._file), error.lineno, "", error.msg, "a QGroundControl plan in JSON")
            raise MissionError([finding]) from None
        except (RecursionError, ValueError) as error:
            raise self._fields.refused("", str(error), "a QGroundControl plan in JSON") from None
        if not isinstance(data, Tracked):
            raise self._fields.refused("", data, "a mapping with fileType, mission and version")
        return data

    def _vehicle(self, mission: Tracked) -> Vehicle:
        number = mission.get("vehicleType", qgc.QUADROTOR)
        if isinstance(number, bool) or not isinstance(number, int) or number not in VEHICLES:
            raise self._fields.refused_as("mission.vehicleType", told_vehicle(number), EXPECTED)
        return VEHICLES[number]

    def _notes(self, mission: Tracked, vehicle: Vehicle, flight: Flight) -> tuple[str, ...]:
        found = [] if "vehicleType" in mission else ["vehicleType is missing: taken for a copter"]
        found += [vehicle.note] if vehicle.note else []
        speeds = sorted({*flight.speeds})
        if len(speeds) > 1:
            found.append(
                f"the slowest of its speeds is taken, {speeds[0]:g} m/s of {', '.join(f'{s:g}' for s in speeds)}"
            )
        return tuple(f"{self._file}: {note}" for note in found)

    def _survey(self, k: int, item: Any) -> Survey | None:
        """The survey that an item is; None for any other."""
        if not isinstance(item, Tracked) or item.get("complexItemType") != "survey":
            return None
        item.label = "survey"
        item.get("type")
        found = read_survey(self._fields, item, f"mission.items[{k}]", k + 1)
        for corner in found.corners:
            require_near(self._fields, corner, self._home, f"mission.items[{k}].polygon")
        return found

    def _command(self, k: int, item: Any) -> Command:
        at = f"mission.items[{k}]"
        if not isinstance(item, Tracked) or item.get("type") != "SimpleItem":
            kind = item.get("complexItemType", item.get("type")) if isinstance(item, Tracked) else item
            expected = '"SimpleItem", or a survey: scans and landing patterns are not read'
            raise self._fields.refused(f"{at}.type", kind, expected)
        number, sequence = item.get("command"), item.get("doJumpId")
        if not isinstance(number, int) or isinstance(number, bool):
            raise self._fields.refused(f"{at}.command", number, "a number of MAV_CMD")
        names: dict[int | str, str] = {j: f"{at}.params[{j}]" for j in range(7)}
        others = {key: f"{at}.{key}" for key in ("command", "frame")}
        command = Command(
            self._fields,
            k + 1,
            sequence if isinstance(sequence, int) else None,
            number,
            item.get("frame"),
            self._params(item, at),
            names | others | {"place": f"{at}.params[4:]"},
        )
        if item.get("autoContinue", True) is not True:
            raise self._fields.refused(f"{at}.autoContinue", item["autoContinue"], "true: no wait for a pilot")
        item.label = name_of(number)
        item.say(_TWICE, "Altitude", "AltitudeMode", "AMSLAltAboveTerrain")
        self._document.commands[id(item)] = command, len(item["params"])
        return command

    def _params(self, item: Tracked, at: str) -> list[Any]:
        """The seven parameters of a command; older files have the place apart, as `coordinate`."""
        params, place = item.get("params"), item.peek("coordinate")
        if isinstance(params, list) and len(params) == 4 and isinstance(place, list) and len(place) == 3:
            return [*params, *item["coordinate"]]
        if not isinstance(params, list) or len(params) != 7:
            raise self._fields.refused(f"{at}.params", params, "a list of 7")
        if place is not None and place != params[4:]:
            raise self._fields.refused(f"{at}.coordinate", place, "the place in the parameters")
        item.say(_TWICE, "coordinate")
        return params

    def _speed(self, mission: Tracked, vehicle: Vehicle, flight: Flight) -> float:
        """The slowest speed of a flight: of those that items set, and that of the plan where none is set at first."""
        speeds = list(flight.speeds)
        if flight.late or not speeds:
            expected = "metres a second above 0"
            speeds += [self._fields.positive(mission, key, expected, f"mission.{key}") for key in vehicle.speeds]
        else:
            mission.say(passed_over("is not read, as the first command sets a speed", minor=True), *vehicle.speeds)
        others = [key for key in ("hoverSpeed", "cruiseSpeed") if key not in vehicle.speeds]
        mission.say(passed_over("is the speed of another kind of vehicle", minor=True), *others)
        return min(speeds)
