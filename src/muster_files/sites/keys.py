"""What a column may say: the keys of places, tasks, robots, stations, zones and lanes, with the names that people use.

The names of keys are those of mission files; those that a mission file has not (`lat`, `opens`) are marked by what the
site's builder makes of them.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field, fields
from functools import cache, partial
from typing import Any

from muster.mission.action_keys import ACTION_KEYS
from muster.mission.records import all_keys, key_of
from muster.mission.texts.packaged_files import packaged_data
from muster.mission.value_types import Choice, Flag, Kind, Many, Number, OneOrMany, Text, Whole
from muster_files.sites import cells, energy_cells
from muster_files.sites import key_words as words
from muster_files.sites.energy_cells import COLUMNS
from muster_files.sites.units import UNITS, Dimension
from muster_files.sites.vocabulary import moves

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


_HEADINGS: Mapping[str, Mapping[str, str]] = packaged_data("muster_files.sites", "headings.yaml")


def _key(subject: str, name: str, read: Read, dimension: Dimension = "", *names: str, **others: Any) -> SiteKey:
    """The key of a subject, with its headings of `headings.yaml`, then `names`."""
    listed = _HEADINGS[subject].get(name, "").split()
    rare = frozenset(word.removesuffix("?") for word in listed if word.endswith("?"))
    headings = (*(word.removesuffix("?") for word in listed), *names)
    return SiteKey(name, read, dimension, headings, rare=rare, **others)


def _angle(name: str, read: Read) -> SiteKey:
    return _key("place", name, read, "angle", is_free=True)


def _length(subject: str, name: str, **others: Any) -> SiteKey:
    return _key(subject, name, partial(_number, "length"), "length", **others)


def _mass(subject: str, name: str) -> SiteKey:
    return _key(subject, name, cells.amount, "mass", is_free=True)


def _id(subject: str) -> SiteKey:
    """The id of a subject, whose headings are those of any id, and its own."""
    return SiteKey("id", cells.text, names=(*IDENTITY[0].names, *_HEADINGS[subject]["id"].split()))


PLACE = (
    _angle("lat", partial(cells.degrees, most=90.0)),
    _angle("lon", partial(cells.degrees, most=180.0)),
    _angle("lat_lon", cells.lat_lon),
    *(_length("place", name) for name in ("alt", "x", "y", "z")),
    _key("place", "position", cells.point),
    _key("place", "wkt", cells.text),
)
IDENTITY = (_key("identity", "id", cells.text), SiteKey("name", cells.text, names=words.NAMES))
ROLE = _key("role", "kind", _lower)
_TASK = (
    _id("task"),
    _key("task", "type", cells.text),
    _key("task", "duration_s", cells.duration, "time"),
    _key("task", "opens", cells.moment, "time"),
    _key("task", "closes", cells.moment, "time"),
    _key("task", "window", cells.pairs, "time"),
    _key("task", "deadline", cells.moment, "time"),
    _key("task", "due", cells.moment, "time"),
    _key("task", "priority", cells.number),
    _key("task", "prerequisites", cells.words),
    _key("task", "requires", cells.words),
    _key("task", "actuation_cost", cells.number),
    _key("task", "robots_needed", cells.whole),
    _mass("task", "load"),
)
_OF_ENERGY: dict[str, Any] = {"needs_unit": True, "right": COLUMNS}
_ROBOT = (
    _id("robot"),
    _key("robot", "type", cells.text, "", *words.TYPES, *words.MODELS),
    _key("robot", "moves", _lower),
    _key("robot", "speed_mps", partial(_number, "speed"), "speed"),
    SiteKey("work_capacity", cells.limit),
    _key("robot", "skills", cells.words),
    _length("robot", "radius_m"),
    _key("robot", "heading_deg", partial(_number, "angle"), "angle"),
    SiteKey("endurance_s", energy_cells.endurance, "time", (*words.ENDURANCE, *words.BATTERY), **_OF_ENERGY),
    SiteKey("range_m", energy_cells.range_of, "length", (*words.RANGE, *words.BATTERY), **_OF_ENERGY),
    SiteKey("battery", energy_cells.battery, names=words.BATTERY, right=COLUMNS),
    _key("robot", "capacity", energy_cells.no_capacity, right=COLUMNS),
    _mass("robot", "load_capacity"),
    _key("robot", "climb_mps", partial(_number, "speed"), "speed"),
    _key("robot", "starts", cells.moment, "time"),
    _key("robot", "ends", cells.moment, "time"),
    _key("robot", "shift", cells.pairs, "time"),
)
_STATION = (
    _id("station"),
    _key("station", "services", _choices),
    SiteKey("charge_per_s", cells.number),
    _key("station", "swap_s", cells.duration, "time"),
)
_DOOR = _key("zone", "door", cells.text)
_ZONE = (
    _DOOR,
    # Storeys and the like, under the same headings, are not read: all heights are closed then.
    _length("zone", "floor_m", needs_unit=True),
    _length("zone", "ceiling_m", needs_unit=True),
    _key("zone", "forbidden_to", _kinds_of_robots),
)
ZONE_RADIUS = _key("zone", "radius_m", cells.radius, "length")
"""Of a closed area that is given by its middle."""
_ROUND_ZONE = (ZONE_RADIUS, _key("zone", "diameter_m", cells.radius, "length"), *_ZONE)
_OF_OPENSTREETMAP = {"maxspeed": UNITS["speed"]["km/h"]}
_LANE = (
    _DOOR,
    _length("lane", "width_m"),
    _key("lane", "speed_mps", partial(_number, "speed"), "speed", unstated=_OF_OPENSTREETMAP),
    SiteKey("capacity", cells.whole),
    _key("lane", "one_way", cells.flag),
    _key("lane", "both_ways", cells.flag),
)
_OF_ROLES: Mapping[str, tuple[SiteKey, ...]] = {
    "task": _TASK,
    "robot": _ROBOT,
    "station": _STATION,
    "zone": _ZONE,
    "boundary": (),
    "survey": (_length("survey", "height_m"), *_TASK),
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
    found = {} if role not in classes else {key_of(f): f.metadata["kind"] for f in all_keys(classes[role])}
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
