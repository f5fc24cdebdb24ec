"""Work that several robots do at once is broken off for all of them."""

from __future__ import annotations

from collections.abc import Mapping

from muster.execution.robot_state import Activity, RobotState
from muster.execution.task_ledger import Ledger


def break_off(crew: Mapping[str, RobotState], ledger: Ledger, task: str, now: float) -> tuple[str, ...]:
    """Break off the work on a task, and on those that began with it: what was done of it is lost.

    All robots at work on them stop, free for a new plan. Returns the tasks that were under way and did not end.
    """
    broken = tuple(name for name in ledger.unit(task) if name in ledger.starts_s and name not in ledger.ends_s)
    for state in crew.values():
        if state.activity is Activity.WORKING and state.route and state.route[0] in (*broken, task):
            state.stop(now)
    for name in (*broken, task):
        ledger.give_up(name)
    if late := ledger.too_late_to_begin_with(ledger.unit(task)):
        ledger.expired |= dict.fromkeys(broken, late)
    return broken
