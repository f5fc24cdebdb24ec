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

from muster.mission.errors import MusterError
from muster.negotiation.process_reports import Born, Failed, Gone, Order
from muster.negotiation.team_process import CLOSING_S, HERE, Seat, hold_auction

_LOOK_S = 0.02


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
    gc.freeze()  # what all share stays shared
    pids = {}
    for (robot, life), pipe in zip(order.seats, pipes, strict=True):
        pid = os.fork()
        if pid == 0:
            for other in (starter, *pipes):
                if other is not pipe:
                    other.close()
            _be(Seat(robot, life, order, problem, ports, pipe))
        pids[pid] = robot, life
        if not _tell(starter, Born(robot, life, pid)):
            break
    for pipe in pipes:
        pipe.close()
    ending = threading.Thread(target=_end_with, args=(starter, pids))
    ending.start()
    while pids:
        pid, status = os.wait()
        _tell(starter, Gone(*pids.pop(pid), _cause(status)))
    ending.join()


def _tell(starter: Connection, word: Born | Gone | Failed) -> bool:
    """Whether the starter is still there. If it is not, the robots end, each by itself."""
    with suppress(OSError):
        starter.send(word)
        return True
    return False


def _end_with(starter: Connection, pids: Mapping[int, tuple[str, int]]) -> None:
    try:
        starter.recv()
    except (EOFError, OSError):
        until_s = time.monotonic() + CLOSING_S  # robots notice by themselves; not one that was stopped
        while pids and time.monotonic() < until_s:
            time.sleep(_LOOK_S)
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
            each.bind((HERE, 0))
        return [each.getsockname()[1] for each in sockets]


def _be(seat: Seat) -> None:
    """The rest of a robot's process."""
    code = 0
    try:
        (seat.order.part or hold_auction)(seat)
    except OSError as error:  # the starter has ended
        code = 0 if isinstance(error, BrokenPipeError) else _failed(seat.pipe, str(error))
    except MusterError as error:
        code = _failed(seat.pipe, str(error))
    except Exception as error:
        code = _failed(seat.pipe, f"internal error: {type(error).__name__}: {error}")
    finally:
        os._exit(code)


def _failed(pipe: Connection, why: str) -> int:
    _tell(pipe, Failed(why))
    return 2


if __name__ == "__main__":
    main()
