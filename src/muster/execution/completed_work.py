"""Work completed before a restart of the executor: tasks, and the robots' usage."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field

from muster.execution.changes import FAILED
from muster.execution.goods_ledger import GoodsLedger
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
    unloaded_s
        when robots unloaded at stations: (seconds, robot), in order of time.
    levels
        by robot what its battery last held, a share of its capacity, and its usage then.
    lying
        by task the goods that it had taken on and that lie elsewhere, by commodity; it is open again.
    """

    done: Mapping[str, CompletedTask] = field(default_factory=dict)
    cancelled: Mapping[str, float] = field(default_factory=dict)
    delays_s: Mapping[str, float] = field(default_factory=dict)
    barred: Mapping[str, str] = field(default_factory=dict)
    used: Mapping[str, float] = field(default_factory=dict)
    failed_s: Mapping[str, float] = field(default_factory=dict)
    closed: frozenset[str] | None = None
    unloaded_s: Sequence[tuple[float, str]] = ()
    levels: Mapping[str, tuple[float, float]] = field(default_factory=dict)
    lying: Mapping[str, Mapping[str, float]] = field(default_factory=dict)

    def recall(self, ledger: Ledger, crew: Mapping[str, RobotState], goods: GoodsLedger) -> None:
        """Write it into ledgers and a crew that are new."""
        self._recall_tasks(ledger, crew)
        self._recall_goods(ledger, goods)
        for robot, used in self.used.items():
            if robot in crew:
                crew[robot].recall(used)
                crew[robot].used_before = used
        for robot, (share, then) in self.levels.items():
            energy = crew[robot].energy if robot in crew else None
            if energy is not None:
                energy.recall(share, self.used.get(robot, then) - then)
        for robot, since_s in self.failed_s.items():
            if robot in crew:
                crew[robot].out, crew[robot].out_s = FAILED, since_s

    def _recall_tasks(self, ledger: Ledger, crew: Mapping[str, RobotState]) -> None:
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

    def _recall_goods(self, ledger: Ledger, goods: GoodsLedger) -> None:
        for task, amounts in self.lying.items():
            goods.lies(task, amounts)
        ends = [(deed.ends_s, robot, task) for task, deed in self.done.items() for robot in deed.team or (deed.robot,)]
        for at_s, robot, name in sorted([*ends, *((at_s, robot, "") for at_s, robot in self.unloaded_s)]):
            if name:
                goods.end(ledger.tasks[name], robot)
            else:
                goods.unload(robot, self._tied(ledger, at_s))

    def _tied(self, ledger: Ledger, at_s: float) -> set[str]:
        """The tasks whose goods a task delivers that was not done at a time."""
        left = (task for task in ledger.tasks.values() if task.id not in self.done or self.done[task.id].ends_s > at_s)
        return {task.delivers for task in left if task.delivers is not None}
