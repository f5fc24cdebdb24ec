"""Consistency rules between the parts of a mission: ids, references, units, cycles."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence

from muster.mission.mission_data import MissionData
from muster.mission.near_matches import did_you_mean
from muster.mission.robots import Robot
from muster.mission.site import Point
from muster.mission.tasks import Found, Task, Work
from muster.mission.value_types import Fault, Path, shown

_FLAT_M = 0.01
"""A tag lies on the ground that is no farther from it."""


def inconsistencies(mission: MissionData) -> Iterator[Fault]:
    """Every fault that lies between the parts of a mission."""
    yield from _repeated_ids(mission)
    yield from _prerequisites(mission)
    yield from _relations(mission)
    yield from _cycles(mission)
    yield from _locks(mission)
    yield from _suitability(mission)
    yield from _dimensions(mission)
    yield from _travel(mission)
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


def _unknown(at: Path, name: str, known: Sequence[str], what: str) -> Fault:
    return Fault(at, shown(name), f"the id of a {what}{did_you_mean(name, known)}", relies_on=f"{what}s")


def _new_tasks(mission: MissionData) -> list[tuple[Path, Task]]:
    return [(("events", k, "new_task"), e.new_task) for k, e in enumerate(mission.events) if e.new_task]


def _robots_that_join(mission: MissionData) -> list[tuple[Path, Robot]]:
    return [(("events", k, "robot_joins"), e.robot_joins) for k, e in enumerate(mission.events) if e.robot_joins]


def _all_work(mission: MissionData) -> list[tuple[Path, Work]]:
    """Tasks, those that come later, and what becomes of tags."""
    becomes = [(("found", k, "becomes"), found.becomes) for k, found in _rules(mission)]
    return [*((("tasks", k), task) for k, task in enumerate(mission.tasks)), *_new_tasks(mission), *becomes]


def _all_robots(mission: MissionData) -> list[tuple[Path, Robot]]:
    return [*((("robots", k), robot) for k, robot in enumerate(mission.robots)), *_robots_that_join(mission)]


def _prerequisites(mission: MissionData) -> Iterator[Fault]:
    ids = [t.id for t in mission.tasks]
    with_new = [*ids, *(t.id for _, t in _new_tasks(mission))]
    own, all_of_them = set(ids), set(with_new)
    for path, task in _all_work(mission):
        known, among = (ids, own) if path[0] == "tasks" else (with_new, all_of_them)
        seen: set[str] = set()
        for p, name in enumerate(task.prerequisites):
            at: Path = (*path, "prerequisites", p)
            if name not in among:
                yield _unknown(at, name, known, "task")
            elif name in seen:
                yield Fault(at, shown(name), "each prerequisite once")
            seen.add(name)


def _relations(mission: MissionData) -> Iterator[Fault]:
    ids = [t.id for t in mission.tasks]
    with_new = [*ids, *(t.id for _, t in _new_tasks(mission))]
    for path, task in _all_work(mission):
        known = ids if path[0] == "tasks" else with_new
        for key in ("same_robot_as", "other_robot_than", "starts_with"):
            for k, name in enumerate(getattr(task, key)):
                if name not in known:
                    yield _unknown((*path, key, k), name, known, "task")
                elif name == getattr(task, "id", None):
                    yield Fault((*path, key, k), shown(name), "another task")


def _cycles(mission: MissionData) -> Iterator[Fault]:
    """One cycle of each knot of prerequisites, named in the order in which the tasks wait.

    Not all: there can be more than anyone could read, and the others go when one task of theirs is set right, or are
    found when it was.
    """
    index = {t.id: k for k, t in reversed(list(enumerate(mission.tasks)))}
    before = [[index[name] for name in task.prerequisites if name in index] for task in mission.tasks]
    state = [0] * len(before)  # 0: not visited, 1: on the way, 2: done
    named: set[int] = set()
    for start in range(len(before)):
        way, steps = [start], [iter(before[start])] if state[start] == 0 else []
        while steps:
            state[way[-1]] = 1
            following = next(steps[-1], None)
            if following is None:
                state[way.pop()] = 2
                steps.pop()
            elif state[following] == 1:
                knot = way[way.index(following) :]
                if named.isdisjoint(knot):
                    yield _cycle(mission.tasks, knot)
                named.update(knot)
            elif state[following] == 0:
                way.append(following)
                steps.append(iter(before[following]))


def _cycle(tasks: Sequence[Task], knot: list[int]) -> Fault:
    names = " -> ".join(tasks[k].id for k in [*knot, knot[0]])
    return Fault(("tasks", knot[0], "prerequisites"), f"cycle {names}", "prerequisites without a cycle")


def _locks(mission: MissionData) -> Iterator[Fault]:
    ids = [r.id for r in mission.robots]
    joining = [robot.id for _, robot in _robots_that_join(mission)]
    for path, task in _all_work(mission):
        for r, name in enumerate(task.only_robots or ()):
            if name not in ids and name not in joining:
                yield _unknown((*path, "only_robots", r), name, ids, "robot")


def _suitability(mission: MissionData) -> Iterator[Fault]:
    if mission.suitability is None:
        return
    rows = list(mission.suitability)
    columns = {kind for row in mission.suitability.values() for kind in row}
    groups = (
        ([(path, robot.type) for path, robot in _all_robots(mission)], rows, "a row"),
        ([(path, task.type) for path, task in _all_work(mission)], sorted(columns), "a column"),
    )
    for types, known, what in groups:
        expected = f"a type that has {what} in suitability ({', '.join(known)})"
        for path, name in types:
            if name is None:
                yield Fault((*path, "type"), "missing", expected)
            elif name not in known:
                yield Fault((*path, "type"), shown(name), expected + did_you_mean(name, known))


def positions(mission: MissionData) -> Iterator[tuple[Path, Point]]:
    """Every position that a mission names, also in its events."""
    for k, robot in enumerate(mission.robots):
        yield ("robots", k, "position"), robot.position
        if robot.end_position is not None:
            yield ("robots", k, "end_position"), robot.end_position
    for k, task in enumerate(mission.tasks):
        yield from _places(("tasks", k), task)
    for k, event in enumerate(mission.events):
        if event.robot_joins is not None:
            yield ("events", k, "robot_joins", "position"), event.robot_joins.position
        if event.new_task is not None:
            yield from _places(("events", k, "new_task"), event.new_task)
        if event.move_task is not None:
            yield ("events", k, "move_task", "position"), event.move_task.position
    yield from _marks(mission)
    for k, found in _rules(mission):
        if found.becomes.action is not None:
            for key, point in found.becomes.action.places.items():
                yield ("found", k, "becomes", "action", key), point


def _marks(mission: MissionData) -> Iterator[tuple[Path, Point]]:
    for k, tag in enumerate(mission.tags):
        yield ("tags", k, "position"), tag.position
    for k, landmark in enumerate(mission.landmarks):
        yield ("landmarks", k, "position"), landmark.position


def _places(at: Path, task: Task) -> Iterator[tuple[Path, Point]]:
    for name, point in (("position", task.position), ("entry", task.entry), ("exit", task.exit)):
        if point is not None:
            yield (*at, name), point
    for key, point in ({} if task.action is None else task.action.places).items():
        yield (*at, "action", key), point


def _dimensions(mission: MissionData) -> Iterator[Fault]:
    """Positions with z among positions without; the fewer of the two are the wrong ones."""
    places = list(positions(mission))
    flat = [item for item in places if len(item[1]) == 2]
    spatial = [item for item in places if len(item[1]) == 3]
    if flat and spatial:
        wrong, expected = (flat, "[x, y, z]") if len(flat) <= len(spatial) else (spatial, "[x, y]")
        for path, point in wrong:
            yield Fault(path, shown(list(point)), f"{expected} as the other positions are")


def _travel(mission: MissionData) -> Iterator[Fault]:
    if mission.travel_rule == "map" and mission.map is None:
        yield Fault(("rules", "travel"), shown("map"), "a mission with a map, or another rule")
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
    robots, tasks = [r.id for r in mission.robots], [t.id for t in mission.tasks]
    for name in sorted(set(robots) & set(tasks)):
        at: Path = ("tasks", tasks.index(name), "id")
        yield Fault(at, shown(name), "an id that no robot has: both are places of the travel tables")
    for kind in mission.travel or ():
        if kind not in mission.travel_tables:
            yield Fault(("travel", kind), "a table that was not read", "one of travel_tables for each entry of travel")
    for kind, table in mission.travel_tables.items():
        rows = set(table.places)
        if any(len(row) != len(table.places) for row in (table.metres, *table.metres)):
            yield Fault(("travel", kind), "rows of different lengths", "a row and a column for each place")
        missing = [name for name in (*robots, *tasks) if name not in rows]
        if missing:
            value = f"no row for {', '.join(missing[:5])}"
            yield Fault(("travel", kind), value, "a row and a column for each robot and task")
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


def _events(mission: MissionData) -> Iterator[Fault]:
    robots = [r.id for r in mission.robots] + [e.robot_joins.id for e in mission.events if e.robot_joins]
    tasks = [t.id for t in mission.tasks] + [e.new_task.id for e in mission.events if e.new_task]
    for k, event in enumerate(mission.events):
        named: Iterable[tuple[Path, str | None, list[str], str]] = (
            (("robot_fails",), event.robot_fails, robots, "robot"),
            (("robot_silent",), event.robot_silent, robots, "robot"),
            (("robot_returns",), event.robot_returns, robots, "robot"),
            (("cancel_task",), event.cancel_task, tasks, "task"),
            (("move_task", "task"), event.move_task.task if event.move_task else None, tasks, "task"),
            (("delay_task", "task"), event.delay_task.task if event.delay_task else None, tasks, "task"),
        )
        for path, name, known, what in named:
            if name is not None and name not in known:
                yield _unknown(("events", k, *path), name, known, what)
        for group, name, known in (
            ("robot_joins", event.robot_joins.id if event.robot_joins else None, robots),
            ("new_task", event.new_task.id if event.new_task else None, tasks),
        ):
            if name is not None and known.count(name) > 1:
                yield Fault(("events", k, group, "id"), shown(name), "an id of its own")


def _rules(mission: MissionData) -> list[tuple[int, Found]]:
    """What becomes of tags, by number; one without a task is on the list of faults already."""
    return [(k, found) for k, found in enumerate(mission.found) if found.becomes is not None]


def _found(mission: MissionData) -> Iterator[Fault]:
    cameras = any(robot.camera is not None for _, robot in _all_robots(mission))
    for_all: int | None = None
    for k, found in _rules(mission):
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
    heights = [place[2] for path, place in positions(mission) if len(place) == 3 and path[0] != "tags"]
    ground = min([0.0, *heights])
    for k, tag in enumerate(mission.tags):
        if len(tag.position) == 3 and abs(tag.position[2] - ground) > _FLAT_M:
            expected = f"a height of {ground:g}, the ground: robots take what they see to lie on it"
            yield Fault(("tags", k, "position"), shown(list(tag.position)), expected)
