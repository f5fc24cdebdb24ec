"""The routes of a plan as lines to be drawn. No drawing here.

All places are metres in the map frame, `(n, d)` with d 2 or 3 as the picture has dimensions.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from itertools import pairwise
from typing import Protocol

import numpy as np
from numpy.typing import NDArray

from muster.mission.model import Mission, Point, Robot, Station, Task
from muster.motion.actions import Impossible, TaskMotion, plan
from muster.motion.path import NoPath
from muster.verification import RouteFigures, Verdict

Places = NDArray[np.float64]


@dataclass(frozen=True)
class RobotLines:
    """One robot's route as lines.

    `numbers` are those of the tasks in the route, stations counted with them, as sheets count them.
    `travel` runs from the start through tasks and stations, from exit to entry, over a map along the paths that are
    driven.
    `work` runs along the way points of a task's action, else from its entry through its position to its exit, where
    these differ; `lanes` is the work that covers areas. All three are polylines, separated by rows of NaN. `end` is the
    leg from the last stop to where the route must end; it has no rows where the route may end anywhere.
    """

    index: int
    robot: Robot
    figures: RouteFigures
    tasks: tuple[Task, ...]
    numbers: tuple[int, ...]
    positions: Places
    travel: Places
    work: Places
    lanes: Places
    end: Places

    @property
    def all_work(self) -> Places:
        """`work` and `lanes` as one."""
        gap = np.full((1, self.work.shape[1]), np.nan)
        parts = [part for part in (self.work, self.lanes) if len(part)]
        return np.vstack([parts[0], gap, parts[1]]) if len(parts) > 1 else parts[0] if parts else self.work


class PathFunction(Protocol):
    """The paths of robots."""

    def __call__(self, robot: Robot, start: Point, goal: Point, *, at_work: bool = False) -> Sequence[Point]:
        """Return the points that a robot passes from one place to another, both included; at work it is on no lanes."""


def robot_lines(mission: Mission, verdict: Verdict, dimensions: int) -> list[RobotLines]:
    """The lines of all robots, in mission order."""
    path = path_function(mission)
    places_of: dict[str, Task | Station] = {task.id: task for task in mission.tasks}
    places_of |= {station.id: station for station in mission.stations}
    found = []
    for index, (robot, figures) in enumerate(zip(mission.robots, verdict.routes, strict=True)):
        route = tuple(places_of[name] for name in [stop.name for stop in figures.stops] or figures.tasks)
        found.append(_lines_of(index, robot, figures, route, robot.place_at_end(mission.rules), dimensions, path))
    return found


def path_function(mission: Mission) -> PathFunction:
    """The path of a robot between two places: over the map or along lanes where travel is by these, else straight."""
    if mission.driven_lanes is None and mission.travel_rule != "map":
        return lambda robot, start, goal, *, at_work=False: (start, goal)
    from muster.motion.map_world import body_of
    from muster.motion.paths.robot_paths import RobotPaths

    robot_paths = RobotPaths.of(mission)

    def path(robot: Robot, start: Point, goal: Point, *, at_work: bool = False) -> Sequence[Point]:
        found = robot_paths.path(body_of(robot, None if at_work else mission), start, goal)
        return (start, goal) if isinstance(found, NoPath) else [tuple(point) for point in found.points.tolist()]

    return path


def _lines_of(
    index: int,
    robot: Robot,
    figures: RouteFigures,
    route: tuple[Task | Station, ...],
    end: Point | None,
    dimensions: int,
    path: PathFunction,
) -> RobotLines:
    travel, here = [[robot.position]], robot.position
    work: list[list[Point]] = []
    lanes: list[list[Point]] = []
    for stop in route:
        points = (stop.position,) if isinstance(stop, Station) else work_points(stop, robot)
        travel[-1] += path(robot, here, points[0])[1:]
        if len(points) > 1:
            legs = _work_legs(stop, robot, points, path)
            (lanes if has_area(stop) else work).append([points[0], *(point for leg in legs for point in leg[1:])])
        here = points[-1]
        if points[0] != here:
            travel.append([here])
    tasks = tuple(stop for stop in route if isinstance(stop, Task))
    return RobotLines(
        index=index,
        robot=robot,
        figures=figures,
        tasks=tasks,
        numbers=tuple(number for number, stop in enumerate(route, 1) if isinstance(stop, Task)),
        positions=places((marked_place(task, robot) for task in tasks), dimensions),
        travel=_polylines(travel, dimensions),
        work=_polylines(work, dimensions),
        lanes=_polylines(lanes, dimensions),
        end=places(path(robot, here, end) if end is not None and route else [], dimensions),
    )


def work_points(task: Task, robot: Robot) -> Sequence[Point]:
    """The points that a robot passes at a task; the task's position for a robot that cannot do it."""
    doing = plan(task, robot)
    return (task.position,) if isinstance(doing, Impossible) else doing.points


def has_area(stop: Task | Station) -> bool:
    """Whether a stop is a task over an area."""
    return isinstance(stop, Task) and stop.action is not None and stop.action.area is not None


def marked_place(task: Task, robot: Robot) -> Point:
    """Where a task bears its mark: its position; over an area the middle of a lane in the midst of its lanes."""
    if not has_area(task):
        return task.position
    passed = np.array([point[: len(task.position)] for point in work_points(task, robot)])
    if len(passed) < 2:
        return task.position
    points = (passed[1:] + passed[:-1]) / 2
    nearest = np.linalg.norm(points - points.mean(axis=0), axis=1).argmin()
    return tuple(points[nearest].tolist())


def marks_of(mission: Mission, drawn: Iterable[RobotLines]) -> dict[str, Point]:
    """Where each task bears its mark, by id; one over an area that nobody does at its position."""
    areas = {task.id for task in mission.tasks if has_area(task)}
    done = {
        task.id: tuple(at) for lines in drawn for task, at in zip(lines.tasks, lines.positions.tolist(), strict=True)
    }
    return {task.id: done[task.id] if task.id in areas & done.keys() else task.position for task in mission.tasks}


def _work_legs(
    stop: Task | Station, robot: Robot, points: Sequence[Point], path: PathFunction
) -> Sequence[Sequence[Point]]:
    """The lines between the points of a stop: where an action moves the robot its paths, else straight."""
    doing = (
        plan(stop, robot) if isinstance(stop, Task) and stop.action is not None and stop.action.has_geometry else None
    )
    if not isinstance(doing, TaskMotion):
        return [points]
    return [path(robot, start, goal, at_work=not doing.is_travel) for start, goal in pairwise(points)]


def left_out(mission: Mission, verdict: Verdict) -> list[Task]:
    """List the tasks in no route, in mission order."""
    done = {name for route in verdict.routes for name in route.tasks}
    return [task for task in mission.tasks if task.id not in done]


def places(points: Iterable[Point], dimensions: int) -> Places:
    """Turn points into `(n, dimensions)`; z is 0 where a point has none."""
    rows = [(*point, 0.0)[:dimensions] for point in points]
    return np.array(rows, dtype=np.float64).reshape(-1, dimensions)


def _polylines(lines: Sequence[Sequence[Point]], dimensions: int) -> Places:
    """Join lines of at least two points, separated by rows of NaN."""
    gap = np.full((1, dimensions), np.nan)
    parts: list[Places] = []
    for line in lines:
        if len(line) > 1:
            parts += [gap, places(line, dimensions)] if parts else [places(line, dimensions)]
    return np.vstack(parts) if parts else np.empty((0, dimensions))
