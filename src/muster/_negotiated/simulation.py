"""A mission carried out by robots that are processes, in a simulated world, at the pace of real time."""

from __future__ import annotations

import tempfile
import threading
import time
from collections.abc import Callable, Sequence
from contextlib import ExitStack
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

from muster._carrying_out import LOOK_S, Recorder, world_named
from muster._negotiated.log import Log
from muster._negotiated.robot import decide_for_itself
from muster._negotiated.words import Befalls, Did, Radio, Sense, Steer
from muster.allocation.problem import Problem
from muster.execution import Happening, Report, report_of
from muster.execution.executor import may_bring_work
from muster.execution.record import NoObserver
from muster.mission.errors import MusterError
from muster.mission.model import Event, Mission
from muster.mission.yaml_writer import plain
from muster.negotiation.keys import new_key
from muster.negotiation.messages import Stage
from muster.negotiation.methods import method_named
from muster.negotiation.team import Team, patience_here
from muster.negotiation.watch import Order
from muster.simulation import NO_NOISE, Noise, SimulatedWorld

_LOOK_S = 0.05
"""Real seconds between two looks at bodies and robots."""


@dataclass(frozen=True, kw_only=True)
class Negotiation:
    """How robots agree.

    Parameters
    ----------
    method, transport
        names of METHODS and TRANSPORTS.
    params
        of the method's allocator; None: its own.
    limit_s
        real seconds within which they have to agree before the mission begins.
    """

    method: str = "auction"
    transport: str = "udp"
    params: Any = None
    limit_s: float = 60.0


def negotiate_and_carry_out(
    problem: Problem,
    negotiation: Negotiation,
    *,
    world: str = "kinematic",
    seed: int = 0,
    dt_s: float = 0.1,
    avoidance: str = "orca",
    noise: Noise = NO_NOISE,
    speed: float | None = None,
    recorder: Recorder | None = None,
    on_happening: Callable[[Happening], None] | None = None,
    halt: threading.Event | None = None,
) -> Report:
    """Let robots agree, and carry out what they agree on, each for itself; the mission's events happen meanwhile.

    The mission begins when all have agreed for the first time.

    Parameters
    ----------
    problem
        what about, without robots that join later.
    speed
        how many times as fast as real time robots move; None: once. They talk in real time: the faster they move, the
        longer their talk takes in the mission's time.
    others
        as `_carrying_out.carry_out` takes them.

    Raises
    ------
    MusterError
        if there is no agreement in time, or a robot cannot take part.
    """
    with ExitStack() as stack:
        memory = Path(stack.enter_context(tempfile.TemporaryDirectory()))
        bodies = world_named(world)(
            problem.mission,
            seed=seed,
            dt_s=dt_s,
            avoidance=avoidance,
            noise=noise,
            observer=None if recorder is None else recorder.on_step,
            observe_s=0.0 if recorder is None else 0.1,
        )
        order = order_of(problem, negotiation, memory)
        log = Log(order.problem, recorder or NoObserver(), on_happening or (lambda happening: None))
        theatre = Theatre(problem.mission, bodies, order, log)
        theatre.team = stack.enter_context(Team(order, theatre.hear))
        halt = halt or threading.Event()
        theatre.agree_first(negotiation.limit_s, halt)
        while not halt.is_set() and not theatre.over:
            theatre.go_on(1.0 if speed is None else speed)
        if theatre.over:
            log.end()
        report = report_of(log.account, contacts=len(bodies.contacts), min_distance_m=bodies.min_distance_m)
        if recorder is not None:
            recorder.on_report(report.as_dict())
        return report


def order_of(problem: Problem, negotiation: Negotiation, memory: Path) -> Order:
    """What the robots' processes are to do: robots that join, or start again, have theirs from the beginning, too."""
    mission = problem.mission
    joining = [event.robot_joins for event in mission.events if event.robot_joins is not None]
    whole = Problem.compile(
        replace(mission, robots=(*mission.robots, *joining), events=()), problem.objective, problem.ignored
    )
    method = method_named(negotiation.method)
    return Order(
        problem=whole.ready(),
        terms=method.allocator.parameters() if negotiation.params is None else negotiation.params,
        key=new_key(),
        method=negotiation.method,
        transport=negotiation.transport,
        patience=patience_here(len(whole.robots)),
        late=frozenset(robot.id for robot in joining),
        lives=_lives(mission.events),
        memory=memory,
        part=decide_for_itself,
    )


def _lives(events: Sequence[Event]) -> dict[str, int]:
    """How often those robots start that start again after they have failed."""
    failed, lives = set[str](), dict[str, int]()
    for event in sorted(events, key=lambda event: event.at_s):
        if event.robot_fails is not None:
            failed.add(event.robot_fails)
        elif event.robot_returns in failed and event.robot_returns is not None:
            failed.remove(event.robot_returns)
            lives[event.robot_returns] = lives.get(event.robot_returns, 1) + 1
    return lives


class Theatre:
    """The bodies of the robots and what befalls them, between the world and the robots' processes."""

    team: Team

    def __init__(self, mission: Mission, world: SimulatedWorld, order: Order, log: Log) -> None:
        self._world, self._order, self._log = world, order, log
        self._method = method_named(order.method)
        self._ahead = sorted(mission.events, key=lambda event: event.at_s)
        self._did: dict[str, Did] = {}
        self._spoken: dict[str, int] = {}  # how often a robot was told that something befalls
        self._cut_off: set[str] = set()
        self._due_s = world.time_s
        self._unsaid: list[Event] = []  # of what concerns tasks, while no robot can be reached
        self._said: dict[str, list[Event]] = {}  # the same by the robot that was told
        self._orders: dict[str, int] = {}  # that bodies were given
        self._agreed_at: Stage | None = None  # of the auction, when its plan was taken in last

    def hear(self, robot: str, word: object) -> None:
        """Take in what a robot says to its body, or of itself."""
        if isinstance(word, Steer):
            self._orders[robot] = self._world.ports[robot].send(word.waypoints)
        elif isinstance(word, Did):
            self._did[robot] = word
            for at_s, kind, data in word.happenings:
                self._log.take(robot, at_s, kind, data, word.used)
            for task, usage in word.usages.items():
                self._log.note_usage(task, usage)

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
        """Go on for one look: let bodies move, and events happen; tell robots what they sense, and hear them."""
        until_s = time.monotonic() + _LOOK_S
        self._due_s += min(LOOK_S, _LOOK_S * speed)
        while self._world.advance(self._due_s):  # it stops wherever a way point is passed
            pass
        while self._ahead and self._ahead[0].at_s <= self.time_s + 1e-9:
            self._befalls(self._ahead.pop(0))
        while self._unsaid and self._connected:
            self._say(self._unsaid.pop(0), self._connected[0])
        for robot in self.team.living:
            said = self._world.ports[robot].telemetry()
            assert said is not None
            self.team.tell(robot, Sense(self.time_s, said, self._orders.get(robot, 0), self._log.used[robot]))
            self._log.see(robot, said, self.time_s)
        while (left_s := until_s - time.monotonic()) > 0:
            self.team.hear(left_s)
        self._notice_agreement()

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
            self._agreed_at = view.stage
            self._log.agreed(self._method.plan(self._order.problem, self._order.terms, view, None), self.time_s)

    def _befalls(self, event: Event) -> None:
        """What an event does to bodies, processes and their radio; of what concerns tasks one robot is told."""
        if not self._is_possible(event):
            self._log.tell(self.time_s, "without_effect", plain(event))
            return
        if not self._log.befalls(event, self.time_s):
            return
        if event.robot_fails is not None:
            self._fail(event.robot_fails)
        elif event.robot_silent is not None:
            self._set_radio(event.robot_silent, on=False)
        elif event.robot_returns is not None:
            self._return(event)
        elif event.robot_joins is not None:
            self._world.join(event.robot_joins)
            self.team.start(event.robot_joins.id)
        elif event.delay_task is not None:
            for robot in self.team.living:  # who is at work notices by itself
                self._say(event, robot)
        else:
            self._unsaid.append(event)

    def _is_possible(self, event: Event) -> bool:
        """Whether the robot that an event is about is in a state to which it applies."""
        if event.robot_fails is not None:
            return event.robot_fails in self.team.living
        if event.robot_silent is not None:
            return event.robot_silent in self._connected
        if event.robot_returns is not None:
            robot = event.robot_returns
            return robot in self.team.gone or robot in self._cut_off or self._log.is_out(robot)
        return True

    def _fail(self, robot: str) -> None:
        """A robot breaks down, with its process. What only it was told has to be said again."""
        self._world.fail(robot)
        self.team.kill(robot)
        while robot in self.team.living:
            self.team.hear(_LOOK_S)
        self._unsaid += self._said.pop(robot, [])

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

    def _say(self, event: Event, robot: str) -> None:
        self._spoken[robot] = self._spoken.get(robot, 0) + 1
        if event.new_task or event.move_task or event.cancel_task:
            self._said.setdefault(robot, []).append(event)
        self.team.tell(robot, Befalls(event))
