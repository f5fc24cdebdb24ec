"""The routes of a plan as lines, for a plan that is made while the mission is under way."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence

from muster.mission.model import Mission, Point
from muster.mission.plan import Plan
from muster.report.record.mission_state import CANCELLED, DONE, LOST, MissionState
from muster.report.route_lines import PathFunction, path_function

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
        robot = mission_state.robots[name]
        line = [self._flat(places.get(name, robot.position))]
        left = list(_left(tasks, mission_state))
        for entry, place, leave in left:
            line += self._leg(name, mission_state, line[-1], self._flat(entry))
            line += [self._flat(one) for one in (place, leave) if one != line[-1]]
        end = robot.place_at_end(mission_state.mission.rules)
        if end is not None and left:
            line += self._leg(name, mission_state, line[-1], self._flat(end))
        return line

    def _leg(self, name: str, mission_state: MissionState, start: Point, goal: Point) -> tuple[Point, ...]:
        leg = (name, start, goal)
        if leg not in self._found:
            if len(self._found) >= _MOST_LEGS:
                self._found.clear()
            self._found[leg] = tuple(tuple(point) for point in self._path(mission_state.robots[name], start, goal))[1:]
        return self._found[leg]

    def _flat(self, place: Point) -> Point:
        """As many coordinates as the mission has."""
        return tuple(float(value) for value in (*place, 0.0)[: self._dimensions])


def _left(names: Sequence[str], mission_state: MissionState) -> Iterator[tuple[Point, Point, Point]]:
    """Entry, position and exit of each stop that is still ahead: stations after the last task that is over, too."""
    stations = {station.id: station.position for station in mission_state.mission.stations}
    over = [k for k, name in enumerate(names) if name not in stations and _is_over(name, mission_state)]
    for k, name in enumerate(names):
        if name in stations:
            if k > max(over, default=-1):
                yield (stations[name],) * 3
        elif k not in over:
            task = mission_state.tasks[name]
            yield task.entry or task.position, task.position, task.exit or task.position


def _is_over(task: str, mission_state: MissionState) -> bool:
    return mission_state.states.get(task, DONE) in _OVER
