"""The legs and the work of a route that enter closed areas."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from itertools import pairwise

from muster.mission.model import Mission, Point, Robot, Task
from muster.motion.actions import TaskMotion
from muster.verification.closed_areas import ClosedAreas
from muster.verification.known_routes import Planned
from muster.verification.travel import (
    doing_at,
    place_at_end,
    place_of_start,
    place_of_station,
    place_of_task,
)
from muster.verification.verdict import Violation

CLOSED_AREA = "closed-area"


def closed_legs(mission: Mission, areas: ClosedAreas, robot: Robot, stops: Iterable[Planned]) -> Iterator[Violation]:
    """Find every leg, work and end of a route that enters an area that is closed to its robot.

    Straight legs, and straight work between way points, are checked from end to end. Where travel is by a table or by
    shortest paths, which keep out by themselves, the places of work and of stations are checked.
    """
    whole = mission.travel_rule == "euclidean"
    here, left_at = "its start", place_of_start(robot).exit
    for stop in stops:
        task = stop.id if isinstance(stop, Task) else None
        place = place_of_task(stop, robot) if isinstance(stop, Task) else place_of_station(stop.station)
        name = f"{'station' if task is None else 'task'} {place.id}"
        found = areas.obstacle(robot, left_at if whole else place.entry, place.entry)
        if found is not None:
            way = f"the leg from {here} to {name}" if whole else f"at {name} the robot"
            yield Violation(CLOSED_AREA, robot.id, task, f"{way} {found}")
        elif isinstance(stop, Task) and (work := _work(areas, robot, stop, whole=whole)) is not None:
            yield Violation(CLOSED_AREA, robot.id, task, work)
        here, left_at = name, place.exit
    end = place_at_end(robot, mission.rules) if whole and here != "its start" else None
    if end is not None and (found := areas.obstacle(robot, left_at, end.entry)) is not None:
        yield Violation(CLOSED_AREA, robot.id, None, f"the leg from {here} to where the route must end {found}")


def _work(areas: ClosedAreas, robot: Robot, task: Task, *, whole: bool) -> str | None:
    """What the work on a task enters or leaves."""
    doing = doing_at(robot, task)
    points: tuple[Point, ...] = doing.points if isinstance(doing, TaskMotion) else ()
    if doing is None:
        points = (task.entry or task.position, task.exit or task.position)
    for start, end in pairwise(points) if whole else ((point, point) for point in points):
        found = areas.obstacle(robot, start, end)
        if found is not None:
            places = " to ".join(f"({', '.join(f'{c:g}' for c in point)})" for point in dict.fromkeys((start, end)))
            return f"the work at {places} {found}"
    return None
