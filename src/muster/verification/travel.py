"""The judge's own distances between places (docs/design.md, Meaning; [tcf-thesis] (3.9))."""

from __future__ import annotations

import math
from typing import NamedTuple

from muster.mission.model import Mission, Point, Robot, Rules, Station, Task
from muster.motion.actions import Impossible, TaskMotion, plan
from muster.motion.leg_times import LegTimes
from muster.verification.closed_areas import ClosedAreas
from muster.verification.lane_travel import TOLERANCE as LANE_TOLERANCE
from muster.verification.lane_travel import LaneTravel, Length
from muster.verification.map_paths import MapPaths


class Place(NamedTuple):
    """Where a leg ends or begins: its id in travel tables; where one arrives and leaves, metres in the map frame."""

    id: str
    entry: Point
    exit: Point


def place_of_task(task: Task, robot: Robot | None = None) -> Place:
    """Return the place of a task for a robot, which may be left out where the task's action has no geometry.

    Of one that the robot cannot do it is the task's position.
    """
    if _has_geometry(task):
        assert robot is not None
        doing = plan(task, robot)
        if isinstance(doing, TaskMotion):
            return Place(task.id, entry=doing.entry, exit=doing.exit)
    return Place(task.id, entry=task.entry or task.position, exit=task.exit or task.position)


def doing_at(robot: Robot, task: Task) -> TaskMotion | Impossible | None:
    """Return how the robot does a task whose action has geometry; None for all other tasks, which anyone can do."""
    return plan(task, robot) if _has_geometry(task) else None


def _has_geometry(task: Task) -> bool:
    return task.action is not None and task.action.has_geometry


def rise_m(start: Place, end: Place) -> float:
    """Metres between the heights of the two ends of a leg."""
    return abs(end.entry[2] - start.exit[2]) if len(start.exit) > 2 else 0.0


def place_of_start(robot: Robot) -> Place:
    return Place(robot.id, entry=robot.position, exit=robot.position)


def place_of_station(station: Station) -> Place:
    return Place(station.id, entry=station.position, exit=station.position)


def place_at_end(robot: Robot, rules: Rules) -> Place | None:
    """Return where the robot's route must end, or None. In a travel table it is the row of the robot: its start."""
    point = robot.place_at_end(rules)
    return None if point is None else Place(robot.id, entry=point, exit=point)


def _points(mission: Mission) -> list[Point]:
    """All points where a leg of some route, or of the work on a task, may begin or end."""
    ends = [place_at_end(robot, mission.rules) for robot in mission.robots]
    points = [place.entry for place in (*map(place_of_start, mission.robots), *filter(None, ends))]
    points += [station.position for station in mission.stations]
    for task in mission.tasks:
        points += [task.entry or task.position, task.exit or task.position]
        doings = (doing_at(robot, task) for robot in mission.robots)
        points += [point for doing in doings if isinstance(doing, TaskMotion) for point in doing.points]
    return list(dict.fromkeys(points))


class Travel:
    """The lengths of legs in a mission.

    Raises
    ------
    MissionError, MissingExtraError
        for travel over a map, as `World.of`.
    """

    def __init__(self, mission: Mission) -> None:
        self._paths = MapPaths(mission, _points(mission)) if mission.travel_off_lanes == "map" else None
        self._mission, lanes = mission, mission.driven_lanes
        self._lanes = None if lanes is None else LaneTravel(lanes, self._paths)
        self._by_table = mission.travel_rule == "matrix"
        self.areas = ClosedAreas(mission)
        self._has_closed_legs = mission.has_straight_legs_among_areas
        self._tables = mission.travel_tables
        self._index = {kind: {place: k for k, place in enumerate(table.places)} for kind, table in self._tables.items()}

    @property
    def tolerance(self) -> float:
        """By how much, relative, a right length may differ from these: 0, but where a map is in play."""
        lanes = 0.0 if self._lanes is None else LANE_TOLERANCE
        return lanes if self._paths is None else max(lanes, self._paths.tolerance)

    @property
    def is_straight(self) -> bool:
        """Whether each leg is the straight line between its ends, which is open."""
        return self._paths is None and self._lanes is None and not self._by_table and not self._has_closed_legs

    @property
    def may_need_detours(self) -> bool:
        """Whether a place without a leg from another may be reached by way of a third."""
        return self._by_table or self._has_closed_legs or self._lanes is not None

    @property
    def is_tabled(self) -> bool:
        """Whether travel tables give the legs, whatever the places."""
        return self._by_table

    def metres(self, robot: Robot, start: Place, end: Place) -> float | None:
        """Return the length of the leg from the exit of `start` to the entry of `end`; None if there is no way."""
        if self.keeps_to_lanes(robot):
            return self._lane_metres(robot, start.exit, end.entry)
        if self._paths is not None:
            return self._paths.metres(robot, start.exit, end.entry)
        if not self._is_open(robot, start.exit, end.entry):
            return None
        if self._by_table:
            is_closed = end.id != robot.id and self.areas.obstacle(robot, end.entry, end.entry) is not None
            length = math.inf if is_closed else self._tabled(robot, start, end)
        else:
            length = math.dist(start.exit, end.entry)
        return length if math.isfinite(length) else None

    def keeps_to_lanes(self, robot: Robot) -> bool:
        """Whether a robot travels along lanes."""
        return self._lanes is not None and robot.kind == "ground"

    def lane_seconds(self, robot: Robot, start: Point, end: Point) -> float:
        """Return how long a leg along lanes takes from rest to rest; inf where there is none."""
        times = LegTimes.in_mission(robot, self._mission)
        found = self._lane_length(robot, start, end)
        return math.inf if found is None else float(times.lane_seconds(found.metres, found.seconds))

    def _lane_length(self, robot: Robot, start: Point, end: Point) -> Length | None:
        assert self._lanes is not None, "a robot that keeps to lanes"
        return self._lanes.length(robot, LegTimes.in_mission(robot, self._mission), start, end)

    def _lane_metres(self, robot: Robot, start: Point, end: Point) -> float | None:
        """The length of a leg along lanes, on which heights change evenly; None if there is none."""
        found = self._lane_length(robot, start, end)
        return (
            None
            if found is None
            else math.hypot(found.metres, *(p - q for p, q in zip(start[2:], end[2:], strict=True)))
        )

    def work_metres(self, robot: Robot, task: Task) -> float | None:
        """Return what the task costs the robot: the typed cost, or the legs between its way points.

        None if there is no way along these, or from its entry to its exit. What the robot cannot do costs nothing.
        """
        doing = doing_at(robot, task)
        if doing is None:
            place = place_of_task(task)
            if self.keeps_to_lanes(robot) and place.entry != place.exit:
                return None if self._lane_metres(robot, place.entry, place.exit) is None else task.actuation_cost
            if self._paths is None or place.entry == place.exit:
                return task.actuation_cost if self._is_open(robot, place.entry, place.exit) else None
            return None if self._paths.metres(robot, place.entry, place.exit) is None else task.actuation_cost
        if isinstance(doing, Impossible):
            return 0.0
        if self._paths is None and not (doing.is_travel and self.keeps_to_lanes(robot)):
            return doing.cost_m if all(self._is_open(robot, *leg) for leg in doing.legs) else None
        return None if math.inf in (lengths := self.leg_metres(robot, doing)) else math.fsum(lengths)

    def leg_metres(self, robot: Robot, doing: TaskMotion) -> list[float]:
        """Return the lengths of the legs between the way points of work that drives; inf where there is no way."""
        if doing.is_travel and self.keeps_to_lanes(robot):
            along = (self._lane_metres(robot, start, end) for start, end in doing.legs)
            return [math.inf if length is None else length for length in along]
        if self._paths is None:
            return [math.dist(start, end) for start, end in doing.legs]
        lengths = (self._paths.metres(robot, start, end) for start, end in doing.legs)
        return [math.inf if length is None else length for length in lengths]

    def _is_open(self, robot: Robot, start: Point, end: Point) -> bool:
        """Whether no closed area is in the way of a straight leg."""
        return not self._has_closed_legs or self.areas.obstacle(robot, start, end) is None

    def _tabled(self, robot: Robot, start: Place, end: Place) -> float:
        assert robot.type is not None  # a mission with travel tables has one for each robot's type
        index = self._index[robot.type]
        return float(self._tables[robot.type].metres[index[start.id]][index[end.id]])
