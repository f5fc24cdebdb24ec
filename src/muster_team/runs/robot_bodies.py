"""The robots' bodies and the mission's events, between the simulated world and the robots' processes."""

from __future__ import annotations

import threading
import time
from collections import deque
from collections.abc import Mapping, Sequence
from functools import cached_property

from muster.execution.changes import may_bring_work
from muster.execution.replanning.travel import Travel, travel_of
from muster.execution.standing_room import require_clear, require_free
from muster.mission.errors import MusterError, ParameterError
from muster.mission.model import Event, Mission
from muster.mission.yaml_writer import plain
from muster.motion.port import RobotPort
from muster.running.camera_search import CameraSearch
from muster.running.state_estimation import RobotsInWorld
from muster.running.true_places import TruePlaces
from muster.simulation import SimulatedWorld
from muster.state import OtherEvent
from muster.state.robot_events import RobotRemoved
from muster.state.run_events import EventRefused
from muster_team.knowledge.messages import Stage
from muster_team.negotiators.methods import method_named
from muster_team.processes.process_reports import SHOW, TeamSetup
from muster_team.processes.team import Team
from muster_team.runs.pipe_messages import (
    BodyState,
    LidarScan,
    MapPieces,
    OperatorEvent,
    RadioState,
    SteerCommand,
    WorkReport,
)
from muster_team.runs.scanned_ground import ScannedGround
from muster_team.runs.team_log import TeamLog
from muster_team.runs.team_watch import TeamWatch

_STEP_S = 0.05
"""The real time between two steps, seconds."""

_ANSWER_S = 0.5
"""The real time within which a robot is expected to tell its view, before the next one is asked."""

_MOST_STEP_S = 0.5
"""The longest step in the mission's time, seconds: robots receive no sensor data within a step."""

_KEPT = 1200
"""Places of each robot that are kept, one a step, for what it tells late: those of a minute of real time."""

_Place = tuple[float, tuple[float, float]]  # a time of the mission, and where a robot truly was

MOST_SPEED = _MOST_STEP_S / _STEP_S
"""The largest speed-up over real time."""


class RobotBodies:
    """The bodies of the robots and the mission's events, between the world and the robots' processes."""

    team: Team
    camera_search: CameraSearch | None = None

    def __init__(
        self,
        mission: Mission,
        world: SimulatedWorld,
        robots: RobotsInWorld,
        setup: TeamSetup,
        log: TeamLog,
        ground: ScannedGround | None = None,
    ) -> None:
        self._mission, self._world, self._setup, self._log, self.ground = mission, world, setup, log, ground
        self.true_places = TruePlaces(mission, world, robots, self._tag_of, self._place_at)
        self._places: dict[str, deque[_Place]] = {}  # of each robot when it was sent its state
        self._telemetry_source = robots
        self._method = method_named(setup.method)
        self._future_events = sorted(mission.events, key=lambda event: event.at_s)
        self._work_reports: dict[str, WorkReport] = {}
        self._events_sent: dict[str, int] = {}  # the number of events sent to each robot
        self._cut_off: set[str] = set()
        self._due_s = world.time_s
        self._unsent: list[Event] = []  # of what concerns tasks, while no robot can be reached
        self._sent_to: dict[str, list[Event]] = {}  # the same by the robot that received them
        self._last_move: dict[str, Event] = {}  # of each task
        self._orders: dict[str, int] = {}  # that bodies were given
        self.watch = TeamWatch([robot.id for robot in mission.all_robots], setup.timeouts.suspect_s * setup.speed)
        self._agreed_at: Stage | None = None  # of the auction, when its plan was taken in last
        self._asked, self._ask_again_s = -1, 0.0  # how often robots were asked for their view, and when the next is

    def take_report(self, robot: str, report: object) -> None:
        """Process what a robot sends to its body, or reports of itself."""
        if isinstance(report, SteerCommand):
            self._orders[robot] = self._world.ports[robot].send(report.waypoints)
        elif isinstance(report, MapPieces) and self.ground is not None:
            self.ground.take(robot, report.life, report.pieces)
        elif isinstance(report, WorkReport):
            self._work_reports[robot], self._log.used[robot] = report, report.used
            self.watch.refused_by_team(robot, report.refused_by_team)
            for reason in report.refused_at_once:
                self.watch.refused_at_once(robot, reason)
            for at_s, kind, data in report.events:
                told = len(self._log.events)
                self._log.take(robot, at_s, kind, data, report.used)
                for off in self.true_places.follow(self._log.events[told:], self._log.state.ledger.tasks, at_s):
                    self._log.tell(off)

    def _place_at(self, robot: str, time_s: float) -> tuple[float, float] | None:
        """Where a robot was when it was last sent its state, up to a time: what it tells, it did there."""
        return next((place for at_s, place in reversed(self._places.get(robot, ())) if at_s <= time_s + 1e-9), None)

    @property
    def ports(self) -> Mapping[str, RobotPort]:
        """The ports of the robots' bodies, with telemetry."""
        return self._telemetry_source.ports

    @property
    def time_s(self) -> float:
        """The mission's time."""
        return round(self._world.time_s, 9)

    @property
    def over(self) -> bool:
        """Whether no robot has anything left to do, and no future event brings work."""
        if any(may_bring_work(event, open_tasks=self._log.open_tasks) for event in self._future_events):
            return False
        agreed = not self._connected or self.team.agree(self._connected)
        return agreed and all(map(self._is_idle, self.team.living))

    def await_agreement(self, limit_s: float, halt: threading.Event) -> None:
        """Wait until the robots have agreed for the first time."""
        until_s = time.monotonic() + limit_s
        while self._agreed_at is None and not halt.is_set():
            self.team.poll(_STEP_S)
            self._take_agreement()
            if time.monotonic() > until_s:
                raise MusterError(f"no agreement within {limit_s:g} s; expected robots to agree before they begin")

    def step(self, speed: float) -> None:
        """Advance by one step: move bodies, let events happen, send sensor data to robots, and process their reports.

        `speed` is the speed-up over real time, at most MOST_SPEED.
        """
        until_s = time.monotonic() + _STEP_S
        self._due_s += _STEP_S * speed
        while self._telemetry_source.advance(self._due_s):  # it stops wherever a way point is passed
            pass
        while self._future_events and self._future_events[0].at_s <= self.time_s + 1e-9:
            self._take_event(self._future_events.pop(0))
        self._check_cameras()
        self.true_places.look()
        for robot in self._sent_to.keys() & self.team.ended.keys():
            self._unsent += filter(self._is_valid, self._sent_to.pop(robot))  # other robots may not know of it
        while self._unsent and self._connected:
            self._send(self._unsent.pop(0), self._connected[0])
        for robot in self.team.living:
            said = self._telemetry_source.ports[robot].telemetry()
            assert said is not None
            body = BodyState(self.time_s, said, self._orders.get(robot, 0), self._log.used[robot])
            self.team.send(robot, body, latest=True)
            x, y, _ = self._world.ports[robot].true_position
            self._places.setdefault(robot, deque(maxlen=_KEPT)).append((self.time_s, (x, y)))
            self._log.see(robot, said, self.time_s)
        self._scan()
        self.team.poll(0.0)  # even if the step took all the time: unread reports fill the pipes
        while (left_s := until_s - time.monotonic()) > 0:
            self.team.poll(left_s)
        statuses = {robot: progress.status for robot, progress in self.team.progress.items()}
        self.watch.look(self.time_s, self.team.living, self.team.ended, statuses)
        self._take_agreement()

    def _scan(self) -> None:
        """Send robots without a map what their lidars see."""
        if self.ground is None:
            return
        for robot, scan in self.ground.scans(self.team.living, self._connected).items():
            self.team.send(robot, LidarScan(scan), latest=True)
        self.ground.follow()

    @property
    def ways_closed(self) -> int:
        """How often robots have gone other ways, as theirs were closed by what their team saw."""
        return sum(report.ways_closed for report in self._work_reports.values())

    def _check_cameras(self) -> None:
        """Evaluate the cameras. Tasks from their findings go to one robot, which sends them to the others."""
        if self.camera_search is None:
            return
        unheard = self._world.ports.keys() - self._connected
        for found, event in self.camera_search.look(self.time_s, unheard):
            self._log.tell(OtherEvent(time_s=self.time_s, kind="found", content=found))
            if event is not None:
                self._take_event(event)

    def _tag_of(self, task: str) -> int | None:
        return None if self.camera_search is None else self.camera_search.tasks.tag_of(task)

    @property
    def _connected(self) -> list[str]:
        return [robot for robot in self.team.living if robot not in self._cut_off]

    def _is_idle(self, robot: str) -> bool:
        report = self._work_reports.get(robot)
        if report is None or not report.idle or report.heard < self._events_sent.get(robot, 0):
            return False
        return report.settled or robot in self._cut_off

    def _take_agreement(self) -> None:
        """Record the plan if the connected robots have agreed on another one."""
        connected = self._connected
        if not connected or not self.team.agree(connected):
            return
        stage = self.team.progress[connected[0]].stage
        if stage == self._agreed_at:
            return
        views = (self.team.progress[robot].view for robot in connected)
        view = next((view for view in views if view is not None and view.stage == stage), None)
        if view is None:
            self._ask_for_view(connected)
        else:
            self._agreed_at = stage
            self._log.agreed(self._method.plan(self._setup.problem, self._setup.terms, view, None), self.time_s)

    def _ask_for_view(self, robots: Sequence[str]) -> None:
        """Ask one robot after another what it has agreed to; one that does not answer soon holds up nobody."""
        if time.monotonic() >= self._ask_again_s:
            self._ask_again_s = time.monotonic() + _ANSWER_S
            self._asked += 1
            self.team.send(robots[self._asked % len(robots)], SHOW)

    def _take_event(self, event: Event) -> None:
        """Apply an event to bodies, processes and their radio; send an event that concerns tasks to one robot."""
        if not self._is_possible(event):
            self._log.tell(OtherEvent(time_s=self.time_s, kind="without_effect", content=plain(event)))
            return
        try:
            self._require_room(event)
        except ParameterError as error:
            self._log.tell(EventRefused(time_s=self.time_s, event=plain(event), reason=str(error)))
            return
        if (down := event.robot_fails or event.robot_removed) is not None:
            if down in self.team.living:
                self._fail(down)  # first, as its last reports precede the event
            if event.robot_removed is not None:
                self._world.remove(down)
        if not self._log.take_event(event, self.time_s) or down is not None:
            return
        self._carry_out(event)

    def _carry_out(self, event: Event) -> None:
        """Apply an event that leaves robots at work, or brings one."""
        if event.robot_silent is not None:
            self._set_radio(event.robot_silent, on=False)
        elif event.robot_moved is not None:
            self._world.place(event.robot_moved.robot, event.robot_moved.position)
            if event.robot_moved.robot in self.team.living:
                self._send(event, event.robot_moved.robot)
        elif event.robot_returns is not None:
            self._return(event)
        elif event.robot_joins is not None:
            self._world.join(event.robot_joins)
            if self.camera_search is not None:
                self.camera_search.join(event.robot_joins)
            self.team.start(event.robot_joins.id)
        elif event.delay_task is not None:
            for robot in self.team.living:  # the robot at work notices it by itself
                self._send(event, robot)
        else:
            self._unsent.append(event)
            if event.move_task is not None:
                self._last_move[event.move_task.task] = event

    def _is_possible(self, event: Event) -> bool:
        """Whether the robot of an event is in a state to which the event applies."""
        if event.robot_fails is not None:
            return event.robot_fails in self.team.living
        if event.robot_removed is not None:
            return event.robot_removed in self._world.ports and not self._is_removed(event.robot_removed)
        if event.robot_moved is not None:
            return event.robot_moved.robot in self._world.ports and not self._is_removed(event.robot_moved.robot)
        if event.robot_silent is not None:
            return event.robot_silent in self._connected
        if event.robot_returns is not None:
            robot = event.robot_returns
            if robot in self.team.ended:
                return self.team.may_start(robot)  # not if it was killed from outside
            return robot in self._cut_off or self._log.is_out(robot)
        return True

    def _is_removed(self, robot: str) -> bool:
        return self._log.state.robots[robot].out == RobotRemoved.kind

    def _require_room(self, event: Event) -> None:
        """Raise ParameterError where an event puts a robot where it cannot stand, which no robot by itself knows."""
        robots = {name: known.robot for name, known in self._log.state.robots.items() if name in self._world.ports}
        places = {name: self._world.ports[name].telemetry() for name in robots}
        there = [(robots[name], said.position) for name, said in places.items() if said and not self._is_removed(name)]
        if (moved := event.robot_moved) is not None:
            require_free("robot_moved.position", robots[moved.robot], moved.position, there, self._travel)
        elif (back := event.robot_returns) is not None and self._is_removed(back) and (said := places[back]):
            require_clear("robot_returns.position", robots[back], said.position, there)

    @cached_property
    def _travel(self) -> Travel:
        """What knows walls and closed areas."""
        return travel_of(self._mission)

    def _fail(self, robot: str) -> None:
        """A robot breaks down, with its process."""
        self._world.fail(robot)
        self.team.kill(robot)
        self._cut_off.discard(robot)  # its next process has a radio that works
        while robot in self.team.living:
            self.team.poll(_STEP_S)

    def _return(self, event: Event) -> None:
        robot = event.robot_returns
        assert robot is not None
        if robot in self.team.ended:
            self._world.recover(robot)
            self._work_reports.pop(robot, None)
            self._events_sent.pop(robot, None)
            self.team.start(robot)
            if self.ground is not None:
                self.ground.forget(robot)
        elif robot in self._cut_off:
            self._set_radio(robot, on=True)
        else:
            self._send(event, robot)

    def _set_radio(self, robot: str, *, on: bool) -> None:
        (self._cut_off.discard if on else self._cut_off.add)(robot)
        self.watch.radio(robot, self.time_s, on=on)
        self.team.send(robot, RadioState(on))

    def _is_valid(self, event: Event) -> bool:
        """Whether no later event has replaced this one."""
        return event.move_task is None or event is self._last_move[event.move_task.task]

    def _send(self, event: Event, robot: str) -> None:
        self._events_sent[robot] = self._events_sent.get(robot, 0) + 1
        if event.new_task or event.move_task or event.cancel_task:
            self._sent_to.setdefault(robot, []).append(event)
        self.team.send(robot, OperatorEvent(event))
