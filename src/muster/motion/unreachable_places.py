"""Places of a mission at which its robots cannot stand, and the reasons."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from muster.mission.errors import MissionError
from muster.mission.model import Mission, Point, Robot, Task
from muster.mission.records import findings
from muster.mission.value_types import Fault, Path, shown
from muster.motion.actions import TaskMotion, plan
from muster.motion.free_space import PrismSpace
from muster.motion.grid import Grid
from muster.motion.map_world import Area, Body, World, body_of
from muster.motion.maps.free_points import free

if TYPE_CHECKING:
    import shapely


@dataclass(frozen=True)
class BlockedPlace:
    """A place of a robot or task at which a body cannot stand.

    Parameters
    ----------
    path
        of the place in the mission, as `("tasks", 3, "position")`.
    owner
        what it belongs to, as `task 4`.
    point, body
        the place, and the body that it is blocked for.
    detail
        why: `inside zone 1`, `0.12 m from a wall, radius 0.2 m`.
    """

    path: Path
    owner: str
    point: Point
    body: Body
    detail: str

    def __str__(self) -> str:
        return f"{self.owner} at ({', '.join(f'{c:g}' for c in self.point)}): {self.detail}"


def blocked_places(world: World, mission: Mission) -> tuple[BlockedPlace, ...]:
    """Every place that is blocked for a body that has to be there.

    Starts and ends are checked for their robot; entries and exits of tasks, and the way points of their actions, for
    every radius and kind of the robots that the task allows (`only_robots`, or all), each once. Events are not checked.
    """
    found: list[BlockedPlace] = []
    for k, robot in enumerate(mission.robots):
        places = ((*place, body_of(robot)) for place in _places_of_robot(k, robot))
        found += _blocked(world, places, f"robot {robot.id}")
    for k, task in enumerate(mission.tasks):
        found += _blocked(world, _places_of_task(k, task, mission), f"task {task.id}")
    return tuple(found)


def place_faults(world: World, mission: Mission) -> list[Fault]:
    """Faults of a mission: robots that start or end where they cannot stand.

    A task at which no robot can stand is no fault: it is impossible, and the other tasks can be planned.
    """
    return [
        Fault(place.path, f"{shown(list(place.point))}, {place.detail}", _expected(place.body))
        for place in blocked_places(world, mission)
        if place.path[0] == "robots"
    ]


def checked_world(mission: Mission) -> World:
    """The world of a mission with a map, all of whose robots stand where they can.

    Raises
    ------
    MissionError
        with everything that is wrong with the map, or with the places on it.
    MissingExtraError, ParameterError
        as `World.of`.
    """
    world = World.of(mission)
    faults = place_faults(world, mission)
    if faults:
        raise MissionError(findings(faults, mission.source))
    return world


def _expected(body: Body) -> str:
    return f"a place that is free for its robot ({body.kind}, radius {body.radius_m:g} m)"


def _places_of_robot(k: int, robot: Robot) -> Iterator[tuple[Path, Point]]:
    yield ("robots", k, "position"), robot.position
    if robot.end_position is not None:
        yield ("robots", k, "end_position"), robot.end_position


def _places_of_task(k: int, task: Task, mission: Mission) -> dict[tuple[Path, Point, Body], None]:
    """The places that robots visit for a task, those of an action by robot, each once and in order."""
    allowed = [r for r in mission.robots if task.is_open_to(r.id)]
    if task.action is None or not task.action.has_geometry:
        bodies = dict.fromkeys(map(body_of, allowed))
        return dict.fromkeys((path, point, body) for path, point in _portals(k, task) for body in bodies)
    own = {task.entry: ("entry",), task.exit: ("exit",), task.action.pickup: ("action", "pickup")}
    own[task.position] = ("position",)
    doings = [(body_of(robot), plan(task, robot)) for robot in allowed]
    passed = [(body, point) for body, doing in doings if isinstance(doing, TaskMotion) for point in doing.points]
    return dict.fromkeys((("tasks", k, *own.get(point, ("action",))), point, body) for body, point in passed)


def _portals(k: int, task: Task) -> Iterator[tuple[Path, Point]]:
    if task.entry is None or task.exit is None:
        yield ("tasks", k, "position"), task.position
    if task.entry is not None:
        yield ("tasks", k, "entry"), task.entry
    if task.exit is not None:
        yield ("tasks", k, "exit"), task.exit


def _blocked(world: World, places: Iterable[tuple[Path, Point, Body]], owner: str) -> Iterator[BlockedPlace]:
    for path, point, body in places:
        space = world.free_space(body.radius_m, body.kind)
        if not free(space, np.array([point]))[0]:
            yield BlockedPlace(path, owner, point, body, why_blocked(world, point, body))


def why_blocked(world: World, point: Point, body: Body) -> str:
    """Why a point is blocked for a body: the obstacle that contains it, or one that is too near."""
    import shapely

    foot, three_d = shapely.Point(point[:2]), world.dimensions == 3
    if world.boundary is not None and not world.boundary.intersects(foot):
        return "outside the boundary"
    if world.image is not None and not _on_image(world.image, point):
        return "outside the map"
    areas = world.stopping(body, three_d)
    flies = isinstance(world.free_space(body.radius_m, body.kind), PrismSpace)
    gaps = [(_gap(area, foot, point, flies), f"zone {area.number}") for area in areas]
    for gap, name in gaps:
        if gap == 0:
            return f"inside {name}"
    if world.boundary is not None:
        gaps.append((foot.distance(world.boundary.exterior), "the boundary"))
    else:
        cells = world.blocked(body, three_d)
        gaps.append((float(world.clearance(np.array([point]), body.kind, body.radius_m)[0]), "a wall"))
        if gaps[-1][0] == 0:
            return "inside a wall, or where the map is unknown"
        if gaps[-1][0] >= body.radius_m:
            return f"in a cell of {cells.resolution_m:g} m that is nearer than {body.radius_m:g} m to a wall"
    gap, name = min(gaps)
    if gap >= body.radius_m and flies and point[2] < world.lowest_m:
        return "below the ground"
    return f"{gap:.3g} m from {name}, radius {body.radius_m:g} m"


def _gap(area: Area, foot: shapely.Point, point: Point, flies: bool) -> float:
    import shapely

    away = float(shapely.distance(area.polygon, foot))
    if not flies:
        return away
    return float(np.hypot(away, max(area.floor_m - point[2], point[2] - area.ceiling_m, 0.0)))


def _on_image(grid: Grid, point: Point) -> bool:
    column, row = grid.to_grid(np.array([point[:2]]))[0]
    rows, columns = grid.shape
    return bool(0 <= column <= columns and 0 <= row <= rows)
