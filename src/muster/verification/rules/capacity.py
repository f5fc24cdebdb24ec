"""A route uses no more than the robot's work capacity, the reserve taken off."""

from __future__ import annotations

from collections.abc import Iterator

from muster.mission.model import Task
from muster.verification.case import Case
from muster.verification.measure import MeasuredRoute
from muster.verification.rules.usage_limit import keeps_within
from muster.verification.verdict import Violation


class Capacity:
    """`u_i <= (1 - capacity_reserve) * work_capacity_i`: [tcf-thesis] (3.14)."""

    kind = "capacity"
    ignorable = True

    def violations(self, case: Case, route: MeasuredRoute) -> Iterator[Violation]:
        capacity = case.capacity_of(route.robot)
        if capacity is not None and route.usage > capacity * (1 + case.tolerance):
            detail = f"usage {route.usage:.10g} {case.unit}, at most {capacity:.10g} {case.unit}"
            yield Violation(self.kind, route.robot.id, None, detail)

    def prevents(self, case: Case, route: MeasuredRoute, task: Task) -> bool | None:
        """Whether the route would use more than the capacity with the task at any place in it.

        Undecided where there is room, but maybe only where other rules allow no work (see `keeps_within`).
        """
        capacity = case.capacity_of(route.robot)
        if capacity is None:
            return None if case.needs_others(task) else False  # another of its team may have too little
        within = keeps_within(case, route, task, capacity)
        return None if within is None else not within
