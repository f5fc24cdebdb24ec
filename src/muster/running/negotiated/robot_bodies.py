"""The bodies of robots and what befalls them, between the simulated world and the robots' processes."""

from __future__ import annotations

import threading
import time
from collections.abc import Mapping

from muster.execution.changes import may_bring_work
from muster.mission.errors import MusterError
from muster.mission.model import Event, Mission
from muster.mission.yaml_writer import plain
from muster.motion.port import RobotPort
from muster.negotiation.messages import Stage
from muster.negotiation.methods import method_named
from muster.negotiation.process_reports import Order
from muster.negotiation.team import Team
from muster.running.camera_search import Lookout
from muster.running.negotiated.pipe_messages import Befalls, Did, Radio, Sense, Steer
from muster.running.negotiated.team_log import Log
from muster.running.state_estimation import heard
from muster.simulation import SimulatedWorld

_LOOK_S = 0.05
"""Real seconds between two looks at bodies and robots."""

_BLIND_S = 0.5
"""Of the mission's time robots see nothing for so long at most."""

MOST_SPEED = _BLIND_S / _LOOK_S
"""So many times as fast as real time the mission goes at most."""


class Theatre:
    """The bodies of the robots and what befalls them, between the world and the robots' processes."""

    team: Team
    lookout: Lookout | None = None

    def __init__(self, mission: Mission, world: SimulatedWorld, order: Order, log: Log) -> None:
        self._world, self._order, self._log = world, order, log
        self._hearing = heard(world)
        self._method = method_named(order.method)
        self._ahead = sorted(mission.events, key=lambda event: event.at_s)
        self._did: dict[str, Did] = {}
        self._spoken: dict[str, int] = {}  # how often a robot was told that something befalls
        self._cut_off: set[str] = set()
        self._due_s = world.time_s
        self._unsaid: list[Event] = []  # of what concerns tasks, while no robot can be reached
        self._said: dict[str, list[Event]] = {}  # the same by the robot that was told
        self._last_move: dict[str, Event] = {}  # of each task
        self._orders: dict[str, int] = {}  # that bodies were given
        self._agreed_at: Stage | None = None  # of the auction, when its plan was taken in last

    def hear(self, robot: str, word: object) -> None:
        """Take in what a robot says to its body, or of itself."""
        if isinstance(word, Steer):
            self._orders[robot] = self._world.ports[robot].send(word.waypoints)
        elif isinstance(word, Did):
            self._did[robot], self._log.used[robot] = word, word.used
            for at_s, kind, data in word.events:
                self._log.take(robot, at_s, kind, data, word.used)
            for task, usage in word.usages.items():
                self._log.note_usage(task, usage)

    @property
    def ports(self) -> Mapping[str, RobotPort]:
        """How robots are reached, and what they say of themselves."""
        return self._hearing.ports

    @property
    def time_s(self) -> float:
        """The mission's clock."""
        return round(self._world.time_s, 9)

    @property
    def over(self) -> bool:
        """Whether nobody has anything to do any more, and nothing is to come that brings work."""
        if any(may_bring_work(event, open_tasks=self._log.open_tasks) for event in self._ahead):
            return False
        agreed = not self._connected or self.team.agree(self._connected)
        return agreed and all(map(self._rests, self.team.living))

    def agree_first(self, limit_s: float, halt: threading.Event) -> None:
        """Wait until robots have agreed for the first time."""
        until_s = time.monotonic() + limit_s
        while self._agreed_at is None and not halt.is_set():
            self.team.hear(_LOOK_S)
            self._notice_agreement()
            if time.monotonic() > until_s:
                raise MusterError(f"no agreement within {limit_s:g} s; expected robots to agree before they begin")

    def go_on(self, speed: float) -> None:
        """Go on for one look: let bodies move, and events happen; tell robots what they sense, and hear them.

        `speed` is how many times as fast as real time bodies move, at most MOST_SPEED.
        """
        until_s = time.monotonic() + _LOOK_S
        self._due_s += _LOOK_S * speed
        while self._hearing.advance(self._due_s):  # it stops wherever a way point is passed
            pass
        while self._ahead and self._ahead[0].at_s <= self.time_s + 1e-9:
            self._befalls(self._ahead.pop(0))
        self._look()
        for robot in self._said.keys() & self.team.gone.keys():
            self._unsaid += filter(self._holds, self._said.pop(robot))  # nobody else may know
        while self._unsaid and self._connected:
            self._say(self._unsaid.pop(0), self._connected[0])
        for robot in self.team.living:
            said = self._hearing.ports[robot].telemetry()
            assert said is not None
            self.team.tell(robot, Sense(self.time_s, said, self._orders.get(robot, 0), self._log.used[robot]))
            self._log.see(robot, said, self.time_s)
        self.team.hear(0.0)  # also if the world took all the time: words that nobody hears fill the pipes
        while (left_s := until_s - time.monotonic()) > 0:
            self.team.hear(left_s)
        self._notice_agreement()

    def _look(self) -> None:
        """Let cameras look; of what becomes of what they find one robot is told, which tells the others."""
        if self.lookout is None:
            return
        unheard = self._world.ports.keys() - self._connected
        for found, event in self.lookout.look(self.time_s, unheard):
            self._log.tell(self.time_s, "found", found)
            if event is not None:
                self._befalls(event)

    @property
    def _connected(self) -> list[str]:
        return [robot for robot in self.team.living if robot not in self._cut_off]

    def _rests(self, robot: str) -> bool:
        did = self._did.get(robot)
        if did is None or not did.idle or did.heard < self._spoken.get(robot, 0):
            return False
        return did.settled or robot in self._cut_off

    def _notice_agreement(self) -> None:
        """Take in the plan, if those that hear each other have agreed on another one."""
        connected = self._connected
        if not connected or not self.team.agree(connected):
            return
        stage = self.team.news[connected[0]].stage
        if stage == self._agreed_at:
            return
        for view in self.team.views(connected[:1]).values():
            if view.stage != stage:  # it has gone on meanwhile, and owns by now what nobody has agreed on yet
                return
            self._agreed_at = stage
            self._log.agreed(self._method.plan(self._order.problem, self._order.terms, view, None), self.time_s)

    def _befalls(self, event: Event) -> None:
        """What an event does to bodies, processes and their radio; of what concerns tasks one robot is told."""
        if not self._is_possible(event):
            self._log.tell(self.time_s, "without_effect", plain(event))
            return
        if event.robot_fails is not None:
            self._fail(event.robot_fails)  # first, as its last words are of what was before
        if not self._log.befalls(event, self.time_s) or event.robot_fails is not None:
            return
        if event.robot_silent is not None:
            self._set_radio(event.robot_silent, on=False)
        elif event.robot_returns is not None:
            self._return(event)
        elif event.robot_joins is not None:
            self._world.join(event.robot_joins)
            if self.lookout is not None:
                self.lookout.join(event.robot_joins)
            self.team.start(event.robot_joins.id)
        elif event.delay_task is not None:
            for robot in self.team.living:  # who is at work notices by itself
                self._say(event, robot)
        else:
            self._unsaid.append(event)
            if event.move_task is not None:
                self._last_move[event.move_task.task] = event

    def _is_possible(self, event: Event) -> bool:
        """Whether the robot that an event is about is in a state to which it applies."""
        if event.robot_fails is not None:
            return event.robot_fails in self.team.living
        if event.robot_silent is not None:
            return event.robot_silent in self._connected
        if event.robot_returns is not None:
            robot = event.robot_returns
            if robot in self.team.gone:
                return self.team.may_start(robot)  # not if somebody else has killed it
            return robot in self._cut_off or self._log.is_out(robot)
        return True

    def _fail(self, robot: str) -> None:
        """A robot breaks down, with its process."""
        self._world.fail(robot)
        self.team.kill(robot)
        self._cut_off.discard(robot)  # its next process has a radio that works
        while robot in self.team.living:
            self.team.hear(_LOOK_S)

    def _return(self, event: Event) -> None:
        robot = event.robot_returns
        assert robot is not None
        if robot in self.team.gone:
            self._world.recover(robot)
            self._did.pop(robot, None)
            self._spoken.pop(robot, None)
            self.team.start(robot)
        elif robot in self._cut_off:
            self._set_radio(robot, on=True)
        else:
            self._say(event, robot)

    def _set_radio(self, robot: str, *, on: bool) -> None:
        (self._cut_off.discard if on else self._cut_off.add)(robot)
        self.team.tell(robot, Radio(on))

    def _holds(self, event: Event) -> bool:
        """Whether no later event has made void what this one says."""
        return event.move_task is None or event is self._last_move[event.move_task.task]

    def _say(self, event: Event, robot: str) -> None:
        self._spoken[robot] = self._spoken.get(robot, 0) + 1
        if event.new_task or event.move_task or event.cancel_task:
            self._said.setdefault(robot, []).append(event)
        self.team.tell(robot, Befalls(event))
