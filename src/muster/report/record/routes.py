"""Where the routes of a plan lead, as lines, for a plan that is made while the mission is under way."""

from __future__ import annotations

from collections.abc import Mapping

from muster.mission.model import Mission, Point
from muster.mission.plan import Plan
from muster.report.record.mission_state import CANCELLED, DONE, LOST, MissionState
from muster.report.route_lines import Way, way_in

_OVER = (DONE, LOST, CANCELLED)


class RouteLines:
    """Draws routes over the mission's map, each leg's way found once."""

    def __init__(self, mission: Mission) -> None:
        self._way: Way = way_in(mission)
        self._dimensions = mission.dimensions
        self._found: dict[tuple[str, Point, Point], tuple[Point, ...]] = {}

    def of(self, plan: Plan, situation: MissionState, places: Mapping[str, Point]) -> dict[str, list[Point]]:
        """The points of each robot's route, in the situation in which the plan is made: where it still has to go.

        Parameters
        ----------
        places
            where robots are; one that is not there is where it starts.
        """
        return {
            route.robot: self._line(route.robot, route.tasks, situation, places)
            for route in plan.routes
            if route.robot in situation.robots
        }

    def _line(
        self, name: str, tasks: tuple[str, ...], situation: MissionState, places: Mapping[str, Point]
    ) -> list[Point]:
        robot = situation.robots[name]
        line = [self._flat(places.get(name, robot.position))]
        left = [situation.tasks[task] for task in tasks if situation.states.get(task, DONE) not in _OVER]
        for task in left:
            line += self._leg(name, situation, line[-1], self._flat(task.entry or task.position))
            line += [self._flat(place) for place in (task.position, task.exit or task.position) if place != line[-1]]
        end = robot.place_at_end(situation.mission.rules)
        if end is not None and left:
            line += self._leg(name, situation, line[-1], self._flat(end))
        return line

    def _leg(self, name: str, situation: MissionState, start: Point, goal: Point) -> tuple[Point, ...]:
        leg = (name, start, goal)
        if leg not in self._found:
            self._found[leg] = tuple(tuple(point) for point in self._way(situation.robots[name], start, goal))[1:]
        return self._found[leg]

    def _flat(self, place: Point) -> Point:
        """As many coordinates as the mission has."""
        return tuple(float(value) for value in (*place, 0.0)[: self._dimensions])
