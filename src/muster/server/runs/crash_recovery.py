"""Recovers a run of real robots from its log after a crash: what was done, what has changed, and what is left.

A task that may be started at most once (`across_partition`), and was started but did not end in the log, is not started
again.
"""

from __future__ import annotations

from collections.abc import Callable, Collection, Mapping, Sequence
from dataclasses import dataclass, field, replace
from typing import Any

from muster.execution import CompletedTask, CompletedWork
from muster.execution.changes import FAILED, OUT, lying
from muster.execution.completed_work import GoodsMoved
from muster.execution.punctuality import MISSED
from muster.execution.record import ExecutionEvent
from muster.execution.task_ledger import MissedTask
from muster.mission.doors import Doors
from muster.mission.model import Event, Mission
from muster.mission.plan import Plan, Route
from muster.report.record.mission_state import KEPT_OVER, UNDER_WAY, MissionState

BARRED = "it was begun before a crash, and may be begun at most once; its end is not known"
_OF_THE_RUN = ("plan", "report", "command", "resumed")
"""Entries that are no events of the mission."""
_OF_ORDERS = ("new_task", "replanned", "event_refused", "ends", "cancel_task", "lost")
"""Events by which orders are counted."""


@dataclass(frozen=True)
class Recovered:
    """The mission with its changes, the plan in force, and what was done."""

    mission: Mission
    plan: Plan
    past: CompletedWork
    again: tuple[str, ...] = ()


def recovered_from(
    mission: Mission, plan: Plan, log: Sequence[Mapping[str, Any]], ports: Collection[str] = ()
) -> Recovered:
    """Recover the state from a log.

    Parameters
    ----------
    mission : Mission
        The mission at the beginning.
    plan : Plan
        The plan at the beginning.
    log : sequence of mappings
        The entries of the log, with `time_s`, `kind` and `data`.
    ports : collection of str
        Robots that can be reached. A robot that joined during the run and is not among them has to join again.

    Returns
    -------
    Recovered
        The mission with its changes, the plan in force, and what was done.
    """
    fold = _Fold(MissionState(mission), Doors.of(mission))
    for entry in log:
        fold.take(float(entry["time_s"]), entry["kind"], entry["data"])
    barred = dict.fromkeys(fold.begun_once, BARRED)
    own = {robot.id for robot in mission.robots}
    robots = tuple(robot for name, robot in fold.state.robots.items() if name in own or name in ports)
    names = tuple(robot.id for robot in robots)
    tasks = tuple(replace(task, only_robots=names) if task.id in barred else task for task in fold.state.tasks.values())
    current = plan if fold.routes is None else _of_those(plan, fold.routes, names)
    again = [task for task, state in fold.state.states.items() if state == UNDER_WAY and task not in barred]
    left = tuple(event for event in mission.events if event.at_s > fold.until_s and fold.fits(event, names))
    robots = tuple(replace(robot, end_position=robot.place_at_end(mission.rules)) for robot in robots)
    found = replace(mission.at_once(robots=robots, tasks=tasks), events=left)
    return _with_locks_of_barred(Recovered(found, current, fold.past(barred), tuple(again)))


@dataclass
class _Fold:
    """The state after the entries of a log that were taken so far; fields are as in `CompletedWork`."""

    state: MissionState
    doors: Doors
    routes: dict[str, list[str]] | None = None
    arrives: dict[str, float] = field(default_factory=dict)
    starts: dict[str, float] = field(default_factory=dict)
    done: dict[str, CompletedTask] = field(default_factory=dict)
    cancelled: dict[str, float] = field(default_factory=dict)
    delays: dict[str, float] = field(default_factory=dict)
    used: dict[str, float] = field(default_factory=dict)
    levels: dict[str, tuple[float, float]] = field(default_factory=dict)
    out: dict[str, tuple[str, float]] = field(default_factory=dict)
    failed_stations: set[str] = field(default_factory=set)
    cut_off_stations: set[str] = field(default_factory=set)
    refusals: dict[str, dict[str, str]] = field(default_factory=dict)
    blocked_by: dict[str, str] = field(default_factory=dict)
    misfits: set[tuple[str, str]] = field(default_factory=set)
    expired: dict[str, str] = field(default_factory=dict)
    missed: list[MissedTask] = field(default_factory=list)
    forgotten: dict[str, str] = field(default_factory=dict)
    goods: list[GoodsMoved] = field(default_factory=list)
    happened: list[ExecutionEvent] = field(default_factory=list)
    replanned: int = 0
    begun_s: float | None = None
    until_s: float = 0.0

    @property
    def begun_once(self) -> set[str]:
        """Tasks that may be begun at most once, were begun, and of which no end is known."""
        once = {name for name, task in self.state.tasks.items() if task.across_partition == "at-most-once"}
        return (once & self.starts.keys()) - self.done.keys() - self.cancelled.keys()

    def fits(self, event: Event, robots: Collection[str]) -> bool:
        """Return whether an event to come fits: ids that it brings are free, and its robot is there or joins later."""
        joins, task = event.robot_joins, event.new_task
        robot = event.robot_fails or event.robot_silent or event.robot_returns
        is_gone = robot in self.state.robots and robot not in robots
        is_free = (joins is None or joins.id not in self.state.robots) and (
            task is None or task.id not in self.state.tasks
        )
        return is_free and not is_gone

    def take(self, now: float, kind: str, data: Mapping[str, Any]) -> None:
        """Apply an entry of the log."""
        if kind not in _OF_THE_RUN:
            self.state.take(kind, data)
        if kind != "command":
            self.begun_s = now if self.begun_s is None else self.begun_s
            self.until_s = max(self.until_s, now)
        if "used" in data:
            self.used[data["robot"]] = data["used"]
            if "charge" in data:
                self.levels[data["robot"]] = (data["charge"], data["used"])
        if kind in _OF_ORDERS:
            self.happened.append(ExecutionEvent(now, kind, data))
        if kind in _TAKE:
            _TAKE[kind](self, now, data)
        elif kind in OUT:
            self._take_out(now, kind, data["robot"])
        elif kind in MISSED.values():
            self._take_missed(now, data)

    def past(self, barred: Mapping[str, str]) -> CompletedWork:
        """Return what is known of the time before."""
        return CompletedWork(
            done=self.done,
            cancelled=self.cancelled,
            delays_s=self.delays,
            barred=barred,
            used=self.used,
            out=self.out,
            closed=self.doors.closed if self.doors.known else None,
            failed_stations=frozenset(self.failed_stations),
            cut_off_stations=frozenset(self.cut_off_stations),
            refusals=self.refusals,
            blocked_by=self.blocked_by,
            misfits=frozenset(self.misfits),
            expired=self.expired,
            missed=self.missed,
            forgotten=self.forgotten,
            goods=self.goods,
            levels=self.levels,
            happened=self.happened,
            replanned=self.replanned,
            begun_s=self.begun_s or 0.0,
            until_s=self.until_s,
        )

    def take_plan(self, _: float, data: Mapping[str, Any]) -> None:
        if "plan" in data:
            self.routes = {route["robot"]: route["tasks"] for route in data["plan"]["routes"]}
        else:
            self.routes = (self.routes or {}) | dict(data["routes"])

    def take_replanned(self, _: float, data: Mapping[str, Any]) -> None:
        self.replanned += 1

    def take_arrival(self, now: float, data: Mapping[str, Any]) -> None:
        self.arrives[data["task"]] = now

    def take_begin(self, now: float, data: Mapping[str, Any]) -> None:
        self.starts[data["task"]] = now

    def take_end(self, now: float, data: Mapping[str, Any]) -> None:
        task, robot, team = data["task"], data["robot"], tuple(data.get("team", ()))
        self.done[task] = CompletedTask(
            robot=robot,
            arrives_s=self.arrives.get(task, now),
            starts_s=self.starts.get(task, now),
            ends_s=now,
            arrival_usage=data["arrival_usage"],
            usage=(data["usage"][0], data["usage"][1]),
            team=team,
        )
        self.goods += [GoodsMoved(now, member, task) for member in team or (robot,)]

    def take_service(self, now: float, data: Mapping[str, Any]) -> None:
        if data.get("unloaded"):
            self.goods.append(GoodsMoved(now, data["robot"]))

    def take_lying_load(self, _: float, data: Mapping[str, Any]) -> None:
        task = data["task"]
        there = lying(self.state.tasks[task], tuple(data["position"]), data["load"])
        self.state.tasks[task] = there
        for known in (self.done, self.delays, self.refusals):
            known.pop(task, None)

    def take_cancelled(self, now: float, data: Mapping[str, Any]) -> None:
        task = data["task"]
        self.cancelled[task] = now
        for other in self.state.tasks.values():
            if other.delivers == task and other.id not in self.done and other.id not in self.cancelled:
                self.expired.setdefault(other.id, f"load: {task}, which takes on what it delivers, is cancelled")

    def take_moved(self, _: float, data: Mapping[str, Any]) -> None:
        self.refusals.pop(data["task"], None)

    def take_delay(self, _: float, data: Mapping[str, Any]) -> None:
        self.delays[data["task"]] = self.delays.get(data["task"], 0.0) + data["by_s"]

    def take_return(self, _: float, data: Mapping[str, Any]) -> None:
        self.out.pop(data["robot"], None)
        self._open_ways()

    def take_closed_door(self, _: float, data: Mapping[str, Any]) -> None:
        self.doors.take(Event(at_s=0, door_closes=data["door"]))

    def take_open_door(self, _: float, data: Mapping[str, Any]) -> None:
        self.doors.take(Event(at_s=0, door_opens=data["door"]))
        self._open_ways()

    def take_failed_station(self, _: float, data: Mapping[str, Any]) -> None:
        self.failed_stations.add(data["station"])

    def take_returned_station(self, _: float, data: Mapping[str, Any]) -> None:
        self.failed_stations.discard(data["station"])

    def take_unreachable_station(self, _: float, data: Mapping[str, Any]) -> None:
        self.cut_off_stations.add(data["station"])

    def take_refusal(self, _: float, data: Mapping[str, Any]) -> None:
        task, robot = data["task"], data["robot"]
        if data.get("for_now"):
            self.misfits.add((robot, task))
            return
        others = data.get("others", {})
        for refused, robots in (*others.items(), (task, [robot])):
            for one in robots:
                self.refusals.setdefault(refused, {})[one] = data["reason"]
        if "blocked_by" in data:
            self.blocked_by |= dict.fromkeys((task, *others), data["blocked_by"])

    def take_standstill(self, _: float, data: Mapping[str, Any]) -> None:
        if "given_up" in data:
            self.expired.setdefault(data["task"], data["given_up"])

    def take_lost(self, _: float, data: Mapping[str, Any]) -> None:
        self.forgotten[data["task"]] = data["reason"]

    def take_end_of_mission(self, _: float, data: Mapping[str, Any]) -> None:
        self.forgotten.clear()  # tasks lost at the end are listed, and may be done if something brings work

    def _take_out(self, now: float, why: str, robot: str) -> None:
        self.out[robot] = (why, now)
        if why == FAILED:
            self.goods.append(GoodsMoved(now, robot, falls=True))

    def _take_missed(self, now: float, data: Mapping[str, Any]) -> None:
        self.missed.append(MissedTask(data["task"], now, data["reason"], data["next_s"]))
        if data["next_s"] is None:
            self.expired.setdefault(data["task"], data["reason"])

    def _open_ways(self) -> None:
        """Robots may try again what they had no way to."""
        self.blocked_by.clear()
        self.cut_off_stations.clear()
        for task, refusals in self.refusals.items():
            self.refusals[task] = {robot: why for robot, why in refusals.items() if not why.startswith("unreachable")}


_TAKE: Mapping[str, Callable[[_Fold, float, Mapping[str, Any]], None]] = {
    "plan": _Fold.take_plan,
    "replanned": _Fold.take_replanned,
    "arrives": _Fold.take_arrival,
    "starts": _Fold.take_begin,
    "ends": _Fold.take_end,
    "service_ends": _Fold.take_service,
    "load_lies": _Fold.take_lying_load,
    "cancel_task": _Fold.take_cancelled,
    "move_task": _Fold.take_moved,
    "delay_task": _Fold.take_delay,
    "robot_returns": _Fold.take_return,
    "door_closes": _Fold.take_closed_door,
    "door_opens": _Fold.take_open_door,
    "station_fails": _Fold.take_failed_station,
    "station_returns": _Fold.take_returned_station,
    "station_unreachable": _Fold.take_unreachable_station,
    "task_refused": _Fold.take_refusal,
    "standstill": _Fold.take_standstill,
    "lost": _Fold.take_lost,
    "mission_ended": _Fold.take_end_of_mission,
}
"""What changes what is known, by the kind of the entry."""


def _with_locks_of_barred(found: Recovered) -> Recovered:
    """Keep the locks of barred tasks if locks are ignored: all other tasks lose theirs, and the rule holds."""
    if "lock" not in found.plan.ignored:
        return found
    tasks = tuple(
        task if task.id in found.past.barred else replace(task, only_robots=None) for task in found.mission.tasks
    )
    others = tuple(rule for rule in found.plan.ignored if rule != "lock")
    return replace(found, mission=replace(found.mission, tasks=tasks), plan=replace(found.plan, ignored=others))


def _of_those(plan: Plan, routes: Mapping[str, Sequence[str]], robots: Sequence[str]) -> Plan:
    """The plan without routes of robots that joined during the run and cannot be reached: they join again."""
    found = tuple(Route(robot, tuple(routes[robot])) for robot in robots if robot in routes)
    return Plan(
        mission=plan.mission,
        allocator=plan.allocator,
        ignored=plan.ignored,
        objective=plan.objective,
        objective_value=plan.objective_value,
        routes=found,
        unassigned=(),
    )


class History:
    """What has happened in a run so far, entry by entry.

    Parameters
    ----------
    mission, plan
        at the beginning.
    checkpoint
        of a history that this one continues.
    """

    def __init__(self, mission: Mission, plan: Plan, checkpoint: Mapping[str, Any] | None = None) -> None:
        self._mission, self.plan = mission, plan
        self._entries: list[Mapping[str, Any]] = []
        self.state = MissionState(mission, KEPT_OVER)
        self.now_s, self.zero_s = 0.0, None
        for entry in () if checkpoint is None else checkpoint["entries"]:
            self.take(**entry)

    def take(self, time_s: float, kind: str, data: Mapping[str, Any]) -> None:
        """Apply an entry of the log."""
        self._entries.append({"time_s": time_s, "kind": kind, "data": data})
        self.now_s = max(self.now_s, time_s)
        self.zero_s = data.get("zero_s", self.zero_s)
        if kind not in _OF_THE_RUN:
            self.state.take(kind, data)

    def checkpoint(self) -> dict[str, Any]:
        """Return the state as plain data."""
        return {"entries": self._entries}

    def recovered(self, ports: Collection[str]) -> Recovered:
        """Return what a run that continues needs; see `recovered_from`."""
        return recovered_from(self._mission, self.plan, self._entries, ports)
