"""Work that several robots do at once is broken off for all of them."""

from __future__ import annotations

from collections.abc import Mapping

from muster.execution.robot_state import Activity, RobotState
from muster.state.task_ledger import Ledger


def stop_work(crew: Mapping[str, RobotState], ledger: Ledger, task: str, now: float) -> tuple[str, ...]:
    """Stop all robots at work on a task, and on those that began with it; return the tasks that are under way."""
    under_way = tuple(name for name in ledger.unit(task) if ledger.at_work(name))
    for state in crew.values():
        if state.activity is Activity.WORKING and state.route and state.route[0] in (*under_way, task):
            state.stop(now)
    return under_way
