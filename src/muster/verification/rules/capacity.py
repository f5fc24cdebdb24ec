"""A route uses no more than the robot's work capacity, the reserve taken off."""

from __future__ import annotations

from collections.abc import Iterator

from muster.mission.model import Task
from muster.motion.leg_times import LegTimes
from muster.verification.case import Case
from muster.verification.measure import MeasuredRoute
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

        Undecided where there is room, but maybe only where other rules allow no work: those of times, teams, relations.
        """
        capacity = case.capacity_of(route.robot)
        if capacity is None:
            return None if case.needs_others(task) else False  # another of its team may have too little
        if case.unit == "s" and not LegTimes.in_mission(route.robot, case.mission).is_constant:
            return None  # insertions are measured in metres
        usage = case.insertions(route).least_usage(task, case.first_gap(route, task), capacity)
        if abs(usage - capacity) <= capacity * case.tolerance:
            return None
        return True if usage > capacity else (None if case.is_timed else False)
