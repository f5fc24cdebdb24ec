"""The main loop of a robot's process: negotiation, control of its body, and reports to the starter."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import replace
from queue import Empty

from muster.mission.model import Event
from muster.motion.port import Telemetry, Waypoint
from muster_team.network.map_link import MapLink
from muster_team.processes.node import Node
from muster_team.processes.process_reports import Ready
from muster_team.processes.team_process import ProcessContext, ProgressReporter, StarterCommands
from muster_team.runs.pipe_messages import (
    BodyState,
    LidarScan,
    MapPieces,
    OperatorEvent,
    RadioState,
    SteerCommand,
    WorkReport,
)
from muster_team.runs.robot_control import RobotControl
from muster_team.runs.robot_ground import RobotGround

_STEP_S = 0.02
"""The longest time between two looks at the body's state, seconds."""


def run_robot_process(context: ProcessContext) -> None:
    """Take part and execute what the robot owns, until the starter has ended."""
    commands, reporter = StarterCommands(context.pipe), ProgressReporter(context.pipe)
    if context.comes_late:
        commands.go.wait()
    with context.node() as node:
        worker = RobotWorker(context, node)
        if not context.comes_late:
            context.pipe.send(Ready())
            commands.go.wait()
        while not commands.leave.is_set():
            node.step(_STEP_S)
            worker.receive(_all_of(commands.messages.get_nowait))
            worker.step()
            reporter.report(node, commands)


class PipePort:
    """The body of a robot at the other end of a pipe; a `RobotPort`."""

    def __init__(self, robot: str, steer: Callable[[SteerCommand], None], orders: int, said: Telemetry) -> None:
        self._robot, self._steer, self._orders = robot, steer, orders
        self.said = said

    @property
    def robot(self) -> str:
        return self._robot

    def send(self, waypoints: Sequence[Waypoint]) -> int:
        self._orders += 1
        self._steer(SteerCommand(tuple(waypoints)))
        return self._orders

    def cancel(self) -> int:
        return self.send(())

    def telemetry(self) -> Telemetry | None:
        return self.said


class RobotWorker:
    """What the process does beside the auction."""

    def __init__(self, context: ProcessContext, node: Node) -> None:
        self._context, self._node = context, node
        self._control: RobotControl | None = None
        self._now_s = 0.0
        self._heard = 0
        self._events: list[Event] = []
        self._refused: list[str] = []
        self._reported: WorkReport | None = None
        setup, problem = context.setup, context.problem
        self._ground: RobotGround | None = None
        if setup.ground is not None:
            robots = [robot.id for robot in problem.robots]
            link = MapLink(context.robot, context.start_number, robots, setup.timeouts.heartbeat_s)
            self._ground = RobotGround(problem, setup.ground, context.robot, link)
            self._ground.join(node)

    def receive(self, messages: Sequence[object]) -> None:
        for message in messages:
            if isinstance(message, BodyState):
                self._sense(message)
            elif isinstance(message, LidarScan) and self._ground is not None:
                if pieces := self._ground.see(message.scan):
                    self._context.pipe.send(MapPieces(self._context.start_number, pieces))
            elif isinstance(message, RadioState):
                self._node.in_reach = message.on
            elif isinstance(message, OperatorEvent):
                self._events.append(message.event)

    def step(self) -> None:
        """Control the body, and report what was done."""
        control = self._control
        if control is None:
            return
        for event in self._events:
            self._heard += 1
            why_not = control.take_event(event)
            self._refused += [] if why_not is None else [why_not]
        self._events.clear()
        events = [(event.time_s, event.kind, event.data) for event in control.tick(self._now_s)]
        events += [(self._now_s, "event_refused", {"reason": reason}) for reason in self._refused]
        did = WorkReport(
            events=events,
            used=control.used,
            idle=control.idle,
            settled=self._node.negotiator.settled,
            heard=self._heard,
            refused_at_once=tuple(self._refused),
            refused_by_team=control.refused_orders,
            ways_closed=0 if self._ground is None else self._ground.ways_closed,
        )
        self._refused.clear()
        if did != self._reported:
            self._reported = replace(did, events=[], refused_at_once=())
            self._context.pipe.send(did)

    def _steer(self, steer: SteerCommand) -> None:
        """Store what the robot has begun, which it must know after a restart; then send way points to the body."""
        self._node.keep()
        self._context.pipe.send(steer)

    def _sense(self, sense: BodyState) -> None:
        self._now_s = sense.now_s
        if self._control is None:
            context = self._context
            self._port = PipePort(context.robot, self._steer, sense.orders, sense.telemetry)
            self._control = RobotControl(
                context.problem,
                self._port,
                self._node.negotiator,
                sense.now_s,
                sense.used,
                context.setup.speed,
                self._ground,
            )
        else:
            self._port.said = sense.telemetry


def _all_of(get: Callable[[], object]) -> list[object]:
    messages = []
    while True:
        try:
            messages.append(get())
        except Empty:
            return messages
