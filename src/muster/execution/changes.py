"""Changes while a mission is carried out, applied to the task ledger and the robots."""

from __future__ import annotations

from collections.abc import Callable, Collection, Iterator, Mapping
from dataclasses import dataclass, field, replace
from typing import Any

from muster.execution.goods_beside import fetching_place
from muster.execution.goods_ledger import GoodsLedger, as_amount
from muster.execution.robot_energy import RobotEnergy
from muster.execution.robot_state import Activity, RobotState
from muster.execution.stations import AT_STATION, Stations
from muster.execution.task_ledger import Ledger, moved, robot_as_it_holds
from muster.execution.task_motion import Way, place, straight
from muster.execution.team_work import break_off
from muster.execution.travel import Travel
from muster.mission.doors import Doors
from muster.mission.errors import MissionError, ParameterError
from muster.mission.model import Event, Mission, Point, Robot, Task
from muster.mission.value_types import shown
from muster.mission.yaml_writer import plain
from muster.motion.leg_times import LegTimes
from muster.motion.port import RobotPort

FAILED, SILENT, STUCK = "robot_fails", "robot_silent", "robot_stuck"
"""Why a robot is out."""
OUT = {FAILED: "failed", SILENT: "fell silent", STUCK: "did not get on"}
"""The same in words."""


@dataclass(frozen=True)
class Change:
    """A change that requires a new plan.

    Parameters
    ----------
    kind
        what: as in a mission file's `events`, or what else it is.
    data
        of which robot or task, as in a mission file, and plain.
    """

    kind: str
    data: Mapping[str, Any]


@dataclass
class Changes:
    """Applies events to the task ledger and the robots.

    Parameters
    ----------
    mission
        the question, for its rules.
    ports
        how robots are reached; a robot that joins has its port here by then.
    stations, goods
        of the executor.
    way
        the ways that robots go.
    on_doors
        receives the ids of the doors that are closed, when one closes or opens.
    """

    mission: Mission
    ledger: Ledger
    crew: dict[str, RobotState]
    ports: Mapping[str, RobotPort]
    travel: Travel
    stations: Stations
    goods: GoodsLedger
    way: Way = straight
    on_doors: Callable[[Collection[str]], None] = lambda closed: None
    doors: Doors = field(init=False)

    def __post_init__(self) -> None:
        self.doors = Doors.of(self.mission)

    def apply(self, event: Event, now: float, reason: str = "") -> Iterator[Change]:
        """Let an event happen; yields what asks for a new plan.

        That a robot falls silent is for the monitor to notice: nothing is done here. `reason` is why a robot fails.

        Raises
        ------
        ParameterError
            if the event names a robot, task or door that there is not, or one anew that there is, or a robot without
            port.
        """
        if event.robot_fails is not None:
            yield from self.exclude(self._robot_state(event.robot_fails), FAILED, now, reason)
        elif event.robot_returns is not None:
            yield from self.readmit(self._robot_state(event.robot_returns), now)
        elif event.robot_joins is not None:
            yield self._join(event.robot_joins, now)
        elif event.new_task is not None:
            yield self._add(event.new_task)
        elif event.cancel_task is not None:
            yield from self._cancel(self._task(event.cancel_task), now)
        elif event.move_task is not None:
            yield from self._move(self._task(event.move_task.task), event.move_task.position, now)
        elif event.delay_task is not None:
            yield from self._delay(self._task(event.delay_task.task), event.delay_task.by_s)
        elif event.door is not None:
            yield from self._turn_door(event, event.door, now)
        elif event.station_fails is not None:
            yield from self._fail_station(self._station(event.station_fails), now)
        elif event.station_returns is not None:
            yield from self._return_station(self._station(event.station_returns))

    def _fail_station(self, station: str, now: float) -> Iterator[Change]:
        """Robots that are served there, wait there, or are on the way to it stop; all are planned again."""
        if station in self.stations.failed:
            return
        self.stations.failed.add(station)
        for state in self.stations.at(station):
            state.note_energy()
            state.stop(now)
        for state in self.crew.values():
            state.calls = [call for call in state.calls if call.station != station]
        yield Change("station_fails", {"station": station})

    def _return_station(self, station: str) -> Iterator[Change]:
        if station in self.stations.failed:
            self.stations.failed.discard(station)
            yield Change("station_returns", {"station": station})

    def exclude(self, state: RobotState, why: str, now: float, detail: str = "") -> Iterator[Change]:
        """Exclude a robot: its tasks are free, the current one too."""
        if state.out == FAILED or (state.out and why != FAILED):
            return
        state.out, state.out_s, state.out_at = why, now, state.position
        broken: tuple[str, ...] = ()
        if state.activity is Activity.WORKING:
            broken = break_off(self.crew, self.ledger, state.route[0], now)
        elif state.route and state.route[0] not in self.ledger.starts_s:
            self.ledger.give_up(state.route[0])
        state.stop(now)
        state.calls = []
        yield Change(why, {"robot": state.robot.id} | ({"reason": detail} if detail else {}))
        if why == FAILED:
            yield from self._let_lie(state)
        for task in broken:
            if len(self.ledger.unit(task)) > 1 or self.ledger.tasks[task].is_for_team:
                yield Change("work_broken_off", {"task": task, "robot": state.robot.id})

    def _let_lie(self, state: RobotState) -> Iterator[Change]:
        """What a robot that fails has on board lies where it is: tasks that took it on are done again beside it."""
        for item in self.goods.fall(state.robot.id):
            if item.task is None or item.task not in self.ledger.ends_s:
                continue
            beside = fetching_place(state, self.ledger.tasks[item.task], self.crew.values(), self.way)
            at = beside[: self.mission.dimensions]
            self.ledger.reopen(lying(self.ledger.tasks[item.task], at, item.amounts))
            state.done = [name for name in state.done if name != item.task]
            state.stops = [name for name in state.stops if name != item.task]
            data = {"task": item.task, "robot": state.robot.id, "position": list(at), "load": dict(item.amounts)}
            yield Change("load_lies", data)

    def readmit(self, state: RobotState, now: float, reason: str = "") -> Iterator[Change]:
        """Let a robot take part again, from where it is."""
        if state.out:
            state.out, state.last_heard_s, state.sent_again = "", now, 0
            self._open_ways()
            state.stop(now)
            yield Change("robot_returns", {"robot": state.robot.id} | ({"reason": reason} if reason else {}))

    def require_newcomer(self, robot: Robot) -> None:
        """Raise ParameterError where a robot cannot join: its id is taken, or it does not fit the mission."""
        if robot.id in self.crew:
            raise ParameterError(f"robot_joins: {shown(robot.id)}; expected an id that no robot has")
        if not self.travel.knows(robot.id):
            raise ParameterError(f"robot_joins: {shown(robot.id)}; expected a robot with rows in the travel tables")
        self._require_fit("robot_joins", robots=(robot,))

    def _join(self, robot: Robot, now: float) -> Change:
        self.require_newcomer(robot)
        self.crew[robot.id] = new_robot_state(self.mission, robot, self.ports, now, self.ledger.ignored)
        self.goods.join(self.crew[robot.id].robot)
        return Change("robot_joins", {"robot": plain(robot)})

    def _add(self, task: Task) -> Change:
        if task.id in self.ledger.tasks:
            raise ParameterError(f"new_task: {shown(task.id)}; expected an id that no task has")
        self._require_fit("new_task", tasks=(task,))
        self.ledger.add(task)
        return Change("new_task", {"task": plain(task)})

    def _require_fit(self, what: str, *, robots: tuple[Robot, ...] = (), tasks: tuple[Task, ...] = ()) -> None:
        """A mission with these robots and tasks, and those that there are, must be one."""
        there = {robot.id: robot for robot in (*self.mission.robots, *(state.robot for state in self.crew.values()))}
        try:
            self.mission.at_once(robots=(*there.values(), *robots), tasks=(*self.ledger.tasks.values(), *tasks))
        except MissionError as error:
            found = error.findings[0]
            name = [*(robot.id for robot in robots), *(task.id for task in tasks)][0]
            raise ParameterError(f"{what}: {name}: {found.value}; expected {found.expected}") from None

    def _cancel(self, task: str, now: float) -> Iterator[Change]:
        if task in self.ledger.ends_s or task in self.ledger.cancelled:
            return
        self._leave(task, now)
        self.ledger.withdraw(task, now)
        for state in self.crew.values():
            state.leave_out({task})
        self.ledger.expire(task, "cancelled")
        self._cancel_delivery_of(task)
        yield Change("cancel_task", {"task": task})

    def _cancel_delivery_of(self, task: str) -> None:
        """What is not taken on board cannot be delivered."""
        for other in self.ledger.open:
            if other.delivers == task and self.goods.carrier(task) is None:
                self.ledger.expire(other.id, f"load: {task}, which takes on what it delivers, is cancelled")

    def _move(self, task: str, to: tuple[float, ...], now: float) -> Iterator[Change]:
        """Work under way goes on where it is."""
        if len(to) != self.mission.dimensions:
            expected = f"{self.mission.dimensions} coordinates"
            raise ParameterError(f"move_task: {task}: position {list(to)}; expected {expected}")
        at = self._at(task)
        if task in self.ledger.ends_s or task in self.ledger.cancelled:
            return
        if any(state.activity is Activity.WORKING for state in at):
            return
        self._leave(task, now)
        self.ledger.move(task, to)
        self.ledger.give_up(task)
        self.ledger.refusals.pop(task, None)
        yield Change("move_task", {"task": task, "position": list(to)})

    def _delay(self, task: str, by_s: float) -> Iterator[Change]:
        if task not in self.ledger.ends_s and task not in self.ledger.cancelled:
            self.ledger.delay(task, by_s)
            yield Change("delay_task", {"task": task, "by_s": by_s})

    def _turn_door(self, event: Event, door: str, now: float) -> Iterator[Change]:
        """Robots under way are sent again, by other ways; where one opens they try what they had no way to."""
        opens = event.door_opens is not None
        kind = "door_opens" if opens else "door_closes"
        if door not in self.doors.known:
            expected = " or ".join(sorted(self.doors.known)) or "a zone or lane with an id"
            raise ParameterError(f"{kind}: {shown(door)}; expected {expected}")
        if self.doors.take(event):
            self.set_doors(self.doors.closed)
            for state in self.crew.values():
                goal = state.points_left[-1] if state.points_left else None
                state.left = self.travel.way_out(state.robot, state.position, goal) or state.left
                if not state.out and state.activity in (Activity.DRIVING, Activity.RETURNING, Activity.TO_STATION):
                    state.stop(now)
            if opens:
                self._open_ways()
            yield Change(kind, {"door": door})

    def _open_ways(self) -> None:
        """What stood in the way may do so no more: robots try what they had no way to."""
        self.ledger.try_again()
        self.stations.cut_off.clear()
        for state in self.crew.values():
            if state.cut_off:
                state.cut_off = state.at_home = False

    def set_doors(self, closed: frozenset[str]) -> None:
        """From now on these doors are closed, and the others open, for all that ask for ways."""
        self.doors.closed = closed
        self.travel.close(closed)
        self.on_doors(closed)

    def _leave(self, task: str, now: float) -> None:
        """Stop the robots that are at a task or on the way to it; those at a station before it go on there."""
        at = self._at(task)
        if any(state.activity is Activity.WORKING for state in at):
            break_off(self.crew, self.ledger, task, now)
        for state in at:
            if state.activity not in (Activity.IDLE, Activity.RETURNING, *AT_STATION):
                state.stop(now)

    def _at(self, task: str) -> list[RobotState]:
        return [state for state in self.crew.values() if state.route[:1] == [task]]

    def _robot_state(self, robot: str) -> RobotState:
        if robot not in self.crew:
            raise ParameterError(f"robot: {shown(robot)}; expected {' or '.join(self.crew)}")
        return self.crew[robot]

    def _station(self, station: str) -> str:
        if station not in self.stations.known:
            expected = " or ".join(self.stations.known) or "a mission with stations"
            raise ParameterError(f"station: {shown(station)}; expected {expected}")
        return station

    def _task(self, task: str) -> str:
        if task not in self.ledger.tasks:
            raise ParameterError(f"task: {shown(task)}; expected the id of a task that there is by then")
        return task


def new_robot_state(
    mission: Mission, robot: Robot, ports: Mapping[str, RobotPort], now: float, ignored: Collection[str] = ()
) -> RobotState:
    """A robot that begins to take part.

    Raises
    ------
    ParameterError
        if it has no port.
    """
    if robot.id not in ports:
        raise ParameterError(f"ports: no port for robot {shown(robot.id)}; expected one for each robot")
    home = robot.place_at_end(mission.rules)
    in_time = mission.rules.usage == "time"
    as_it_holds = robot_as_it_holds(robot, ignored)
    return RobotState(
        as_it_holds,
        ports[robot.id],
        None if home is None else place(home),
        LegTimes.in_mission(robot, mission),
        in_time,
        last_heard_s=now,
        since_s=now,
        energy=None if as_it_holds.battery is None else RobotEnergy(as_it_holds.battery),
    )


def lying(task: Task, at: Point, amounts: Mapping[str, float]) -> Task:
    """A task that took goods on board which now lie elsewhere: they are to be taken on there.

    What its work had to wait for, by when it was to be done, and who was to do it together with whom, was kept when it
    was done first. Its time windows hold for the work that is to be done now.
    """
    has_geometry = task.action is not None and task.action.has_geometry
    there = moved(replace(task, entry=None, exit=None, action=None if has_geometry else task.action), at)
    without: dict[str, Any] = {"prerequisites": (), "lags": {}, "deadline_s": None, "starts_with": ()}
    return replace(there, load=as_amount(amounts), same_robot_as=(), other_robot_than=(), **without)


def may_bring_work(event: Event, *, open_tasks: bool, cut_off: bool = False) -> bool:
    """Whether an event to come can bring work, or a robot for what is open, or one that is cut off to its end."""
    opens = event.door_opens is not None
    helps = event.robot_joins or event.robot_returns or event.move_task or event.station_returns or opens
    return event.new_task is not None or bool(helps and open_tasks) or (opens and cut_off)
