"""Changes of a mission's text by map and form: places, robots, tasks, stations, single cells of tables.

Adds zones that are drawn on a map to a mission's text, with the map that they need.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from typing import Any

from muster.mission.reading.circles import SIDES, enclosing
from muster_control.work.editing.edits import EditError, append, data_of, remove, set_value, set_values
from muster_control.work.editing.nodes import Path

KINDS = ("ground", "air")
_MARGIN_M = 5.0  # around everything, of a boundary that is made because a zone needs a map

Corner = Sequence[float]


def add_zone(
    text: str,
    corners: Sequence[Corner],
    floor: float | None = None,
    ceiling: float | None = None,
    forbidden_to: Sequence[str] = KINDS,
) -> str:
    """Put a zone into a mission; heights in metres, None without an end.

    A mission without a map gets a boundary around everything: a map has to be one of a boundary, an image, a ROS map.

    Raises
    ------
    EditError
        if it has too few corners, its floor is not below its ceiling, or nobody is kept out.
    """
    if len(corners) < 3:
        raise EditError(f"a zone of {len(corners)} corners; expected at least 3")
    if floor is not None and ceiling is not None and floor >= ceiling:
        raise EditError(f"floor_m: {floor:g}; expected a number below ceiling_m ({ceiling:g})")
    if not forbidden_to:
        raise EditError("forbidden_to: nobody; expected ground, air, or both")
    zone: dict[str, Any] = {"polygon": [[_neat(x), _neat(y)] for x, y in corners]}
    zone |= {key: value for key, value in (("floor_m", floor), ("ceiling_m", ceiling)) if value is not None}
    if set(forbidden_to) != set(KINDS):
        zone["forbidden_to"] = list(forbidden_to)
    data = data_of(text)
    if data.get("map"):
        return append(text, ("map", "zones"), zone)
    return set_value(text, ("map",), {"boundary": _around(corners, data), "zones": [zone]})


def _around(corners: Iterable[Corner], data: Mapping[str, Any]) -> list[list[float]]:
    items = [*(data.get("robots") or []), *(data.get("tasks") or []), *(data.get("stations") or [])]
    places = [item["position"] for item in items if isinstance(item, dict) and isinstance(item.get("position"), list)]
    points = [*corners, *(place[:2] for place in places)]
    west, south = (_neat(min(float(point[k]) for point in points) // 1 - _MARGIN_M) for k in (0, 1))
    east, north = (_neat(max(float(point[k]) for point in points) // 1 + 1 + _MARGIN_M) for k in (0, 1))
    return [[west, south], [east, south], [east, north], [west, north]]


def _neat(metres: float) -> float:
    """To centimetres, and whole numbers as such."""
    value = round(float(metres), 2)
    return int(value) if value.is_integer() else value


TEAMS = {"robot": "robots", "task": "tasks", "station": "stations"}
_PREFIXES = {"robot": "r_", "task": "", "station": "station_"}
_FIRST_STATION = {"services": ["charge"], "charge_per_s": 1}


def move(text: str, one: Mapping[str, Any], x: float, y: float) -> str:
    """Put a robot, a task, a station, or the corner of a zone elsewhere; a height stays.

    A corner is known by its number and its zone's, and by where it was (`from`) where that is given: others may have
    those numbers by now.
    """
    if one["what"] == "zone":
        corner: Path = ("map", "zones", int(one["id"]), "polygon", int(one["corner"]))
        if "circle" in _at(data_of(text), corner[:3]):
            raise EditError(f"zone {int(one['id']) + 1} is a circle; change that in the text")
        if isinstance(_at(data_of(text), corner[:-1]), dict):
            raise EditError(f"zone {int(one['id']) + 1} is placed in degrees (lat_lon); change that in the text")
        was = one.get("from")
        if was is not None and _at(data_of(text), corner)[:2] != list(was):
            raise EditError(f"the corner of zone {int(one['id']) + 1} is elsewhere by now; drag it again")
        return set_value(text, corner, [x, y])
    path = _path_of(text, TEAMS[one["what"]], str(one["id"]))
    item = _at(data_of(text), path)
    if "position" not in item:
        raise EditError(f"{one['id']} is placed in degrees (lat_lon); change that in the text")
    return set_value(text, (*path, "position"), [x, y, *item["position"][2:]])


def add(text: str, what: str, x: float, y: float) -> str:
    """Put a new robot, task or station there; it is like the last one, but a task has only the type of the last one.

    Where the mission is in space and there is no last one, it is put on the ground.
    """
    items = data_of(text).get(TEAMS[what]) or []
    last = items[-1] if items and isinstance(items[-1], dict) else {}
    height = list(last.get("position", []))[2:] or ([0] if is_in_space(data_of(text)) else [])
    alike = {key: value for key, value in last.items() if what != "task" or key == "type"}
    if what == "station" and not last:
        alike = _FIRST_STATION
    new = {"id": _free_id(items, _PREFIXES[what]), "position": [x, y, *height]}
    return append(text, (TEAMS[what],), {**new, **{k: v for k, v in alike.items() if k not in (*new, "lat_lon")}})


def add_beside(text: str, what: str) -> str:
    """Put a new robot, task or station two metres east of the last one."""
    items: Sequence[Any] = data_of(text).get(TEAMS[what]) or []
    position = items[-1].get("position") if items and isinstance(items[-1], dict) else None
    x, y = position[:2] if isinstance(position, list) and len(position) > 1 else (0.0, 0.0)
    return add(text, what, float(x) + 2, float(y))


def drop(text: str, what: str, name: str | int, corners: Sequence[Sequence[float]] | None = None) -> str:
    """Take a robot, task, station or zone out; prerequisites, relations, deliveries and locks let go of it.

    A zone is known by its number, and by its `corners` where they are given: another one may have that number by now.
    """
    if what == "zone":
        path: Path = ("map", "zones", int(name))
        if corners is not None and not _is_of(_at(data_of(text), path), corners):
            raise EditError(f"zone {int(name) + 1} is another one by now; choose it again")
        return remove(text, path)
    text = remove(text, _path_of(text, TEAMS[what], str(name)))
    for key in _NAMING[what]:
        text = _let_go(text, key, str(name))
    return text


_NAMING = {
    "task": ("prerequisites", "same_robot_as", "other_robot_than", "starts_with", "delivers"),
    "robot": ("only_robots",),
    "station": (),
}


def _let_go(text: str, key: str, name: str) -> str:
    """The text in which no task names one under a key: an id, or a list of ids and of mappings with a task."""
    for k, task in enumerate(data_of(text).get("tasks") or []):
        named = task.get(key) if isinstance(task, dict) else None
        listed = named if isinstance(named, list) else [] if named is None else [named]
        rest = [one for one in listed if str(one.get("task") if isinstance(one, dict) else one) != name]
        if len(rest) < len(listed):
            path = ("tasks", k, key)
            text = set_value(text, path, rest) if rest else remove(text, path)
    return text


def _is_of(zone: Any, corners: Sequence[Sequence[float]]) -> bool:
    """Whether a zone as it is written has those corners; of one in degrees, as many; of a circle, those around it."""
    circle = zone.get("circle") if isinstance(zone, dict) else None
    if isinstance(circle, dict):
        center = circle.get("center")
        known = enclosing(center, circle["radius_m"]) if isinstance(center, list) else []
        return len(corners) == SIDES if not known else known == [list(c) for c in corners]
    polygon = zone.get("polygon") if isinstance(zone, dict) else None
    if isinstance(polygon, dict) and isinstance(polygon.get("lat_lon"), list):
        return len(polygon["lat_lon"]) == len(corners)
    written = polygon if isinstance(polygon, list) else []
    return [list(corner[:2]) for corner in written if isinstance(corner, list)] == [list(c) for c in corners]


def set_cell(text: str, path: Sequence[str | int], value: object, name: str | None = None) -> str:
    """Give a cell of a table a value; None takes its key out. With a `name` the row is that of this id."""
    path = _with_row_of(text, path, name)
    owner = _at(data_of(text), path[:-1]) if len(path) > 1 and path[0] != "rules" else data_of(text).get("rules") or {}
    if value is None:
        return remove(text, path) if path[-1] in owner else text
    if path[0] == "rules" and not owner:
        return set_value(text, ("rules",), {str(path[-1]): value})
    return set_value(text, path, value)


def set_coordinate(text: str, path: Sequence[str | int], axis: int, value: float, name: str | None = None) -> str:
    """Change one coordinate of the position of the item at `path`; with a `name` that of this id."""
    path = _with_row_of(text, path, name)
    position = _at(data_of(text), path).get("position")
    if not isinstance(position, list) or axis > len(position):
        raise EditError("the place is not written as a list of numbers; change it in the text")
    return set_value(text, (*path, "position"), [*position[:axis], value, *position[axis + 1 :]])


def rename(text: str, name: str) -> str:
    """Give the mission another name."""
    return set_value(text, ("name",), name)


def is_in_space(data: Mapping[str, Any]) -> bool:
    """Whether a robot, a task or a station has a height."""
    return any(len(position) > 2 for position in _positions(data).values())


def raised(text: str) -> str:
    """Make a mission 3-D: every robot, task and station that has no height gets the height 0."""
    positions = _positions(data_of(text))
    return set_values(text, {path: [*place, 0] for path, place in positions.items() if len(place) == 2})


def _positions(data: Mapping[str, Any]) -> dict[Path, list[Any]]:
    """The places of robots, tasks and stations as they are written, by where they stand."""
    return {
        (team, k, "position"): item["position"]
        for team in TEAMS.values()
        for k, item in enumerate(data.get(team) or [])
        if isinstance(item, dict) and isinstance(item.get("position"), list)
    }


def _with_row_of(text: str, path: Sequence[str | int], name: str | None) -> Path:
    """A path whose second step is where the item of this id stands now: rows move when others are taken out."""
    if name is None:
        return tuple(path)
    team, row, *rest = path
    return (*_path_of(text, str(team), name, int(row)), *rest)


def _path_of(text: str, team: str, name: str, row: int | None = None) -> Path:
    """Where the only item of this id stands; one without an id, whose name is empty, is known by its row."""
    items = data_of(text).get(team) or []
    rows = [k for k, item in enumerate(items) if isinstance(item, dict) and str(item.get("id", "")) == name]
    if not name:
        rows = [k for k in rows if k == row]
    if len(rows) != 1:
        found = "more than one is called so" if rows else "no such one in the text"
        called = name or ("without an id" if row is None else f"in row {row + 1}")
        raise EditError(f"{team[:-1]} {called}: {found}; change it in the text itself")
    return team, rows[0]


def _at(data: Any, path: Path) -> Any:
    try:
        for step in path:
            data = data[step]
    except (KeyError, IndexError, TypeError):
        raise EditError(f"{'.'.join(map(str, path))}: nothing stands there in the text") from None
    return data


def _free_id(items: Iterable[Any], prefix: str) -> int | str:
    """The number after the greatest one that an id ends with, behind what ids begin with."""
    taken = {str(item.get("id")) for item in items if isinstance(item, dict)}
    number = max((int(name[len(prefix) :]) for name in taken if _is_number(name, prefix)), default=-1) + 1
    return f"{prefix}{number}" if prefix else number


def _is_number(name: str, prefix: str) -> bool:
    rest = name[len(prefix) :]
    return name.startswith(prefix) and rest.isascii() and rest.isdecimal() and len(rest) < 10


CHANGES: Mapping[str, Callable[..., str]] = {
    "move": move,
    "add": add,
    "add_beside": add_beside,
    "drop": drop,
    "set_cell": set_cell,
    "set_coordinate": set_coordinate,
    "rename": rename,
    "raised": raised,
    "add_zone": add_zone,
}
"""What may be asked for by name."""
