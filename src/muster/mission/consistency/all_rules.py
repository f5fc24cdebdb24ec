"""Consistency rules between the parts of a mission: ids, references, units, cycles."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from itertools import chain

from muster.mission.areas.task_areas import area_faults
from muster.mission.consistency.deliveries import goods_faults
from muster.mission.consistency.task_order import order_faults
from muster.mission.doors import doors_of
from muster.mission.mission_data import MissionData
from muster.mission.mission_parts import all_robots, all_work, positions, robots_that_join, rules_of_tags, unknown_id
from muster.mission.site import Point
from muster.mission.stations import Station
from muster.mission.task_relations import relation_faults
from muster.mission.tasks import Work
from muster.mission.texts.near_matches import did_you_mean
from muster.mission.value_types import Fault, Path, shown

_FLAT_M = 0.01
"""A tag lies on the ground that is no farther from it."""


def inconsistencies(mission: MissionData) -> Iterator[Fault]:
    """Every fault that lies between the parts of a mission."""
    yield from _repeated_ids(mission)
    yield from order_faults(mission)
    yield from relation_faults(mission)
    yield from goods_faults(mission)
    yield from _ids_of_stations(mission)
    yield from _locks(mission)
    yield from area_faults(mission)
    yield from _suitability(mission)
    yield from _dimensions(mission)
    yield from _travel(mission)
    yield from _doors(mission)
    yield from _events(mission)
    yield from _found(mission)
    yield from _tags_on_the_ground(mission)


def _repeated_ids(mission: MissionData) -> Iterator[Fault]:
    groups = (("robots", [r.id for r in mission.robots]), ("tasks", [t.id for t in mission.tasks]))
    for group, ids in groups:
        first: dict[str, int] = {}
        for k, name in enumerate(ids):
            if name in first:
                yield Fault((group, k, "id"), shown(name), f"an id of its own: {group}[{first[name]}] has this one")
            first.setdefault(name, k)


def _ids_of_stations(mission: MissionData) -> Iterator[Fault]:
    """Stations that have the id of another, or of a task."""
    if not mission.stations:
        return
    first: dict[str, str] = {task.id: f"tasks[{k}]" for k, task in enumerate(mission.tasks)}
    first |= {e.new_task.id: f"events[{k}].new_task" for k, e in enumerate(mission.events) if e.new_task}
    for k, station in enumerate(mission.stations):
        if station.id in first:
            at = ("stations", k, "id")
            yield Fault(at, shown(station.id), f"an id of its own: {first[station.id]} has this one")
        first.setdefault(station.id, f"stations[{k}]")


def _locks(mission: MissionData) -> Iterator[Fault]:
    ids = [r.id for r in mission.robots]
    known = {*ids, *(robot.id for _, robot in robots_that_join(mission))}
    stations = ((("stations", k), station) for k, station in enumerate(mission.stations))
    locked: Iterable[tuple[Path, Work | Station]] = chain(all_work(mission), stations)
    for path, place in locked:
        for r, name in enumerate(place.only_robots or ()):
            if name not in known:
                yield unknown_id((*path, "only_robots", r), name, ids, "robot")


def _suitability(mission: MissionData) -> Iterator[Fault]:
    if mission.suitability is None:
        return
    rows = list(mission.suitability)
    columns = {kind for row in mission.suitability.values() for kind in row}
    groups = (
        ([(path, robot.type) for path, robot in all_robots(mission)], rows, "a row"),
        ([(path, task.type) for path, task in all_work(mission)], sorted(columns), "a column"),
    )
    for types, known, what in groups:
        expected = f"a type that has {what} in suitability ({', '.join(known)})"
        for path, name in types:
            if name is None:
                yield Fault((*path, "type"), "missing", expected)
            elif name not in known:
                yield Fault((*path, "type"), shown(name), expected + did_you_mean(name, known))


def _dimensions(mission: MissionData) -> Iterator[Fault]:
    """Positions with z among positions without; the fewer of the two are the wrong ones."""
    if len({len(point) for _, point in positions(mission)} & {2, 3}) == 2:
        flat, spatial = ([item for item in positions(mission) if len(item[1]) == n] for n in (2, 3))
        wrong, expected = (flat, "[x, y, z]") if len(flat) <= len(spatial) else (spatial, "[x, y]")
        for path, point in wrong:
            yield Fault(path, shown(list(point)), f"{expected} as the other positions are")


def _travel(mission: MissionData) -> Iterator[Fault]:
    if mission.travel_rule == "map" and mission.map is None:
        yield Fault(("rules", "travel"), shown("map"), "a mission with a map, or another rule")
    if mission.travel_rule == "lanes" and mission.lanes is None:
        yield Fault(("rules", "travel"), shown("lanes"), "a mission with lanes, or another rule")
    if mission.travel_rule != "matrix":
        if mission.travel is not None:
            yield Fault(("travel",), "tables that are not used", "rules.travel: matrix beside them")
        return
    if mission.travel is None:
        yield Fault(("travel",), "missing", "a travel table for each type of robot, with rules.travel: matrix")
    elif not mission.travel_tables:
        yield Fault(("travel",), "tables that were not read", "travel_tables, for a mission built in Python")
    else:
        yield from _types_without_table(mission)
        yield from _table_faults(mission)
    yield from _places_without_row(mission)


def _types_without_table(mission: MissionData) -> Iterator[Fault]:
    types = mission.travel or {}
    expected = f"a type that has a travel table ({', '.join(types)})"
    for k, robot in enumerate(mission.robots):
        if robot.type not in types:
            yield Fault(("robots", k, "type"), "missing" if robot.type is None else shown(robot.type), expected)


def _table_faults(mission: MissionData) -> Iterator[Fault]:
    at: Path
    robots, tasks = [r.id for r in mission.robots], [t.id for t in mission.tasks]
    stations = [station.id for station in mission.stations]
    for name in sorted(set(robots) & set(stations)):
        at = ("stations", stations.index(name), "id")
        yield Fault(at, shown(name), "an id that no robot has: both are places of the travel tables")
    for name in sorted(set(robots) & set(tasks)):
        at = ("tasks", tasks.index(name), "id")
        yield Fault(at, shown(name), "an id that no robot has: both are places of the travel tables")
    for kind in mission.travel or ():
        if kind not in mission.travel_tables:
            yield Fault(("travel", kind), "a table that was not read", "one of travel_tables for each entry of travel")
    for kind, table in mission.travel_tables.items():
        rows = set(table.places)
        if any(len(row) != len(table.places) for row in (table.metres, *table.metres)):
            yield Fault(("travel", kind), "rows of different lengths", "a row and a column for each place")
        missing = [name for name in (*robots, *tasks, *stations) if name not in rows]
        if missing:
            value = f"no row for {', '.join(missing[:5])}"
            all_of_them = "each robot, task and station" if stations else "each robot and task"
            yield Fault(("travel", kind), value, f"a row and a column for {all_of_them}")
        for start, row in zip(table.places, table.metres, strict=True):
            for end, metres in zip(table.places, row, strict=True):
                if not metres >= 0:
                    yield Fault(("travel", kind), f"{metres:g} from {start} to {end}", "metres of at least 0, or inf")


def _places_without_row(mission: MissionData) -> Iterator[Fault]:
    places: list[tuple[Path, Point | None]] = [
        (("robots", k, "end_position"), robot.end_position) for k, robot in enumerate(mission.robots)
    ]
    for k, task in enumerate(mission.tasks):
        places += [(("tasks", k, "entry"), task.entry), (("tasks", k, "exit"), task.exit)]
    for path, point in places:
        if point is not None:
            yield Fault(path, shown(list(point)), "nothing here: travel tables know robots and tasks alone")


def _doors(mission: MissionData) -> Iterator[Fault]:
    """Zones and lanes that have the id of a zone before; the ids of lanes differ by themselves."""
    zones = () if mission.map is None else mission.map.zones
    lanes = () if mission.lanes is None else mission.lanes.edges
    first: dict[str, int] = {}
    for k, zone in enumerate(zones):
        if zone.id is not None and first.setdefault(zone.id, k) != k:
            at = ("map", "zones", k, "id")
            yield Fault(at, shown(zone.id), f"an id of its own: zones[{first[zone.id]}] has this one")
    for k, lane in enumerate(lanes):
        if lane.id in first:
            at = ("lanes", "edges", k, "id")
            yield Fault(at, shown(lane.id), f"an id of its own: zones[{first[lane.id]}] has this one")


def _events(mission: MissionData) -> Iterator[Fault]:
    robots = [r.id for r in mission.robots] + [e.robot_joins.id for e in mission.events if e.robot_joins]
    tasks = [t.id for t in mission.tasks] + [e.new_task.id for e in mission.events if e.new_task]
    doors = list(doors_of(mission))
    stations = [station.id for station in mission.stations]
    for k, event in enumerate(mission.events):
        named: Iterable[tuple[Path, str | None, list[str], str]] = (
            (("robot_fails",), event.robot_fails, robots, "robot"),
            (("robot_silent",), event.robot_silent, robots, "robot"),
            (("robot_returns",), event.robot_returns, robots, "robot"),
            (("robot_removed",), event.robot_removed, robots, "robot"),
            (("robot_moved", "robot"), event.robot_moved.robot if event.robot_moved else None, robots, "robot"),
            (("cancel_task",), event.cancel_task, tasks, "task"),
            (("move_task", "task"), event.move_task.task if event.move_task else None, tasks, "task"),
            (("delay_task", "task"), event.delay_task.task if event.delay_task else None, tasks, "task"),
            (("door_closes",), event.door_closes, doors, "door"),
            (("door_opens",), event.door_opens, doors, "door"),
            (("station_fails",), event.station_fails, stations, "station"),
            (("station_returns",), event.station_returns, stations, "station"),
        )
        for path, name, known, what in named:
            if name is not None and name not in known:
                yield unknown_id(("events", k, *path), name, known, what)
        for group, name, known in (
            ("robot_joins", event.robot_joins.id if event.robot_joins else None, robots),
            ("new_task", event.new_task.id if event.new_task else None, tasks),
        ):
            if name is not None and known.count(name) > 1:
                yield Fault(("events", k, group, "id"), shown(name), "an id of its own")


def _found(mission: MissionData) -> Iterator[Fault]:
    cameras = any(robot.camera is not None for _, robot in all_robots(mission))
    for_all: int | None = None
    for k, found in rules_of_tags(mission):
        at: Path = ("found", k)
        if not cameras:
            yield Fault(at, "no robot has a camera", "camera of at least one robot, where tags are to be found")
        if mission.travel_rule == "matrix":
            expected = "another rules.travel: travel tables know robots and tasks alone"
            yield Fault(at, "a task at any place", expected)
        if for_all is not None:
            yield Fault(at, "a rule that never holds", f"it before found[{for_all}], which holds for all tags")
        elif found.tags is None:
            for_all = k


def _tags_on_the_ground(mission: MissionData) -> Iterator[Fault]:
    """Robots take what they see to lie on the ground: 0, or the lowest place of the mission."""
    if not mission.tags:
        return
    heights = [place[2] for path, place in positions(mission) if len(place) == 3 and path[0] != "tags"]
    ground = min([0.0, *heights])
    for k, tag in enumerate(mission.tags):
        if len(tag.position) == 3 and abs(tag.position[2] - ground) > _FLAT_M:
            expected = f"a height of {ground:g}, the ground: robots take what they see to lie on it"
            yield Fault(("tags", k, "position"), shown(list(tag.position)), expected)
