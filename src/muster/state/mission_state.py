"""The state of a mission under way: the fold of its events. `MissionState.apply` is the only code that changes it."""

from __future__ import annotations

import math
from collections.abc import Collection, Iterable, Mapping
from typing import Any, Protocol, Self

from muster.mission.doors import Doors
from muster.mission.errors import MissionError, ParameterError
from muster.mission.model import Mission, Robot, Task
from muster.mission.records import Record
from muster.mission.value_types import Fault
from muster.state.explored_map import ExploredMap
from muster.state.goods_ledger import GoodsLedger
from muster.state.orders import Orders
from muster.state.robots import OUT, KnownRobot
from muster.state.task_ledger import Ledger
from muster.state.traffic_account import TrafficAccount

AT_MOST_ONCE = "at-most-once"
BARRED = "it was begun before a crash, and may be begun at most once; its end is not known"
OPEN, UNDER_WAY, DONE, LOST, CANCELLED = "open", "under way", "done", "lost", "cancelled"


class Change(Protocol):
    """An event, as far as the state of a mission has to know it; see `muster.state.event`."""

    @property
    def time_s(self) -> float:
        """When it happened, seconds of the mission's clock."""
        ...

    def change(self, state: MissionState) -> None:
        """Change what is known of the mission."""
        ...


class MissionState:
    """All that is known of a mission under way.

    Parameters
    ----------
    mission
        the mission at the beginning.
    ignored
        rules that do not hold.
    own
        the robots that take part here, where others have states of their own; None: all of the mission.
    forgets
        whether tasks that a fleet on duty forgets are forgotten here; else all stay, as in a record that is read.

    Attributes
    ----------
    now_s, begun_s, ended_s, zero_s
        the time of the last event; of the first; when the mission was over; when its clock was 0, seconds since 1970.
    robots : dict of str to KnownRobot
        by id, in the order in which they came.
    ledger : Ledger
        of the tasks.
    goods, orders, traffic, doors
        what robots have on board; counts of orders; who held up whom; which doors are closed.
    failed_stations, cut_off_stations : set of str
        stations that serve nobody; stations to which a robot found no way.
    misfits : set of (str, str)
        robots and tasks that did not fit what the robots had on board.
    routes, left_out : dict
        by robot the tasks ahead of it by the plan in force; by task why no robot is to do it.
    replanned : int
        how often the rest was planned again.
    done_twice : dict of str to tuple of str
        by task that robots which could not hear each other have begun, these robots.
    explored : ExploredMap, optional
        the map that robots have built, where they had none.
    """

    def __init__(
        self,
        mission: Mission,
        ignored: Collection[str] = (),
        *,
        own: Collection[str] | None = None,
        forgets: bool = True,
    ) -> None:
        self.mission = mission
        self.now_s = -math.inf
        self.begun_s: float | None = None
        self.ended_s: float | None = None
        self.zero_s: float | None = None
        self.ledger = Ledger.of(mission, ignored)
        self.goods, self.orders, self.traffic = GoodsLedger(), Orders(), TrafficAccount()
        self.robots: dict[str, KnownRobot] = {}
        for robot in mission.robots:
            if own is None or robot.id in own:
                self.join(robot)
        self.doors = Doors.of(mission)
        self.failed_stations: set[str] = set()
        self.cut_off_stations: set[str] = set()
        self.misfits: set[tuple[str, str]] = set()
        self.routes: dict[str, tuple[str, ...]] = {}
        self.left_out: dict[str, str] = {}
        self.replanned = 0
        self.done_twice: dict[str, tuple[str, ...]] = {}
        self.explored: ExploredMap | None = None
        self._forgets = forgets

    @classmethod
    def after(cls, mission: Mission, events: Iterable[Change]) -> Self:
        """The state after events, in which nothing is forgotten."""
        state = cls(mission, forgets=False)
        for event in events:
            state.apply(event)
        return state

    def apply(self, event: Change) -> tuple[str, ...]:
        """Change what is known as an event says; return the tasks that it has brought on, or moved.

        Raises
        ------
        ParameterError
            if a new robot or task is none.
        """
        self.now_s = max(self.now_s, event.time_s)
        if self.begun_s is None:
            self.begun_s = event.time_s
        self.ledger.touched.clear()
        event.change(self)
        return tuple(self.ledger.touched)

    @property
    def tasks(self) -> Mapping[str, Task]:
        """The tasks by id, in the order in which they came."""
        return self.ledger.tasks

    def stage(self, task: str) -> str:
        """How far a task is: open, under way, done, lost or cancelled."""
        if task in self.ledger.ends_s:
            return DONE
        if task in self.ledger.cancelled:
            return CANCELLED
        if task in self.ledger.told_lost:
            return LOST
        return UNDER_WAY if task in self.ledger.starts_s else OPEN

    @property
    def stages(self) -> dict[str, str]:
        """How far each task is."""
        return {task: self.stage(task) for task in self.tasks}

    @property
    def gone(self) -> dict[str, str]:
        """The robots that take no part any more: why, and since when."""
        return {
            name: f"{OUT[robot.out]} at {round(robot.out_s, 1):g} s" for name, robot in self.robots.items() if robot.out
        }

    # What follows is for events alone.

    def note_used(self, robot: str, used: float | None, share: float | None = None) -> None:
        """Note what a robot tells of its usage and its energy."""
        if robot in self.robots:
            self.robots[robot].note_used(used, share)

    def join(self, robot: Robot) -> None:
        """A robot takes part; what one did that joins again is known."""
        if robot.id in self.robots:
            self.robots[robot.id].robot = robot
        else:
            self.robots[robot.id] = KnownRobot(robot)
            self.goods.join(self.ledger.as_it_holds(robot))

    def take_out(self, robot: str, why: str, now: float) -> None:
        """A robot takes no part any more, and work on which it was is broken off."""
        self.break_off_work(robot)
        if robot in self.robots:
            self.robots[robot].out, self.robots[robot].out_s = why, now
            self.routes.pop(robot, None)

    def break_off_work(self, robot: str) -> None:
        """Work on which a robot was is broken off."""
        for task in [task for task in self.ledger.under_way if robot in self.ledger.at_work(task)]:
            self.ledger.break_off(task)

    def begin(self, task: str, robots: tuple[str, ...], now: float) -> None:
        """Robots begin a task, unless others are at it, or have done it."""
        for name in robots:
            if name in self.robots:
                self.robots[name].began_s[task] = now
        if self.ledger.is_open(task) and task in self.tasks and not self.ledger.at_work(task):
            self._note_begun(task, robots, now)

    def _note_begun(self, task: str, robots: tuple[str, ...], now: float) -> None:
        """Note when the robots that do a task came to it and began, as far as they have told."""
        known = [self.robots[name] for name in robots if name in self.robots]
        begun_s = max((one.began_s[task] for one in known if task in one.began_s), default=now)
        came = [one.came_to[task] for one in known if task in one.came_to]
        self.ledger.begin(task, robots, begun_s)
        self.ledger.arrive(task, came or [(begun_s, 0.0)], begun_s)

    def end(self, task: str, shares: Mapping[str, float], usage: tuple[float, float], now: float) -> None:
        """Robots have done a task: by robot the planned usage of its part; `usage` is planned and measured, of all.

        It counts for those that end it first. Robots that had not heard that it was cancelled have done it, too.
        """
        if task not in self.tasks or task in self.ledger.ends_s:
            return
        robots = tuple(shares)
        if self.ledger.at_work(task) != robots:
            self._note_begun(task, robots, now)
        self.ledger.end(task, robots, now)
        self.ledger.usage[task] = usage
        self.orders.close(task, "done", now)
        for name, planned in shares.items():
            if name in self.robots:
                self.robots[name].end(task, planned)
                self.goods.end(self.tasks[task], name)
                self._lies_ahead(name, tuple(one for one in self.routes.get(name, ()) if one != task))

    def go_on(self) -> None:
        """A mission that was over goes on: tasks that were lost at its end are open again."""
        if self.ended_s is not None:
            self.ended_s = None
            self.ledger.told_lost.clear()

    def open_ways(self) -> None:
        """What stood in the way may do so no more: robots try what they had no way to."""
        self.ledger.try_again()
        self.cut_off_stations.clear()

    def adopt(self, routes: Mapping[str, tuple[str, ...]], left_out: Mapping[str, str | None]) -> None:
        """Take over what a plan changes."""
        for robot, route in routes.items():
            self._lies_ahead(robot, route)
        for task, why in left_out.items():
            if why is None:
                self.left_out.pop(task, None)
            else:
                self.left_out[task] = why

    def _lies_ahead(self, robot: str, route: tuple[str, ...]) -> None:
        if route:
            self.routes[robot] = route
        else:
            self.routes.pop(robot, None)

    def forget(self, tasks: Collection[str]) -> None:
        """Forget tasks that are long over, but for sums."""
        if not self._forgets:
            return
        gone = [name for name in tasks if name in self.tasks]
        self.ledger.retire(gone)
        for robot in self.robots.values():
            robot.forget(gone)

    def resume(self) -> None:
        """The run goes on after a stop: what robots were at is begun again, unless it may be begun but once."""
        for robot in self.robots.values():
            robot.came_to.clear()
        for task in self.ledger.under_way:
            if self.tasks[task].across_partition == AT_MOST_ONCE:
                self.ledger.expire(task, BARRED)
            self.ledger.break_off(task)

    def task_of(self, data: Mapping[str, Any] | str) -> Task:
        """A task from plain data, or by the id of one that there is or that the mission's own events bring."""
        made: Task = self._made(Task, self._there(data, "new_task", self.tasks), "new_task")
        return made

    def robot_of(self, data: Mapping[str, Any] | str) -> Robot:
        """A robot, likewise."""
        there = {name: known.robot for name, known in self.robots.items()} if isinstance(data, str) else {}
        made: Robot = self._made(Robot, self._there(data, "robot_joins", there), "robot_joins")
        return made

    def _there(self, data: Any, kind: str, there: Mapping[str, Any]) -> Any:
        """What an id stands for: one that the mission's own events bring, or that there is; plain data as they are."""
        if not isinstance(data, str):
            return data
        brought = (getattr(event, kind) for event in self.mission.events)
        return {**there, **{one.id: one for one in brought if one is not None}}.get(data, data)

    def _made(self, model: Any, data: Any, kind: str) -> Any:
        faults: list[Fault] = []
        try:
            made = Record(model, f"a {model.__name__.lower()}").read(data, (), faults)
        except MissionError as error:
            raise ParameterError(f"event {kind}: {error}") from None
        if faults:
            raise ParameterError(f"event {kind}: {faults[0].value}; expected {faults[0].expected}")
        return made
