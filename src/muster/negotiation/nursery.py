"""Where the processes of a whole team come from: a fresh one that imports and compiles once, then forks each robot.

The one that started it may have threads, which a fork would tear apart; this one has none. Each robot has a pipe to the
starter: when that ends, by whatever cause, the pipe is closed, and the robot ends too.
"""

from __future__ import annotations

import gc
import os
import signal
import socket
import sys
import threading
import time
from collections.abc import Mapping
from contextlib import ExitStack, suppress
from multiprocessing.connection import Connection

from muster.allocation.problem import Problem
from muster.mission.errors import MusterError
from muster.negotiation.codec import Codec
from muster.negotiation.methods import method_named
from muster.negotiation.node import Node
from muster.negotiation.seal import Seal, mission_digest
from muster.negotiation.transport import Transport
from muster.negotiation.view import view_of
from muster.negotiation.watch import GO, SHOW, Born, Failed, Gone, News, Order, Ready

NEWS_EVERY_S = 0.1
_STEP_S = 0.05
_CLOSING_S = 1.0
_HERE = "127.0.0.1"
_ZENOH_ENTRANCES = 3
"""Robots whose address the others know; they hear of the rest from these."""


def main() -> None:
    """Start the robots that are ordered, and stay until the last has ended."""
    starter, *pipes = (Connection(int(descriptor)) for descriptor in sys.argv[1:])
    try:
        order: Order = starter.recv()
    except (EOFError, OSError):  # the starter has ended meanwhile
        return
    problem = order.problem.ready()
    robots = [robot.id for robot in problem.mission.robots]
    ports = dict(zip(robots, _free_ports(order.transport, len(robots)), strict=True))
    own = dict(zip(robots, pipes, strict=True))
    gc.freeze()  # what all share stays shared
    pids = {}
    for robot in robots:
        pid = os.fork()
        if pid == 0:
            starter.close()
            for other, pipe in own.items():
                if other != robot:
                    pipe.close()
            _be(robot, order, problem, ports, own[robot])
        pids[pid] = robot
        if not _tell(starter, Born(robot, pid)):
            break
    for pipe in pipes:
        pipe.close()
    threading.Thread(target=_end_with, args=(starter, pids), daemon=True).start()
    while pids:
        pid, status = os.wait()
        _tell(starter, Gone(pids.pop(pid), _cause(status)))


def _tell(starter: Connection, word: Born | Gone | Failed) -> bool:
    """Whether the starter is still there. If it is not, the robots end, each by itself."""
    with suppress(OSError):
        starter.send(word)
        return True
    return False


def _end_with(starter: Connection, pids: Mapping[int, str]) -> None:
    try:
        starter.recv()
    except (EOFError, OSError):
        time.sleep(_CLOSING_S)  # robots notice by themselves; not one that was stopped
        for pid in list(pids):
            os.kill(pid, signal.SIGKILL)


def _cause(status: int) -> str:
    code = os.waitstatus_to_exitcode(status)
    return f"killed by {signal.Signals(-code).name}" if code < 0 else f"ended with exit code {code}"


def _free_ports(transport: str, number: int) -> list[int]:
    """Ports of this machine that nobody has at this moment."""
    kind = socket.SOCK_DGRAM if transport == "udp" else socket.SOCK_STREAM
    with ExitStack() as held:
        sockets = [held.enter_context(socket.socket(socket.AF_INET, kind)) for _ in range(number)]
        for each in sockets:
            each.bind((_HERE, 0))
        return [each.getsockname()[1] for each in sockets]


def _be(robot: str, order: Order, problem: Problem, ports: Mapping[str, int], pipe: Connection) -> None:
    """The rest of a robot's process."""
    code = 0
    try:
        _take_part(robot, order, problem, ports, pipe)
    except OSError as error:  # the starter has ended
        code = 0 if isinstance(error, BrokenPipeError) else _failed(pipe, str(error))
    except MusterError as error:
        code = _failed(pipe, str(error))
    except Exception as error:
        code = _failed(pipe, f"internal error: {type(error).__name__}: {error}")
    finally:
        os._exit(code)


def _failed(pipe: Connection, why: str) -> int:
    _tell(pipe, Failed(why))
    return 2


def _take_part(robot: str, order: Order, problem: Problem, ports: Mapping[str, int], pipe: Connection) -> None:
    orders = _Orders(pipe)
    negotiator = method_named(order.method).negotiator(
        problem, order.terms, robot, incarnation=1, patience=order.patience
    )
    codec = Codec([robot.id for robot in problem.robots], [task.id for task in problem.tasks])
    seal = Seal(order.key, mission_digest(problem, order.terms), robot, 1)
    with Node(negotiator, _transport(robot, order, problem, ports), codec, seal) as node:
        pipe.send(Ready())
        orders.go.wait()
        told_s = 0.0
        while not orders.leave.is_set():
            node.step(_STEP_S)
            now_s = time.monotonic()
            asked = orders.show.is_set()
            if asked or now_s >= told_s + NEWS_EVERY_S:
                orders.show.clear()
                told_s = now_s
                pipe.send(News(node.status(), negotiator.stage, view_of(negotiator) if asked else None))


def _transport(robot: str, order: Order, problem: Problem, ports: Mapping[str, int]) -> Transport:
    if order.transport == "udp":
        from muster.negotiation.udp import UdpTransport

        return UdpTransport((_HERE, ports[robot]), {other: (_HERE, p) for other, p in ports.items() if other != robot})
    from muster.negotiation.zenoh_transport import ZenohTransport

    entrances = [f"tcp/{_HERE}:{p}" for other, p in list(ports.items())[:_ZENOH_ENTRANCES] if other != robot]
    name = problem.mission.name or "mission"
    return ZenohTransport(name, robot, connect=entrances, listen=(f"tcp/{_HERE}:{ports[robot]}",))


class _Orders:
    """What the starter wants; a thread listens to it, and ends the process soon after the starter has ended."""

    def __init__(self, pipe: Connection) -> None:
        self.go, self.show, self.leave = threading.Event(), threading.Event(), threading.Event()
        self._pipe = pipe
        threading.Thread(target=self._listen, daemon=True).start()

    def _listen(self) -> None:
        events = {GO: self.go, SHOW: self.show}
        try:
            while True:
                events[self._pipe.recv()].set()
        except (EOFError, OSError):
            self.leave.set()
            self.go.set()  # whoever waits for it goes, and leaves
            time.sleep(_CLOSING_S)
            os._exit(0)


if __name__ == "__main__":
    main()
