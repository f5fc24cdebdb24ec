"""Work completed before a restart of the executor: tasks, and the robots' usage."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field

from muster.execution.changes import FAILED
from muster.execution.robot_state import RobotState
from muster.execution.task_ledger import Ledger


@dataclass(frozen=True, kw_only=True)
class CompletedTask:
    """A task that was done: by whom, when (mission's clock), and usage by the plan and as measured.

    `team` names the robots of a task done by several, `robot` first.
    """

    robot: str
    arrives_s: float
    starts_s: float
    ends_s: float
    arrival_usage: float
    usage: tuple[float, float]
    team: tuple[str, ...] = ()


@dataclass(frozen=True, kw_only=True)
class CompletedWork:
    """What is known of the time before.

    Parameters
    ----------
    done, cancelled, delays_s
        tasks that were done; when others were cancelled; by how much others were delayed.
    barred
        tasks that must not be begun again, and why.
    used, failed_s
        by robot what it had used, in the mission's unit; since when it takes no part.
    closed
        ids of the doors that are closed; None: as before any event.
    """

    done: Mapping[str, CompletedTask] = field(default_factory=dict)
    cancelled: Mapping[str, float] = field(default_factory=dict)
    delays_s: Mapping[str, float] = field(default_factory=dict)
    barred: Mapping[str, str] = field(default_factory=dict)
    used: Mapping[str, float] = field(default_factory=dict)
    failed_s: Mapping[str, float] = field(default_factory=dict)
    closed: frozenset[str] | None = None

    def recall(self, ledger: Ledger, crew: Mapping[str, RobotState]) -> None:
        """Write it into a ledger and a crew that are new."""
        for task, deed in self.done.items():
            ledger.arrivals_s[task], ledger.starts_s[task] = deed.arrives_s, deed.starts_s
            ledger.arrival_usage[task], ledger.usage[task] = deed.arrival_usage, deed.usage
            ledger.end(task, deed.robot, deed.ends_s)
            ledger.teams[task] = deed.team or (deed.robot,)
            for robot in ledger.teams[task]:
                if robot in crew:
                    crew[robot].done.append(task)
                    crew[robot].at_home = False
        ledger.cancelled.update(self.cancelled)
        for open_task in ledger.open:
            if late := ledger.too_late_to_begin_with(ledger.unit(open_task.id)):
                ledger.expired[open_task.id] = late
        ledger.delays_s.update(self.delays_s)
        for task, why in self.barred.items():
            for robot in crew:
                ledger.refuse(task, robot, why)
        for robot, used in self.used.items():
            if robot in crew:
                crew[robot].recall(used)
                crew[robot].used_before = used
        for robot, since_s in self.failed_s.items():
            if robot in crew:
                crew[robot].out, crew[robot].out_s = FAILED, since_s
