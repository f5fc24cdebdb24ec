"""Starts the processes of a team: a fresh process imports and compiles once, then forks one process per robot.

The starter may have threads, which do not survive a fork; this process has none. Each robot has a pipe to the starter.
When the starter ends for whatever reason, the pipe closes, and the robot's process ends too.
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
from muster_team.processes.process_reports import Failed, ProcessEnded, ProcessStarted, TeamSetup
from muster_team.processes.team_process import CLOSING_S, HERE, ProcessContext, run_auction

_LOOK_S = 0.02


def main() -> None:
    """Start the robots of a setup, and stay until the last one has ended."""
    starter, *pipes = (Connection(int(descriptor)) for descriptor in sys.argv[1:])
    try:
        setup: TeamSetup = starter.recv()
    except (EOFError, OSError):  # the starter has ended meanwhile
        return
    problem = setup.problem.ready()
    robots = [robot.id for robot in problem.mission.robots]
    ports = dict(zip(robots, _free_ports(setup.transport, len(robots)), strict=True))
    gc.freeze()  # what all share stays shared
    pids = {}
    for (robot, start_number), pipe in zip(setup.processes, pipes, strict=True):
        pid = os.fork()
        if pid == 0:
            for other in (starter, *pipes):
                if other is not pipe:
                    other.close()
            _run_robot(ProcessContext(robot, start_number, setup, problem, ports, pipe))
        pids[pid] = robot, start_number
        if not _send(starter, ProcessStarted(robot, start_number, pid)):
            break
    for pipe in pipes:
        pipe.close()
    ending = threading.Thread(target=_stop_with_starter, args=(starter, pids))
    ending.start()
    while pids:
        pid, status = os.wait()
        _send(starter, ProcessEnded(*pids.pop(pid), _exit_cause(status)))
    ending.join()


def _send(starter: Connection, report: ProcessStarted | ProcessEnded | Failed) -> bool:
    """Send a report; return whether the starter is still there. If not, the robots' processes end by themselves."""
    with suppress(OSError):
        starter.send(report)
        return True
    return False


def _stop_with_starter(starter: Connection, pids: Mapping[int, tuple[str, int]]) -> None:
    try:
        starter.recv()
    except (EOFError, OSError):
        until_s = time.monotonic() + CLOSING_S  # robots notice by themselves; not one that was stopped
        while pids and time.monotonic() < until_s:
            time.sleep(_LOOK_S)
        for pid in list(pids):
            os.kill(pid, signal.SIGKILL)


def _exit_cause(status: int) -> str:
    code = os.waitstatus_to_exitcode(status)
    return f"killed by {signal.Signals(-code).name}" if code < 0 else f"ended with exit code {code}"


def _free_ports(transport: str, number: int) -> list[int]:
    """Ports of this machine that are free at this moment."""
    kind = socket.SOCK_DGRAM if transport == "udp" else socket.SOCK_STREAM
    with ExitStack() as held:
        sockets = [held.enter_context(socket.socket(socket.AF_INET, kind)) for _ in range(number)]
        for each in sockets:
            each.bind((HERE, 0))
        return [each.getsockname()[1] for each in sockets]


def _run_robot(context: ProcessContext) -> None:
    """Run a robot's process to its end."""
    code = 0
    try:
        (context.setup.part or run_auction)(context)
    except OSError as error:  # the starter has ended
        code = 0 if isinstance(error, BrokenPipeError) else _failed(context.pipe, str(error))
    except MusterError as error:
        code = _failed(context.pipe, str(error))
    except Exception as error:
        code = _failed(context.pipe, f"internal error: {type(error).__name__}: {error}")
    finally:
        os._exit(code)


def _failed(pipe: Connection, why: str) -> int:
    _send(pipe, Failed(why))
    return 2


if __name__ == "__main__":
    main()
