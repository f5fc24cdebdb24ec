"""Work completed before a restart of the executor: tasks, the robots' usage, and what is known of the mission."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field

from muster.execution.changes import FAILED
from muster.execution.goods_ledger import GoodsLedger
from muster.execution.orders import Orders
from muster.execution.record import ExecutionEvent
from muster.execution.robot_state import RobotState
from muster.execution.stations import Stations
from muster.execution.task_ledger import Ledger, MissedTask


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


@dataclass(frozen=True)
class GoodsMoved:
    """Goods that changed hands: a robot ended a task, unloaded at a station, or let all lie where it failed.

    Attributes
    ----------
    at_s : float
        Time of the mission's clock.
    robot : str
        Id of the robot.
    task : str
        Id of the task that ended; empty if none did.
    falls : bool
        Whether the robot failed, so that its goods lie.
    """

    at_s: float
    robot: str
    task: str = ""
    falls: bool = False


@dataclass(frozen=True, kw_only=True)
class CompletedWork:
    """What is known of the time before.

    Attributes
    ----------
    done, cancelled, delays_s : mapping
        By task: its end; when it was cancelled; by how much it was delayed.
    barred : mapping
        By task that must not be begun again, why.
    used : mapping
        By robot its usage, in the mission's unit.
    out : mapping
        By robot that takes no part, why (`FAILED`, `SILENT`, `STUCK`) and since when.
    closed : frozenset of str or None
        Ids of the doors that are closed; None: as before any event.
    failed_stations, cut_off_stations : frozenset of str
        Stations that serve nobody; stations to which a robot found no way.
    refusals : mapping
        By task and robot why the robot cannot do the task.
    blocked_by : mapping
        By task the broken robot that stands there.
    misfits : frozenset of (str, str)
        Robots and tasks that did not fit what the robots had on board.
    expired : mapping
        By task why it can never begin any more, in order of time.
    missed : sequence of MissedTask
        Tasks that were not begun in time.
    forgotten : mapping
        By task of a standing fleet that was lost and forgotten, why.
    goods : sequence of GoodsMoved
        How goods changed hands, in order of time.
    levels : mapping
        By robot what its battery last held, a share of its capacity, and its usage then.
    happened : sequence of ExecutionEvent
        Events by which orders are counted, in order of time.
    replanned : int
        How often the rest was planned again.
    begun_s : float
        Time at which the mission began.
    until_s : float or None
        Time up to which events of the mission file have happened; None: up to now.
    """

    done: Mapping[str, CompletedTask] = field(default_factory=dict)
    cancelled: Mapping[str, float] = field(default_factory=dict)
    delays_s: Mapping[str, float] = field(default_factory=dict)
    barred: Mapping[str, str] = field(default_factory=dict)
    used: Mapping[str, float] = field(default_factory=dict)
    out: Mapping[str, tuple[str, float]] = field(default_factory=dict)
    closed: frozenset[str] | None = None
    failed_stations: frozenset[str] = frozenset()
    cut_off_stations: frozenset[str] = frozenset()
    refusals: Mapping[str, Mapping[str, str]] = field(default_factory=dict)
    blocked_by: Mapping[str, str] = field(default_factory=dict)
    misfits: frozenset[tuple[str, str]] = frozenset()
    expired: Mapping[str, str] = field(default_factory=dict)
    missed: Sequence[MissedTask] = ()
    forgotten: Mapping[str, str] = field(default_factory=dict)
    goods: Sequence[GoodsMoved] = ()
    levels: Mapping[str, tuple[float, float]] = field(default_factory=dict)
    happened: Sequence[ExecutionEvent] = ()
    replanned: int = 0
    begun_s: float = 0.0
    until_s: float | None = None

    def happened_until_s(self, now: float) -> float:
        """Return the time up to which events of the mission file have happened."""
        return now if self.until_s is None else self.until_s

    def recall(
        self,
        ledger: Ledger,
        crew: Mapping[str, RobotState],
        goods: GoodsLedger,
        stations: Stations,
        orders: Orders,
    ) -> None:
        """Write it into ledgers and a crew that are new."""
        self._recall_tasks(ledger)
        self._recall_goods(ledger, goods)
        for state in crew.values():
            self.recall_robot(state, ledger)
        for task, why in self.barred.items():
            for robot in crew:
                ledger.refuse(task, robot, why)
        stations.failed.update(self.failed_stations)
        stations.cut_off.update(self.cut_off_stations)
        for event in self.happened:
            orders.take(event.time_s, event.kind, event.data)
        ledger.expired.update({name: why for name, why in self.forgotten.items() if name in ledger.tasks})
        ledger.retire([name for name in self.forgotten if name in ledger.tasks])

    def recall_robot(self, state: RobotState, ledger: Ledger) -> None:
        """Write what is known of one robot into its state, which is new; also of one that joins again."""
        robot = state.robot.id
        if robot in self.used:
            state.recall(self.used[robot])
            state.used_before = self.used[robot]
        if robot in self.levels and state.energy is not None:
            share, then = self.levels[robot]
            state.energy.recall(share, self.used.get(robot, then) - then)
        for task, deed in self.done.items():
            if robot in (members := ledger.members(task)):
                state.done.append(task)
                state.planned_before += deed.usage[0] / len(members)
        state.at_home = state.at_home and not state.done
        if robot in self.out:
            state.out, state.out_s = self.out[robot]
            said = state.port.telemetry()
            if state.out != FAILED and said is not None:
                state.out_at = said.position

    def _recall_tasks(self, ledger: Ledger) -> None:
        for task, deed in self.done.items():
            ledger.arrivals_s[task], ledger.starts_s[task] = deed.arrives_s, deed.starts_s
            ledger.arrival_usage[task], ledger.usage[task] = deed.arrival_usage, deed.usage
            ledger.end(task, deed.robot, deed.ends_s)
            ledger.teams[task] = deed.team or (deed.robot,)
        for task, at_s in self.cancelled.items():
            ledger.cancelled[task] = at_s
            ledger.expire(task, "cancelled")
        for task, why in self.expired.items():
            ledger.expire(task, why)
        for open_task in ledger.open:
            if late := ledger.too_late_to_begin_with(ledger.unit(open_task.id)):
                ledger.expired.setdefault(open_task.id, late)
        ledger.missed.extend(self.missed)
        ledger.delays_s.update(self.delays_s)
        for task, refusals in self.refusals.items():
            for robot, why in refusals.items():
                ledger.refuse(task, robot, why)
        ledger.blocked_by.update(self.blocked_by)

    def _recall_goods(self, ledger: Ledger, goods: GoodsLedger) -> None:
        for moved in self.goods:
            if moved.falls:
                goods.fall(moved.robot)
            elif moved.task:
                goods.end(ledger.tasks[moved.task], moved.robot)
            else:
                goods.unload(moved.robot, self._tied(ledger, moved.at_s))

    def _tied(self, ledger: Ledger, at_s: float) -> set[str]:
        """The tasks whose goods a task delivers that was not done at a time."""
        left = (task for task in ledger.tasks.values() if task.id not in self.done or self.done[task.id].ends_s > at_s)
        return {task.delivers for task in left if task.delivers is not None}
