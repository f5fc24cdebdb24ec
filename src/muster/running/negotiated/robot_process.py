"""The process of a robot that decides for itself: its part in the auction, and a pilot for its body."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import replace
from queue import Empty

from muster.mission.model import Event
from muster.motion.port import Telemetry, Waypoint
from muster.negotiation.node import Node
from muster.negotiation.process_reports import Ready
from muster.negotiation.team_process import Orders, Seat, Teller
from muster.running.negotiated.pipe_messages import Befalls, Did, Radio, Sense, Steer
from muster.running.negotiated.robot_control import Pilot

_STEP_S = 0.02
"""How often at least the robot looks what its body says."""


def decide_for_itself(seat: Seat) -> None:
    """Take part, and do what it owns, until the starter has seen enough."""
    orders, teller = Orders(seat.pipe), Teller(seat.pipe)
    if seat.comes_late:
        orders.go.wait()
    with seat.node() as node:
        robot = Being(seat, node)
        if not seat.comes_late:
            seat.pipe.send(Ready())
            orders.go.wait()
        while not orders.leave.is_set():
            node.step(_STEP_S)
            robot.hear(_all_of(orders.words.get_nowait))
            robot.go_on()
            teller.tell(node, orders)


class PipePort:
    """The body of a robot at the other end of a pipe; a `RobotPort`."""

    def __init__(self, robot: str, steer: Callable[[Steer], None], orders: int, said: Telemetry) -> None:
        self._robot, self._steer, self._orders = robot, steer, orders
        self.said = said

    @property
    def robot(self) -> str:
        return self._robot

    def send(self, waypoints: Sequence[Waypoint]) -> int:
        self._orders += 1
        self._steer(Steer(tuple(waypoints)))
        return self._orders

    def cancel(self) -> int:
        return self.send(())

    def telemetry(self) -> Telemetry | None:
        return self.said


class Being:
    """What the process does beside the auction."""

    def __init__(self, seat: Seat, node: Node) -> None:
        self._seat, self._node = seat, node
        self._pilot: Pilot | None = None
        self._now_s = 0.0
        self._heard = 0
        self._befallen: list[Event] = []
        self._refused: list[str] = []
        self._told: Did | None = None

    def hear(self, words: Sequence[object]) -> None:
        for word in words:
            if isinstance(word, Sense):
                self._sense(word)
            elif isinstance(word, Radio):
                self._node.in_reach = word.on
            elif isinstance(word, Befalls):
                self._befallen.append(word.event)

    def go_on(self) -> None:
        """Do what there is to do, and tell what was done."""
        pilot = self._pilot
        if pilot is None:
            return
        for event in self._befallen:
            self._heard += 1
            why_not = pilot.befalls(event)
            self._refused += [] if why_not is None else [why_not]
        self._befallen.clear()
        events = [(event.time_s, event.kind, event.data) for event in pilot.tick(self._now_s)]
        events += [(self._now_s, "event_refused", {"reason": reason}) for reason in self._refused]
        self._refused.clear()
        did = Did(
            events=events,
            used=pilot.used,
            usages={str(data["task"]): pilot.usage(data["task"]) for _, kind, data in events if kind == "ends"},
            idle=pilot.idle,
            settled=self._node.negotiator.settled,
            heard=self._heard,
        )
        if did != self._told:
            self._told = replace(did, events=[], usages={})
            self._seat.pipe.send(did)

    def _steer(self, steer: Steer) -> None:
        """Steer the body, after what the robot has begun by that is kept: in its next life it must know."""
        self._node.keep()
        self._seat.pipe.send(steer)

    def _sense(self, sense: Sense) -> None:
        self._now_s = sense.now_s
        if self._pilot is None:
            seat = self._seat
            self._port = PipePort(seat.robot, self._steer, sense.orders, sense.telemetry)
            self._pilot = Pilot(seat.problem, self._port, self._node.negotiator, sense.now_s, sense.used)
        else:
            self._port.said = sense.telemetry


def _all_of(get: Callable[[], object]) -> list[object]:
    words = []
    while True:
        try:
            words.append(get())
        except Empty:
            return words
