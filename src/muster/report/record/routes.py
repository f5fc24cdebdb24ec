"""The routes of a plan as lines, for a plan that is made while the mission is under way."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping, Sequence
from itertools import pairwise

from muster.mission.model import Mission, Point, Robot, Task
from muster.mission.plan import Plan
from muster.report.route_lines import PathFunction, has_area, path_function, work_points
from muster.state.mission_state import CANCELLED, DONE, LOST, UNDER_WAY, MissionState

_OVER = (DONE, LOST, CANCELLED)
_MOST_LEGS = 10_000  # that are kept: a standing fleet has new ones for ever


class RouteLines:
    """Makes the lines of routes; each path over the map is kept for a while."""

    def __init__(self, mission: Mission) -> None:
        self._path: PathFunction = path_function(mission)
        self._dimensions = mission.dimensions
        self._found: dict[tuple[str, Point, Point], tuple[Point, ...]] = {}

    def of(self, plan: Plan, mission_state: MissionState, places: Mapping[str, Point]) -> dict[str, list[Point]]:
        """The points of each robot's remaining route when the plan is made.

        Parameters
        ----------
        places
            the robots' positions; an absent robot is at its start.
        """
        return {
            route.robot: self._line(route.robot, route.tasks, mission_state, places)
            for route in plan.routes
            if route.robot in mission_state.robots
        }

    def _line(
        self, name: str, tasks: tuple[str, ...], mission_state: MissionState, places: Mapping[str, Point]
    ) -> list[Point]:
        robot = mission_state.robots[name].robot
        line = [self._flat(places.get(name, robot.position))]
        left = [[self._flat(one) for one in stop] for stop in _left(tasks, mission_state, robot, line[0])]
        for first, *others in left:
            line += self._leg(name, mission_state, line[-1], first)
            line += [one for k, one in enumerate(others) if one != (first, *others)[k]]
        end = robot.place_at_end(mission_state.mission.rules)
        if end is not None and left:
            line += self._leg(name, mission_state, line[-1], self._flat(end))
        return line

    def _leg(self, name: str, mission_state: MissionState, start: Point, goal: Point) -> tuple[Point, ...]:
        leg = (name, start, goal)
        if leg not in self._found:
            if len(self._found) >= _MOST_LEGS:
                self._found.clear()
            robot = mission_state.robots[name].robot
            self._found[leg] = tuple(tuple(point) for point in self._path(robot, start, goal))[1:]
        return self._found[leg]

    def _flat(self, place: Point) -> Point:
        """As many coordinates as the mission has."""
        return tuple(float(value) for value in (*place, 0.0)[: self._dimensions])


def names_ahead(names: Sequence[str], mission_state: MissionState) -> list[str]:
    """Return the stops of a route that are ahead: tasks that are not over, and stations after the last that is."""
    stations = {station.id for station in mission_state.mission.stations}
    over = {k for k, name in enumerate(names) if name not in stations and is_over(name, mission_state)}
    last = max(over, default=-1)
    return [name for k, name in enumerate(names) if (k > last if name in stations else k not in over)]


def _left(names: Sequence[str], mission_state: MissionState, robot: Robot, here: Point) -> Iterator[Sequence[Point]]:
    """The points of each stop that is still ahead of a robot."""
    stations = {station.id: station.position for station in mission_state.mission.stations}
    for name in names_ahead(names, mission_state):
        if name in stations:
            yield (stations[name],)
        else:
            task = mission_state.tasks[name]
            yield _lanes_left(mission_state, task, robot, here) if has_area(task) else _passed(task)


def _passed(task: Task) -> Sequence[Point]:
    return task.entry or task.position, task.position, task.exit or task.position


def _lanes_left(mission_state: MissionState, task: Task, robot: Robot, here: Point) -> Sequence[Point]:
    """The lanes over an area; of an area on which the robot works those that follow the nearest place."""
    points = work_points(task, robot)
    if mission_state.stage(task.id) != UNDER_WAY or len(points) < 2:
        return points
    gaps = [_gap(here, *(point[: len(here)] for point in lane)) for lane in pairwise(points)]
    return points[1 + gaps.index(min(gaps)) :]


def _gap(place: Point, start: Point, end: Point) -> float:
    """How far a place is from a straight line between two others."""
    along = [b - a for a, b in zip(start, end, strict=True)]
    square = sum(value * value for value in along)
    ahead = sum((p - a) * value for p, a, value in zip(place, start, along, strict=True))
    share = min(max(ahead / square, 0.0), 1.0) if square else 0.0
    return math.dist(place, [a + share * value for a, value in zip(start, along, strict=True)])


def is_over(task: str, mission_state: MissionState) -> bool:
    """Return whether a task is done, lost or cancelled."""
    return task not in mission_state.tasks or mission_state.stage(task) in _OVER
