"""Figures of what robots did: their rows of reports, work after they had to be back, and when they were."""

from __future__ import annotations

from collections.abc import Iterable

from muster.execution.reports.robot_report import RobotReport
from muster.execution.robots.robot_state import Activity, RobotState
from muster.mission.system.clock import TIME_ROUNDING_S


def robot_row(state: RobotState, planned: float) -> RobotReport:
    """What a robot used, beside what was planned for it, and did at stations."""
    energy, left = state.energy, state.share_left
    least, added = (None, 0.0) if energy is None else (energy.lowest / energy.capacity, energy.added)
    return RobotReport(state.robot.id, planned, state.used, left, least, added, state.visits, state.slot_wait_s)


def overtime_s(worked: Iterable[RobotState], now: float) -> dict[str, float]:
    """By how many seconds robots that worked were under way after they had to be back; those alone that were."""
    found = {}
    for state in worked:
        over_by_s = state.limits.due_s(state.known.left_s)
        back_s = state.begun_s if state.activity is Activity.IDLE else now
        if back_s - over_by_s > TIME_ROUNDING_S:
            found[state.robot.id] = back_s - over_by_s
    return found


def back_s(worked: Iterable[RobotState]) -> tuple[float, ...]:
    """When the robots that worked and are idle now had come to their ends."""
    return tuple(state.begun_s for state in worked if state.activity is Activity.IDLE)


def planned_so_far(state: RobotState) -> float:
    """Return the planned usage of the part of its route that a robot has carried out, the present leg in part."""
    since = max(0.0, state.used - state.used_before)
    has_task = bool(state.route) and state.activity in (Activity.DRIVING, Activity.WAITING, Activity.WORKING)
    return state.known.planned + (min(since, state.usage_to_task) if has_task else since)
