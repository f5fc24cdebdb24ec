"""How far it is from place to place: DESIGN section 4, thesis equation (3.9)."""

from __future__ import annotations

import math
from dataclasses import dataclass

from muster.mission.model import Mission, Point, Robot, Rules, Task
from muster.verification.ways import MapWays


@dataclass(frozen=True)
class Place:
    """Where a leg ends or begins: its id in travel tables; where one arrives and leaves, metres in the map frame."""

    id: str
    entry: Point
    exit: Point


def place_of_task(task: Task) -> Place:
    return Place(task.id, entry=task.entry or task.position, exit=task.exit or task.position)


def place_of_start(robot: Robot) -> Place:
    return Place(robot.id, entry=robot.position, exit=robot.position)


def place_at_end(robot: Robot, rules: Rules) -> Place | None:
    """Return where the robot's route must end, or None. In a travel table it is the row of the robot: its start."""
    point = robot.place_at_end(rules)
    return None if point is None else Place(robot.id, entry=point, exit=point)


def _points(mission: Mission) -> list[Point]:
    """All points where a leg of some route may begin or end."""
    ends = [place_at_end(robot, mission.rules) for robot in mission.robots]
    places = [*map(place_of_start, mission.robots), *map(place_of_task, mission.tasks), *filter(None, ends)]
    return [point for place in places for point in (place.entry, place.exit)]


class Travel:
    """The lengths of legs in a mission.

    Raises
    ------
    MissionError, MissingExtraError
        for travel over a map, as `World.of`.
    """

    def __init__(self, mission: Mission) -> None:
        self._ways = MapWays(mission, _points(mission)) if mission.travel_rule == "map" else None
        self._by_table = mission.travel_rule == "matrix"
        self._tables = mission.travel_tables
        self._index = {kind: {place: k for k, place in enumerate(table.places)} for kind, table in self._tables.items()}

    @property
    def tolerance(self) -> float:
        """By how much, relative, a right length may differ from these: 0, but where a map is in play."""
        return 0.0 if self._ways is None else self._ways.tolerance

    def metres(self, robot: Robot, start: Place, end: Place) -> float | None:
        """Return the length of the leg from the exit of `start` to the entry of `end`; None if there is no way."""
        if self._ways is not None:
            return self._ways.metres(robot, start.exit, end.entry)
        length = self._tabled(robot, start, end) if self._by_table else math.dist(start.exit, end.entry)
        return length if math.isfinite(length) else None

    def _tabled(self, robot: Robot, start: Place, end: Place) -> float:
        assert robot.type is not None  # a mission with travel tables has one for each robot's type
        index = self._index[robot.type]
        return float(self._tables[robot.type].metres[index[start.id]][index[end.id]])
