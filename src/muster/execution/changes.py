"""Changes while a mission is carried out, applied to the task ledger and the robots."""

from __future__ import annotations

from collections.abc import Callable, Collection, Iterable, Mapping
from dataclasses import dataclass, replace

from muster.execution.goods_beside import fetching_place
from muster.execution.record import Tell
from muster.execution.replanning.travel import Travel
from muster.execution.robots.robot_energy import RobotEnergy
from muster.execution.robots.robot_state import Activity, RobotState
from muster.execution.robots.task_motion import MotionPlanner, Way, place, straight
from muster.execution.robots.work_orders import lead_elsewhere, stop_work
from muster.execution.standing_room import require_clear, require_free
from muster.execution.stations.slots import AT_STATION, Stations
from muster.mission.errors import MissionError, ParameterError
from muster.mission.events import MovedRobot
from muster.mission.model import Event, Mission, Robot, Task
from muster.mission.task_relations import tasks_named_by
from muster.mission.value_types import shown
from muster.mission.yaml_writer import plain
from muster.motion import actions
from muster.motion.leg_times import LegTimes
from muster.motion.port import Place, RobotPort
from muster.state import MissionState
from muster.state.robot_events import RobotFails, RobotJoins, RobotMoved, RobotOut, RobotRemoved, RobotReturns
from muster.state.robots import KnownRobot
from muster.state.station_events import DoorCloses, DoorOpens, StationFails, StationReturns
from muster.state.task_events import CancelTask, DelayTask, LoadLies, MoveTask, NewTask, WorkBrokenOff
from muster.state.task_ledger import Ledger, moved


@dataclass
class Changes:
    """Lets events happen: what they do to robots, beside what the state of the mission learns from them.

    Parameters
    ----------
    mission
        the question, for its rules.
    state, crew
        of the executor.
    ports
        how robots are reached; a robot that joins has its port here by then.
    stations
        of the executor.
    ask
        receives every event, each of which asks for a new plan.
    way
        the ways that robots go.
    on_doors
        receives the ids of the doors that are closed, when one closes or opens.
    on_moved
        receives the id of a robot that somebody has put elsewhere.
    plan_motion
        what a task makes a robot do.
    """

    mission: Mission
    state: MissionState
    crew: dict[str, RobotState]
    ports: Mapping[str, RobotPort]
    travel: Travel
    stations: Stations
    ask: Tell
    way: Way = straight
    on_doors: Callable[[Collection[str]], None] = lambda closed: None
    on_moved: Callable[[str], None] = lambda robot: None
    plan_motion: MotionPlanner = actions.plan

    @property
    def ledger(self) -> Ledger:
        """Of the tasks."""
        return self.state.ledger

    def apply(self, event: Event, now: float, reason: str = "", came_s: float | None = None) -> None:
        """Let an event happen, and ask for a new plan if it changes anything.

        That a robot falls silent is for the monitor to notice: nothing is done here. `reason` is why a robot fails,
        `came_s` when a task was ordered, if that was before now.

        Raises
        ------
        ParameterError
            if the event names a robot, task or door that there is not, or one anew that there is, or a robot without
            port.
        """
        if event.new_task is not None:
            self._add(event.new_task, came_s)
        elif event.cancel_task is not None:
            self._cancel(self._task(event.cancel_task), now)
        elif event.move_task is not None:
            self._move(self._task(event.move_task.task), event.move_task.position, now)
        elif event.delay_task is not None:
            self._delay(self._task(event.delay_task.task), event.delay_task.by_s)
        elif event.door is not None:
            self._turn_door(event.door, now, opens=event.door_opens is not None)
        elif event.station_fails is not None:
            self._fail_station(self._station(event.station_fails), now)
        elif event.station_returns is not None:
            self._return_station(self._station(event.station_returns))
        else:
            self._apply_to_robot(event, now, reason)

    def _apply_to_robot(self, event: Event, now: float, reason: str) -> None:
        if event.robot_fails is not None:
            self.exclude(self._robot_state(event.robot_fails), RobotFails, now, reason)
        elif event.robot_removed is not None:
            self.exclude(self._robot_state(event.robot_removed), RobotRemoved, now, reason)
        elif event.robot_returns is not None:
            self.readmit(self._robot_state(event.robot_returns), now)
        elif event.robot_joins is not None:
            self._join(event.robot_joins, now)
        elif event.robot_moved is not None:
            self._put(event.robot_moved, now)

    def _fail_station(self, station: str, now: float) -> None:
        """Robots that are served there, wait there, or are on the way to it stop; all are planned again."""
        if station in self.stations.failed:
            return
        for robot in self.stations.at(station):
            robot.note_energy()
            robot.stop(now)
        for robot in self.crew.values():
            robot.calls = [call for call in robot.calls if call.station != station]
        self.ask(StationFails(station=station))

    def _return_station(self, station: str) -> None:
        if station in self.stations.failed:
            self.ask(StationReturns(station=station))

    def exclude(self, robot: RobotState, why: type[RobotOut], now: float, detail: str = "") -> None:
        """Exclude a robot: its tasks are free, the current one too."""
        gone = robot.out in (RobotFails.kind, RobotRemoved.kind)
        if robot.out == why.kind or (gone and why is not RobotRemoved):
            return
        if robot.out and why not in (RobotFails, RobotRemoved):
            return
        name, at_work = robot.robot.id, robot.activity is Activity.WORKING
        robot.out_at = robot.position
        robot.note_unheard()
        broken = stop_work(self.crew, self.ledger, robot.route[0], now) if at_work else ()
        robot.stop(now)
        robot.calls = []
        aboard = [item for item in self.state.goods.on_board.get(name, ()) if item.task is not None]
        if why is RobotRemoved:
            self._open_ways()
        self.ask(why(robot=name, reason=detail))
        if why is RobotFails:
            for item in aboard:
                self._let_lie(robot, str(item.task), item.amounts)
        for task in broken:
            if len(self.ledger.unit(task)) > 1 or self.ledger.tasks[task].is_for_team:
                self.ask(WorkBrokenOff(task=task, robot=name))

    def _let_lie(self, robot: RobotState, task: str, amounts: Mapping[str, float]) -> None:
        """What a robot that fails has on board lies where it is: the task that took it on is done again beside it."""
        if task in self.ledger.ends_s:
            beside = fetching_place(robot, self.ledger.tasks[task], self.crew.values(), self.way)
            at = beside[: self.mission.dimensions]
            self.ask(LoadLies(task=task, robot=robot.robot.id, position=at, load=dict(amounts)))

    def require_place(self, moved: MovedRobot) -> None:
        """Raise ParameterError where nobody can put a robot: no such robot, no such place, or no room for it there."""
        robot = self._robot_state(moved.robot)
        if robot.out == RobotRemoved.kind:
            raise ParameterError(f"robot_moved.robot: {shown(moved.robot)}; expected one that was not taken away")
        require_free("robot_moved.position", robot.robot, moved.position, self._bodies, self.travel)

    @property
    def _bodies(self) -> list[tuple[Robot, Place]]:
        """The robots that are not taken away, and where they are."""
        return [(one.robot, one.position) for one in self.crew.values() if one.out != RobotRemoved.kind]

    def _put(self, moved: MovedRobot, now: float) -> None:
        """Somebody has moved a robot: it goes on from there, and work that it was at is begun again."""
        self.require_place(moved)
        robot = self._robot_state(moved.robot)
        at_work = robot.activity is Activity.WORKING
        broken = stop_work(self.crew, self.ledger, robot.route[0], now) if at_work else ()
        robot.stop(now)
        robot.put(place(moved.position))
        self.on_moved(moved.robot)
        self._open_ways()
        self.ask(RobotMoved(robot=moved.robot, position=moved.position))
        for task in broken:
            if len(self.ledger.unit(task)) > 1 or self.ledger.tasks[task].is_for_team:
                self.ask(WorkBrokenOff(task=task, robot=moved.robot))

    def require_return(self, name: str) -> None:
        """Raise ParameterError where a robot that was taken away cannot be put back: others are in its place.

        That is where it was last heard: a real robot says where it is put.
        """
        robot = self._robot_state(name)
        if robot.out == RobotRemoved.kind:
            require_clear("robot_returns.position", robot.robot, robot.position, self._bodies)

    def readmit(self, robot: RobotState, now: float, reason: str = "") -> None:
        """Let a robot take part again, from where it is; one that was taken away from where that was."""
        self.require_return(robot.robot.id)
        if robot.out:
            robot.last_heard_s, robot.sent_again = now, 0
            self._open_ways()
            robot.stop(now)
            self.ask(RobotReturns(robot=robot.robot.id, reason=reason))

    def require_newcomer(self, robot: Robot) -> None:
        """Raise ParameterError where a robot cannot join: its id is taken, or it does not fit the mission."""
        if robot.id in self.crew:
            raise ParameterError(f"robot_joins: {shown(robot.id)}; expected an id that no robot has")
        if not self.travel.knows(robot.id):
            raise ParameterError(f"robot_joins: {shown(robot.id)}; expected a robot with rows in the travel tables")
        self._require_fit("robot_joins", robots=(robot,))

    def _join(self, robot: Robot, now: float) -> None:
        self.require_newcomer(robot)
        require_port(robot, self.ports)
        self.ask(RobotJoins(robot=plain(robot)))
        self.crew[robot.id] = new_robot_state(self.mission, self.state.robots[robot.id], self.ports, now, self.ledger)
        self.crew[robot.id].recall_known()

    def _add(self, task: Task, came_s: float | None) -> None:
        if task.id in self.ledger.tasks:
            raise ParameterError(f"new_task: {shown(task.id)}; expected an id that no task has")
        self._require_fit("new_task", tasks=(task,))
        self.ask(NewTask(task=plain(task), came_s=came_s))

    def _require_fit(self, what: str, *, robots: tuple[Robot, ...] = (), tasks: tuple[Task, ...] = ()) -> None:
        """A mission with these robots and tasks, and those that there are, must be one."""
        there = {robot.id: robot for robot in (*self.mission.robots, *(one.robot for one in self.crew.values()))}
        beside: Iterable[Task] = self.ledger.tasks.values()
        if not robots and not any(map(tasks_named_by, tasks)):  # what names no other fits however many there are
            beside = ()
        rules = replace(self.mission.rules, travel=None)  # lanes, which are large, are looked at once
        try:
            self.mission.at_once(rules=rules, lanes=None, robots=(*there.values(), *robots), tasks=(*beside, *tasks))
        except MissionError as error:
            found = error.findings[0]
            name = [*(robot.id for robot in robots), *(task.id for task in tasks)][0]
            raise ParameterError(f"{what}: {name}: {found.value}; expected {found.expected}") from None

    def _cancel(self, task: str, now: float) -> None:
        if not self.ledger.is_open(task):
            return
        self._leave(task, now)
        for robot in self.crew.values():
            robot.leave_out({task})
        self.ask(CancelTask(task=task))

    def _move(self, task: str, to: tuple[float, ...], now: float) -> None:
        """Robots that carry a load to a delivery bring it to where that is by now; other work goes on where it is."""
        if len(to) != self.mission.dimensions:
            expected = f"{self.mission.dimensions} coordinates"
            raise ParameterError(f"move_task: {task}: position {list(to)}; expected {expected}")
        if not self.ledger.is_open(task):
            return
        at_work = [robot for robot in self._at(task) if robot.activity is Activity.WORKING]
        if not at_work:
            self._leave(task, now)
            self.ask(MoveTask(task=task, position=to))
            return
        before = self.ledger.tasks[task]
        if lead_elsewhere(at_work, before, moved(before, to), self.plan_motion, self.way, now):
            self.ask(MoveTask(task=task, position=to, under_way=True))

    def _delay(self, task: str, by_s: float) -> None:
        if self.ledger.is_open(task):
            self.ask(DelayTask(task=task, by_s=by_s))

    def _turn_door(self, door: str, now: float, *, opens: bool) -> None:
        """Robots under way are sent again, by other ways; where one opens they try what they had no way to."""
        doors = self.state.doors
        if door not in doors.known:
            expected = " or ".join(sorted(doors.known)) or "a zone or lane with an id"
            raise ParameterError(f"{'door_opens' if opens else 'door_closes'}: {shown(door)}; expected {expected}")
        if opens != (door in doors.closed):
            return
        if opens:
            self._open_ways()
        self.ask(DoorOpens(door=door) if opens else DoorCloses(door=door))
        self.close_doors()
        for robot in self.crew.values():
            goal = robot.points_left[-1] if robot.points_left else None
            robot.left = self.travel.way_out(robot.robot, robot.position, goal) or robot.left
            if not robot.out and robot.activity in (Activity.DRIVING, Activity.RETURNING, Activity.TO_STATION):
                robot.stop(now)

    def _open_ways(self) -> None:
        """Robots that were cut off from their ends may be so no more."""
        for robot in self.crew.values():
            if robot.cut_off:
                robot.cut_off = robot.at_home = False

    def close_doors(self) -> None:
        """From now on the doors that are closed are so for all that ask for ways."""
        self.travel.close(self.state.doors.closed)
        self.on_doors(self.state.doors.closed)

    def _leave(self, task: str, now: float) -> None:
        """Stop the robots that are at a task or on the way to it; those at a station before it go on there."""
        at = self._at(task)
        if any(robot.activity is Activity.WORKING for robot in at):
            stop_work(self.crew, self.ledger, task, now)
        for robot in at:
            if robot.activity not in (Activity.IDLE, Activity.RETURNING, *AT_STATION):
                robot.stop(now)

    def leave_way(self, robot: RobotState, now: float) -> None:
        """Stop a robot whose way is closed; its work, too, if it is at some."""
        if robot.activity is Activity.WORKING:
            stop_work(self.crew, self.ledger, robot.route[0], now)
        else:
            robot.stop(now)

    def _at(self, task: str) -> list[RobotState]:
        return [robot for robot in self.crew.values() if robot.route[:1] == [task]]

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


def require_port(robot: Robot, ports: Mapping[str, RobotPort]) -> None:
    """Raise ParameterError unless a robot can be reached."""
    if robot.id not in ports:
        raise ParameterError(f"ports: no port for robot {shown(robot.id)}; expected one for each robot")


def new_robot_state(
    mission: Mission, known: KnownRobot, ports: Mapping[str, RobotPort], now: float, ledger: Ledger
) -> RobotState:
    """A robot that begins to take part.

    Raises
    ------
    ParameterError
        if it has no port.
    """
    robot = known.robot
    require_port(robot, ports)
    home = robot.place_at_end(mission.rules)
    as_it_holds = ledger.as_it_holds(robot)
    return RobotState(
        as_it_holds,
        known,
        ports[robot.id],
        None if home is None else place(home),
        LegTimes.in_mission(robot, mission),
        mission.rules.usage == "time",
        last_heard_s=now,
        since_s=now,
        energy=RobotEnergy.of(as_it_holds),
        limits=ledger.model.limits(as_it_holds),
    )


def may_bring_work(event: Event, *, open_tasks: bool, cut_off: bool = False) -> bool:
    """Whether an event to come can bring work, or a robot for what is open, or one that is cut off to its end."""
    opens = event.door_opens or event.robot_returns or event.robot_removed or event.robot_moved
    helps = opens or event.robot_joins or event.move_task or event.station_returns
    return event.new_task is not None or bool(helps and open_tasks) or bool(opens and cut_off)
