"""No leg and no work enters an area that is closed to the robot."""

from __future__ import annotations

from collections.abc import Iterator
from itertools import pairwise

from muster.mission.model import Task
from muster.motion.actions import TaskMotion
from muster.verification.case import Case
from muster.verification.measure import MeasuredRoute, Step, place_of_stop
from muster.verification.travel import doing_at, place_at_end, place_of_start
from muster.verification.verdict import Violation


class ClosedArea:
    """Robots keep out of zones that are closed to them, and inside the boundary. It cannot be ignored.

    Straight legs and the straight work between way points are checked from end to end; where travel is by a table or
    by shortest paths, which keep out by themselves, the places of work are.
    """

    kind = "closed-area"
    ignorable = False

    def violations(self, case: Case, route: MeasuredRoute) -> Iterator[Violation]:
        robot, areas = route.robot, case.travel.areas
        here, left_at = "its start", place_of_start(robot)
        for stop in route.stops:
            task = stop.task.id if isinstance(stop, Step) else None
            name = f"{'task' if isinstance(stop, Step) else 'station'} {stop.place_id}"
            there = place_of_stop(stop, robot)
            start = left_at.exit if case.travel.is_checked_along_legs else there.entry
            found = areas.obstacle(robot, start, there.entry)
            if found is not None:
                way = f"the leg from {here} to {name}" if case.travel.is_checked_along_legs else f"{name} is where it"
                yield Violation(self.kind, robot.id, task, f"{way} {found}")
            elif isinstance(stop, Step) and (at_work := self._work(case, route, stop.task)) is not None:
                yield Violation(self.kind, robot.id, task, at_work)
            here, left_at = name, there
        end = place_at_end(robot, case.mission.rules) if route.stops else None
        if end is not None and case.travel.is_checked_along_legs:
            found = areas.obstacle(robot, left_at.exit, end.entry)
            if found is not None:
                detail = f"the leg from {here} to where the route must end {found}"
                yield Violation(self.kind, robot.id, None, detail)

    def _work(self, case: Case, route: MeasuredRoute, task: Task) -> str | None:
        """What the work on a task enters or leaves."""
        robot = route.robot
        doing = doing_at(robot, task)
        points = doing.points if isinstance(doing, TaskMotion) else ()
        if doing is None:
            points = (task.entry or task.position, task.exit or task.position)
        legs = pairwise(points) if case.travel.is_checked_along_legs else ((point, point) for point in points)
        for start, end in legs:
            found = case.travel.areas.obstacle(robot, start, end)
            if found is not None:
                places = " to ".join(f"({', '.join(f'{c:g}' for c in point)})" for point in dict.fromkeys((start, end)))
                return f"the work at {places} {found}"
        return None

    def prevents(self, case: Case, route: MeasuredRoute, task: Task) -> bool | None:
        """False: that a leg does not exist is the rule `unreachable`'s to say."""
        return False
