"""The robot has a path along its route and along the way points of each action."""

from __future__ import annotations

from collections.abc import Iterator

from muster.mission.model import Task
from muster.verification.case import Case
from muster.verification.measure import MeasuredRoute, Step
from muster.verification.rules.closed_area import ClosedArea
from muster.verification.verdict import Violation


class Unreachable:
    """Every leg of a route has a way. It cannot be ignored."""

    kind = "unreachable"
    ignorable = False

    def violations(self, case: Case, route: MeasuredRoute) -> Iterator[Violation]:
        closed = {violation.task for violation in ClosedArea().violations(case, route)}  # which say more
        here = "its start"
        for stop in route.stops:
            task = stop.task.id if isinstance(stop, Step) else None
            if not stop.leg.exists and task not in closed:
                there = "" if isinstance(stop, Step) else f" to station {stop.place_id}"
                yield Violation(self.kind, route.robot.id, task, f"no way from {here}{there}")
            if isinstance(stop, Step) and not stop.passable and task not in closed:
                geometry = stop.task.action is not None and stop.task.action.has_geometry
                way = "along the way points of its action" if geometry else "from its entry to its exit"
                yield Violation(self.kind, route.robot.id, task, f"no way {way}")
            here = f"{'task' if isinstance(stop, Step) else 'station'} {stop.place_id}"
        if None not in closed and route.last_leg is not None and not route.last_leg.exists:
            yield Violation(self.kind, route.robot.id, None, f"no way from {here} to where the route must end")

    def prevents(self, case: Case, route: MeasuredRoute, task: Task) -> bool | None:
        """Whether no place in the route has a way to the task, along it and on.

        Undecided if other robots may have none, or if lags or batteries may leave the places alone that have none, and
        where there may be one from a station.
        """
        if not case.insertions(route).is_reachable(task, case.first_gap(route, task)):
            return None if case.mission.stations and case.travel.may_need_detours else True
        narrowed = case.has_within or case.has_goods or case.has_energy
        return None if case.needs_others(task) or narrowed else False
