"""What a column may say: the keys of places, tasks, robots, stations, zones and lanes, with the names that people use.

The names of keys are those of mission files; those that a mission file has not (`lat`, `opens`) are marked by what the
site's builder makes of them.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field, fields
from functools import cache, partial
from typing import Any

from muster.exchange.sites import cells, energy_cells
from muster.exchange.sites import key_words as words
from muster.exchange.sites.energy_cells import COLUMNS
from muster.exchange.sites.units import UNITS, Dimension
from muster.exchange.sites.vocabulary import moves
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
    needs_unit
        whether a number without a unit, in the heading or beside it, is refused.
    right
        what is right, where a unit does not fit; by default the units of the dimension.
    rare
        of `names` those that often mean something else: such a column is read only if one of its cells can be.
    """

    name: str
    read: Read
    dimension: Dimension = ""
    names: tuple[str, ...] = ()
    is_free: bool = False
    unstated: Mapping[str, float] = field(default_factory=dict)
    needs_unit: bool = False
    right: str = ""
    rare: frozenset[str] = frozenset()


def _length(name: str, *names: str) -> SiteKey:
    return SiteKey(name, partial(_number, "length"), "length", names)


def _level(name: str, *names: str) -> SiteKey:
    """A height of a zone; storeys and the like, under the same headings, are not read: all heights are closed then."""
    read = partial(_number, "length")
    return SiteKey(name, read, "length", names, needs_unit=True, rare=frozenset(names))


def _angle(name: str, read: Read, *names: str) -> SiteKey:
    return SiteKey(name, read, "angle", names, is_free=True)


def _mass(name: str, *names: str) -> SiteKey:
    return SiteKey(name, cells.amount, "mass", names, is_free=True)


def _number(dimension: Dimension, value: object, factor: float = 1.0) -> float:
    return cells.number(value, dimension, factor)


def _lower(value: object) -> str:
    return cells.text(value).casefold()


def _kinds_of_robots(value: object) -> list[str]:
    """Kinds of robots, as mission files have them, of words for such: `air`, `drones and UGVs`, `all`."""
    found: list[str] = []
    for word in _choices(value):
        kind = moves(word)
        kinds = ["ground", "air"] if word in ("all", "both", "everything", "robots", "yes", "true") else [kind]
        found += [one or word for one in kinds if word not in ("and", "&")]
    return list(dict.fromkeys(found))


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
    SiteKey("name", cells.text, names=words.NAMES),
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
        rare=frozenset(("service",)),
    ),
    SiteKey(
        "opens",
        cells.moment,
        "time",
        ("from", "open", "earliest", "earlieststart", "windowfrom", "windowstart", "notbefore", "readytime", "opensat"),
        rare=frozenset(("from", "open")),
    ),
    SiteKey(
        "closes",
        cells.moment,
        "time",
        ("to", "until", "close", "latest", "lateststart", "windowto", "windowuntil", "windowend", "closesat"),
        rare=frozenset(("to", "close")),
    ),
    SiteKey(
        "window",
        cells.pairs,
        "time",
        ("windows", "timewindow", "timewindows", "hours", "openinghours"),
        rare=frozenset(("hours", "openinghours")),
    ),
    SiteKey(
        "deadline",
        cells.moment,
        "time",
        ("finishby", "mustend", "mustendby", "by", "endby", "doneby"),
        rare=frozenset(("by",)),
    ),
    SiteKey("due", cells.moment, "time", ("duetime", "dueat", "duedate", "dueby")),
    SiteKey("priority", cells.number, names=("prio", "weight", "importance"), rare=frozenset(("importance",))),
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
    SiteKey("actuation_cost", cells.number, names=("cost", "workcost"), rare=frozenset(("cost",))),
    SiteKey("robots_needed", cells.whole, names=("robotsneeded", "teamsize", "crew"), rare=frozenset(("crew",))),
    _mass("load", "demand", "amount", "quantity", "weight", "mass"),
)
_ROBOT = (
    SiteKey("id", cells.text, names=(*IDENTITY[0].names, "robot", "callsign")),
    SiteKey("type", cells.text, names=("model", "class", *words.TYPES, *words.MODELS)),
    SiteKey("moves", _lower, names=("domain",)),
    SiteKey("speed_mps", partial(_number, "speed"), "speed", ("speed", "maxspeed", "velocity", "cruisespeed")),
    SiteKey("work_capacity", cells.limit),
    SiteKey("skills", cells.words, names=("skill", "capabilities", "equipment")),
    _length("radius_m", "radius"),
    SiteKey("heading_deg", partial(_number, "angle"), "angle", ("heading", "yaw")),
    SiteKey(
        "endurance_s",
        energy_cells.endurance,
        "time",
        (*words.ENDURANCE, *words.BATTERY),
        needs_unit=True,
        right=COLUMNS,
    ),
    SiteKey(
        "range_m",
        energy_cells.range_of,
        "length",
        (*words.RANGE, *words.BATTERY),
        needs_unit=True,
        right=COLUMNS,
    ),
    SiteKey("battery", energy_cells.battery, names=words.BATTERY, right=COLUMNS),
    SiteKey("capacity", energy_cells.no_capacity, names=("budget",), right=COLUMNS),
    _mass("load_capacity", "payload", "capacity"),
    SiteKey("climb_mps", partial(_number, "speed"), "speed", ("climb", "climbspeed")),
    SiteKey("starts", cells.moment, "time", ("from", "availablefrom", "shiftstart", "start", "earliest")),
    SiteKey("ends", cells.moment, "time", ("to", "until", "availableuntil", "shiftend", "end", "latest")),
    SiteKey("shift", cells.pairs, "time", ("shifts", "hours", "availability")),
)
_STATION = (
    SiteKey("id", cells.text, names=(*IDENTITY[0].names, "station")),
    SiteKey("services", _choices, names=("service",)),
    SiteKey("charge_per_s", cells.number),
    SiteKey("swap_s", cells.duration, "time", ("swap", "swaptime")),
)
_DOOR = SiteKey("door", cells.text, names=("doorid",))
_ZONE = (
    _DOOR,
    _level("floor_m", "floor", "minheight", "lowerlimit"),
    _level("ceiling_m", "ceiling", "maxheight", "upperlimit"),
    SiteKey("forbidden_to", _kinds_of_robots, names=("closedto", "forbidden"), rare=frozenset(("forbidden",))),
)
ZONE_RADIUS = SiteKey(
    "radius_m", cells.radius, "length", ("radius", "rad", "radio", "raggio", "rayon", "raio", "радиус")
)
"""Of a closed area that is given by its middle."""
_ROUND_ZONE = (ZONE_RADIUS, SiteKey("diameter_m", cells.radius, "length", ("diameter", "durchmesser")), *_ZONE)
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
    "survey": (_length("height_m", "height", "altitude", "flightaltitude", "flightheight", "agl", "flughöhe"), *_TASK),
    "lane": _LANE,
    "route": (),
}
ROLES = tuple(_OF_ROLES)
"""What a feature may be. A route is that of a plan, and is not read."""

AT_POINTS = ("task", "robot", "station")
"""Roles of points; the others are those of areas and lines."""

CIRCLE = "circle"
"""The role of a closed area that is given by its middle and its radius: a zone at a point."""
WITH_PLACE = (*AT_POINTS, CIRCLE)
"""Roles of features that are at one place."""

SKIP = "skip"
"""Stands for a role where a feature is passed over."""

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
    place = PLACE if role in WITH_PLACE else PLACE[-1:]
    of_role = _ROUND_ZONE if role == CIRCLE else _OF_ROLES[role]
    own = {key.name: key for key in (*place, *IDENTITY, ROLE, *of_role)}
    for name, kind in _mission_keys(role, surveys).items():
        if name not in own and name not in _INSTEAD and (read := _reading(kind)) is not None:
            own[name] = SiteKey(name, read, _dimension(name) if isinstance(kind, Number) else "")
    return own


def _mission_keys(role: str, surveys: bool) -> Mapping[str, Kind]:
    from muster.mission.model import Action, Robot, Station, Task, Zone

    classes: dict[str, type[Any]] = {"task": Task, "survey": Task, "robot": Robot, "station": Station, "zone": Zone}
    classes[CIRCLE] = Zone
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
