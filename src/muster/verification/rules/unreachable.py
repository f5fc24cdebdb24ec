"""The robot has a path along its route and along the way points of each action."""

from __future__ import annotations

from collections.abc import Iterator

from muster.mission.model import Task
from muster.verification.case import Case
from muster.verification.measure import MeasuredRoute
from muster.verification.verdict import Violation


class Unreachable:
    """Every leg of a route has a way. It cannot be ignored."""

    kind = "unreachable"
    ignorable = False

    def violations(self, case: Case, route: MeasuredRoute) -> Iterator[Violation]:
        here = "its start"
        for step in route.steps:
            if not step.leg.exists:
                yield Violation(self.kind, route.robot.id, step.task.id, f"no way from {here}")
            if not step.passable:
                geometry = step.task.action is not None and step.task.action.has_geometry
                way = "along the way points of its action" if geometry else "from its entry to its exit"
                yield Violation(self.kind, route.robot.id, step.task.id, f"no way {way}")
            here = f"task {step.task.id}"
        if route.last_leg is not None and not route.last_leg.exists:
            yield Violation(self.kind, route.robot.id, None, f"no way from {here} to where the route must end")

    def prevents(self, case: Case, route: MeasuredRoute, task: Task) -> bool | None:
        """Whether no place in the route has a way to the task, along it and on.

        Undecided if other robots may have none, or if lags may leave the places alone that have none.
        """
        if not case.insertions(route).is_reachable(task, case.first_gap(route, task)):
            return True
        return None if case.needs_others(task) or case.has_within else False
