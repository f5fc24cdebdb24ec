"""Whether a route with one more task keeps within a limit of usage."""

from __future__ import annotations

from muster.mission.model import Task
from muster.motion.leg_times import LegTimes
from muster.verification.case import Case
from muster.verification.measure import MeasuredRoute


def keeps_within(case: Case, route: MeasuredRoute, task: Task, limit: float) -> bool | None:
    """Whether the route would use at most so much with the task at its best place.

    Undecided where that is too close to say, or where there is room, but maybe only where other rules allow no work:
    those of times, teams, relations, goods, energy. Undecided also where the route could do without some of its
    stations, or where the other task of a pair might shorten it.
    """
    if case.unit == "s" and not LegTimes.in_mission(route.robot, case.mission).is_constant:
        return None  # insertions are measured in metres
    usage = case.insertions(route).least_usage(task, case.first_gap(route, task), limit)
    if abs(usage - limit) <= limit * case.tolerance:
        return None
    if usage <= limit:
        return None if case.is_timed else True
    has_detours = len(route.steps) < len(route.stops)
    return None if has_detours or (case.travel.may_need_detours and case.is_paired(task)) else False
