"""What a column may say: the keys of places, tasks, robots, stations, zones and lanes, with the names that people use.

The names of keys are those of mission files; those that a mission file has not (`lat`, `opens`) are marked by what the
site's builder makes of them.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field, fields
from functools import cache, partial
from typing import Any

from muster.exchange.sites import cells
from muster.exchange.sites.units import UNITS, Dimension
from muster.mission.action_keys import ACTION_KEYS
from muster.mission.records import key_of, specified
from muster.mission.value_types import Choice, Flag, Kind, Many, Number, OneOrMany, Text, Whole

Read = Callable[..., Any]

COVERAGE = "coverage"
"""The action of surveys."""


@dataclass(frozen=True)
class SiteKey:
    """One thing that a column may say.

    Parameters
    ----------
    read
        makes of a cell, and of what one unit of the heading is in SI units where it has a dimension, the value.
    names
        headings that mean it, besides its own name; lower case, without spaces and marks.
    is_free
        whether other words than units may stand in brackets: `load (boxes)`, `lat (WGS84)`.
    unstated
        headings with what one unit of their numbers is where they do not say it.
    """

    name: str
    read: Read
    dimension: Dimension = ""
    names: tuple[str, ...] = ()
    is_free: bool = False
    unstated: Mapping[str, float] = field(default_factory=dict)


def _length(name: str, *names: str) -> SiteKey:
    return SiteKey(name, partial(_number, "length"), "length", names)


def _angle(name: str, read: Read, *names: str) -> SiteKey:
    return SiteKey(name, read, "angle", names, is_free=True)


def _mass(name: str, *names: str) -> SiteKey:
    return SiteKey(name, cells.amount, "mass", names, is_free=True)


def _number(dimension: Dimension, value: object, factor: float = 1.0) -> float:
    return cells.number(value, dimension, factor)


def _lower(value: object) -> str:
    return cells.text(value).casefold()


def _choices(value: object) -> list[str]:
    """Words of a few letters, between which spaces may stand."""
    return [part for one in cells.words(value) for part in one.casefold().split()]


PLACE = (
    _angle("lat", partial(cells.degrees, most=90.0), "latitude", "latdeg", "latitudedeg", "latwgs84", "gpslat"),
    _angle(
        "lon",
        partial(cells.degrees, most=180.0),
        *("lng", "long", "longitude", "londeg", "lngdeg", "longitudedeg", "lonwgs84", "gpslon", "gpslong"),
    ),
    _angle(
        "lat_lon",
        cells.lat_lon,
        *("latlng", "latlong", "latitudelongitude", "coordinates", "coordinate", "coords", "gps"),
    ),
    _length("alt", "altitude", "elevation", "ele", "altm"),
    _length("x", "east"),
    _length("y", "north"),
    _length("z", "height", "heightm"),
    SiteKey("position", cells.point, names=("xy", "xyz")),
    SiteKey("wkt", cells.text, names=("geometry", "geom", "wktgeom", "thegeom")),
)
IDENTITY = (
    SiteKey("id", cells.text, names=("index", "no", "nr", "number", "key", "code", "ref")),
    SiteKey("name", cells.text, names=("title", "label")),
)
ROLE = SiteKey("kind", _lower, names=("role", "feature", "featurekind"))
_TASK = (
    SiteKey("id", cells.text, names=(*IDENTITY[0].names, "task")),
    SiteKey("type", cells.text, names=("category", "class")),
    SiteKey(
        "duration_s",
        cells.duration,
        "time",
        ("duration", "durations", "servicetime", "service", "worktime", "staytime", "dwell", "dwelltime", "timeneeded"),
    ),
    SiteKey(
        "opens",
        cells.moment,
        "time",
        ("from", "open", "earliest", "earlieststart", "windowfrom", "windowstart", "notbefore", "readytime", "opensat"),
    ),
    SiteKey(
        "closes",
        cells.moment,
        "time",
        ("to", "until", "close", "latest", "lateststart", "windowto", "windowuntil", "windowend", "closesat"),
    ),
    SiteKey("window", cells.pairs, "time", ("windows", "timewindow", "timewindows", "hours", "openinghours")),
    SiteKey("deadline", cells.moment, "time", ("finishby", "mustend", "mustendby", "by", "endby", "doneby")),
    SiteKey("due", cells.moment, "time", ("duetime", "dueat", "duedate", "dueby")),
    SiteKey("priority", cells.number, names=("prio", "weight", "importance")),
    SiteKey(
        "prerequisites",
        cells.words,
        names=("prerequisite", "after", "dependson", "dependencies", "predecessor", "predecessors"),
    ),
    SiteKey(
        "requires",
        cells.words,
        names=("skills", "skill", "requiredskills", "requiredskill", "equipment", "capabilities"),
    ),
    SiteKey("actuation_cost", cells.number, names=("cost", "workcost")),
    SiteKey("robots_needed", cells.whole, names=("robotsneeded", "teamsize", "crew")),
    _mass("load", "demand", "amount", "quantity", "weight", "mass"),
)
_ROBOT = (
    SiteKey("id", cells.text, names=(*IDENTITY[0].names, "robot", "callsign")),
    SiteKey("type", cells.text, names=("model", "class")),
    SiteKey("moves", _lower, names=("domain",)),
    SiteKey("speed_mps", partial(_number, "speed"), "speed", ("speed", "maxspeed", "velocity", "cruisespeed")),
    SiteKey("work_capacity", cells.limit, names=("capacity", "budget", "range")),
    SiteKey("skills", cells.words, names=("skill", "capabilities", "equipment")),
    _length("radius_m", "radius"),
    SiteKey("heading_deg", partial(_number, "angle"), "angle", ("heading", "yaw")),
    _mass("load_capacity", "payload", "capacity"),
    SiteKey("battery", cells.number, names=("batterycapacity",)),
    SiteKey("climb_mps", partial(_number, "speed"), "speed", ("climb", "climbspeed")),
    SiteKey("starts", cells.moment, "time", ("from", "availablefrom", "shiftstart", "start", "earliest")),
    SiteKey("ends", cells.moment, "time", ("to", "until", "availableuntil", "shiftend", "end", "latest")),
    SiteKey("shift", cells.pairs, "time", ("shifts", "hours", "availability")),
)
_STATION = (
    SiteKey("id", cells.text, names=(*IDENTITY[0].names, "station")),
    SiteKey("services", _choices, names=("service",)),
    SiteKey("charge_per_s", cells.number, names=("charge", "chargerate")),
    SiteKey("swap_s", cells.duration, "time", ("swap", "swaptime")),
)
_DOOR = SiteKey("door", cells.text, names=("doorid",))
_ZONE = (
    _DOOR,
    _length("floor_m", "floor", "minheight", "lowerlimit"),
    _length("ceiling_m", "ceiling", "maxheight", "upperlimit"),
    SiteKey("forbidden_to", _choices, names=("closedto", "forbidden")),
)
_LANE = (
    _DOOR,
    _length("width_m", "width"),
    SiteKey(
        "speed_mps",
        partial(_number, "speed"),
        "speed",
        ("speed", "maxspeed", "speedlimit"),
        unstated={"maxspeed": UNITS["speed"]["km/h"]},  # that of OpenStreetMap
    ),
    SiteKey("capacity", cells.whole),
    SiteKey("one_way", cells.flag, names=("oneway",)),
    SiteKey("both_ways", cells.flag, names=("bothways", "bidirectional", "twoway")),
)
_OF_ROLES: Mapping[str, tuple[SiteKey, ...]] = {
    "task": _TASK,
    "robot": _ROBOT,
    "station": _STATION,
    "zone": _ZONE,
    "boundary": (),
    "survey": _TASK,
    "lane": _LANE,
    "route": (),
}
ROLES = tuple(_OF_ROLES)
"""What a feature may be. A route is that of a plan, and is not read."""

AT_POINTS = ("task", "robot", "station")
"""Roles of points; the others are those of areas and lines."""

_INSTEAD = frozenset(
    ("id", "position", "window_s", "deadline_s", "due_s", "available_from_s", "available_until_s", "polygon", "extra")
)
"""Keys of a mission that other columns say here, or none."""


def keys_of(role: str) -> Mapping[str, SiteKey]:
    """The keys that features of a role may have, by name: those named here, then all others of a mission file."""
    return _keys_of(role, can_survey())


def can_survey() -> bool:
    """Whether the action of surveys is there."""
    return COVERAGE in ACTION_KEYS


@cache
def _keys_of(role: str, surveys: bool) -> Mapping[str, SiteKey]:
    place = PLACE if role in AT_POINTS else PLACE[-1:]
    own = {key.name: key for key in (*place, *IDENTITY, ROLE, *_OF_ROLES[role])}
    for name, kind in _mission_keys(role, surveys).items():
        if name not in own and name not in _INSTEAD and (read := _reading(kind)) is not None:
            own[name] = SiteKey(name, read, _dimension(name) if isinstance(kind, Number) else "")
    return own


def _mission_keys(role: str, surveys: bool) -> Mapping[str, Kind]:
    from muster.mission.model import Action, Robot, Station, Task, Zone

    classes: dict[str, type[Any]] = {"task": Task, "survey": Task, "robot": Robot, "station": Station, "zone": Zone}
    found = {} if role not in classes else {key_of(f): f.metadata["kind"] for f in specified(classes[role])}
    if role == "survey" and surveys:
        action = ACTION_KEYS[COVERAGE]
        of_action = {f.name: f.metadata["kind"] for f in fields(Action) if "kind" in f.metadata}
        of_action |= {name: key.kind for name, key in action.own.items()}
        found = {name: of_action[name] for name in action.names if name in of_action} | found
    return found


def _reading(kind: Kind) -> Read | None:
    """How cells of a kind of value are read; None for what no cell can hold."""
    match kind:
        case Number():
            return cells.number
        case Whole():
            return cells.whole
        case Flag():
            return cells.flag
        case Choice():
            return _lower
        case Text():
            return cells.text
        case Many() | OneOrMany() if isinstance(kind.kind, Choice):
            return _choices
        case Many() | OneOrMany() if isinstance(kind.kind, Text):
            return cells.words
    return None


def _dimension(name: str) -> Dimension:
    endings: dict[str, Dimension] = {"_s": "time", "_m": "length", "_mps": "speed", "_deg": "angle"}
    return next((dimension for ending, dimension in endings.items() if name.endswith(ending)), "")
