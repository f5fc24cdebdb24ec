"""A whole team on this machine, one process per robot: started, observed and ended."""

from __future__ import annotations

import os
import select
import signal
import subprocess
import sys
import time
from collections.abc import Callable, Collection
from contextlib import suppress
from dataclasses import replace
from multiprocessing import Pipe
from multiprocessing.connection import Connection, wait
from types import TracebackType

from muster.mission.errors import MusterError
from muster.mission.system.interrupts import ctrl_c_held_back
from muster.mission.system.platforms import require_posix
from muster_team.membership.members import Timeouts
from muster_team.negotiators.robot_view import View
from muster_team.network.optional_parts import require_net
from muster_team.processes.process_reports import (
    GO,
    SHOW,
    Failed,
    ProcessEnded,
    ProcessStarted,
    Progress,
    Ready,
    TeamSetup,
)

_ENDING_S = 3.0
_START_POLL_S = 0.05


class Team:
    """The processes of robots that take part in an auction. A context manager: no process outlives it.

    `on_report` receives every report of a robot other than its progress.

    Attributes
    ----------
    pids
        the process of each robot; the last one of a robot that has restarted.
    progress
        the last progress report of each robot.
    ended
        for each robot whose process has ended without a restart the reason.
    began_s
        when all were ready and the auction began, on the monotonic clock; None before.

    Raises
    ------
    PlatformError
        on Windows.
    MissingExtraError
        if the extra `net` is not installed.
    MusterError
        from `poll`, if a robot cannot take part at all.
    """

    def __init__(self, setup: TeamSetup, on_report: Callable[[str, object], None] = lambda robot, report: None) -> None:
        require_posix("a team of processes, one a robot,")
        require_net("cryptography", "msgpack", *(("zenoh",) if setup.transport == "zenoh" else ()))
        self.robots = [robot.id for robot in setup.problem.mission.robots]
        self.progress: dict[str, Progress] = {}
        self.ended: dict[str, str] = {}
        self.began_s: float | None = None
        self._ready: set[str] = set()
        self._setup, self._on_report = setup, on_report
        self._starts = {robot: 1 for robot in self.robots if robot not in setup.late}  # of those that have started
        self._pids: dict[tuple[str, int], int] = {}
        self._pipes: dict[str, Connection] = {}  # of those that live
        self._spare_pipes: dict[tuple[str, int], Connection] = {}  # processes that are not taken yet
        self._waiting: dict[str, list[object]] = {}  # for robots that have not read what came before

    def __enter__(self) -> Team:
        self._factory_pipe, theirs = Pipe()
        processes = self._setup.processes
        pairs = [Pipe() for _ in processes]
        ends = [theirs, *(end for _, end in pairs)]
        descriptors = [end.fileno() for end in ends]
        with ctrl_c_held_back():
            self._factory = subprocess.Popen(
                [sys.executable, "-m", "muster_team.processes.process_factory", *map(str, descriptors)],
                pass_fds=descriptors,
            )
        for end in ends:
            end.close()
        self._spare_pipes = {context: pipe for context, (pipe, _) in zip(processes, pairs, strict=True)}
        self._pipes = {robot: self._spare_pipes.pop((robot, 1)) for robot in self._starts}
        try:
            self._factory_pipe.send(_with_measured_travel(self._setup))
        except BaseException:
            self.__exit__(*sys.exc_info())
            raise
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        if kind is not None:
            self._kill_all()
        for pipe in (*self._pipes.values(), *self._spare_pipes.values(), self._factory_pipe):
            pipe.close()  # ends processes that still run
        try:
            self._factory.wait(_ENDING_S)
        except subprocess.TimeoutExpired:
            self._kill_all()
        finally:
            self._factory.kill()
            self._factory.wait()

    @property
    def pids(self) -> dict[str, int]:
        return {
            robot: pid for (robot, start_number), pid in self._pids.items() if start_number == self._starts.get(robot)
        }

    @property
    def living(self) -> list[str]:
        """Robots that have started, and whose processes have not ended."""
        return [robot for robot in self.robots if robot in self._starts and robot not in self.ended]

    def may_start(self, robot: str) -> bool:
        """Whether the setup has another start of a robot."""
        return (robot, self._starts.get(robot, 0) + 1) in self._spare_pipes

    def start(self, robot: str) -> None:
        """Start a robot that joins late, or again.

        Raises
        ------
        KeyError
            if the setup has no such start.
        """
        self._starts[robot] = start_number = self._starts.get(robot, 0) + 1
        self._pipes[robot] = self._spare_pipes.pop((robot, start_number))
        self.ended.pop(robot, None)
        self.progress.pop(robot, None)
        self.send(robot, GO)

    def kill(self, robot: str) -> None:
        """Kill a robot's process."""
        while robot not in self.pids:  # it has just been started
            self.poll(_START_POLL_S)
        with suppress(ProcessLookupError):
            os.kill(self.pids[robot], signal.SIGKILL)

    def send(self, robot: str, report: object, *, latest: bool = False) -> None:
        """Send something to a robot; nothing if it has just ended.

        What a robot does not read waits for it, and holds up nobody. Of reports of a kind of which the `latest` is
        enough, no other waits.
        """
        if robot not in self._pipes:
            return
        waiting = self._waiting.setdefault(robot, [])
        if latest:
            waiting[:] = [other for other in waiting if type(other) is not type(report)]
        waiting.append(report)
        self._send_waiting(robot)

    def _send_waiting(self, robot: str) -> None:
        waiting = self._waiting.get(robot, [])
        with suppress(OSError):
            while waiting and robot in self._pipes and _has_room(self._pipes[robot]):
                self._pipes[robot].send(waiting.pop(0))

    def poll(self, wait_s: float) -> None:
        """Process all reports of robots; wait for the first one for at most `wait_s`."""
        for waits in list(self._waiting):
            self._send_waiting(waits)
        ends: dict[object, str | None] = {pipe: robot for robot, pipe in self._pipes.items()}
        for end in wait([self._factory_pipe, *self._pipes.values()], wait_s):
            robot = ends.get(end)
            if robot is None:
                self._take_factory_report()
            else:
                self._take_reports(robot)
        if self.began_s is None and self._ready.issuperset(self._starts):
            self.began_s = time.monotonic()
            for robot in self._starts:
                self.send(robot, GO)

    def agreement(self, wait_s: float = 5.0) -> dict[str, View] | None:
        """The view of each living robot, if all agree with each other and nobody else; else None."""
        if not self.living:
            raise MusterError(f"no robot is left: {self.robots[-1]} {self.ended[self.robots[-1]]}")
        if not self.agree(self.living):
            return None
        views = self.views(self.living, wait_s)
        stages, living = {view.stage for view in views.values()}, self.living
        return views if len(views) == len(living) and len(stages) == 1 and self.agree(living) else None

    def views(self, robots: Collection[str], wait_s: float = 5.0) -> dict[str, View]:
        """The views of robots that live and answer in time; each of them must have reported before."""
        for robot in robots:
            self.progress[robot] = replace(self.progress[robot], view=None)
            self.send(robot, SHOW)
        until_s = time.monotonic() + wait_s
        while any(self._owes_view(robot) for robot in robots) and time.monotonic() < until_s:
            self.poll(0.1)
        return {
            robot: view
            for robot in robots
            if robot in self.progress and (view := self.progress[robot].view) is not None
        }

    def _owes_view(self, robot: str) -> bool:
        return robot not in self.ended and robot in self.progress and self.progress[robot].view is None

    def agree(self, robots: Collection[str]) -> bool:
        """Whether these robots count each other, and nobody else, as members, and are at the same ended stage."""
        if any(robot not in self.progress for robot in robots):
            return False
        stages = {self.progress[robot].stage for robot in robots}
        told = [self.progress[robot].status for robot in robots]
        return len(stages) == 1 and all(status.settled and set(status.members) == set(robots) for status in told)

    def _take_factory_report(self) -> None:
        try:
            report = self._factory_pipe.recv()
        except (EOFError, OSError):
            raise MusterError("the process that starts the robots has ended; expected it to stay") from None
        if isinstance(report, ProcessStarted):
            self._pids[report.robot, report.start_number] = report.pid
        elif isinstance(report, ProcessEnded) and report.start_number == self._starts.get(report.robot):
            self._note_end(report.robot, report.why)

    def _take_reports(self, robot: str) -> None:
        """Process all reports of a robot, if it has not ended."""
        while robot in self._pipes and self._pipes[robot].poll():
            self._take_report(robot)

    def _take_report(self, robot: str) -> None:
        try:
            report = self._pipes[robot].recv()
        except (EOFError, OSError):
            self._pipes.pop(robot).close()  # the factory reports the reason
            return
        if isinstance(report, Ready):
            self._ready.add(robot)
        elif isinstance(report, Failed):
            raise MusterError(f"{robot}: {report.why}")
        elif isinstance(report, Progress):
            before = self.progress.get(robot)
            self.progress[robot] = replace(report, view=report.view if before is None else report.view or before.view)
        else:
            self._on_report(robot, report)

    def _kill_all(self) -> None:
        for robot in self.living:
            if robot in self.pids:
                self.kill(robot)

    def _note_end(self, robot: str, why: str) -> None:
        self._take_reports(robot)  # its last reports may contain more than the exit code
        self.ended[robot] = why
        pipe = self._pipes.pop(robot, None)
        self._waiting.pop(robot, None)
        if pipe is not None:
            pipe.close()
        if self.began_s is None:
            raise MusterError(f"{robot}: {why} before the auction began; expected it to take part")


def _has_room(pipe: Connection) -> bool:
    """Whether a message can be written at once: a socket counts as writable only while most of its buffer is free."""
    return bool(select.select([], [pipe], [], 0)[1])


def timeouts_for(robots: int) -> Timeouts:
    """Time limits for robots that share this machine: the more there are, the longer an answer takes.

    Robots that ask again too soon slow each other down: 50 of them on two cores sent seven times as many messages as
    necessary and took twice as long. A robot that waits for its turn on a core is not lost.
    """
    usual = Timeouts()
    return Timeouts(
        heartbeat_s=max(usual.heartbeat_s, 0.02 * robots),
        retry_s=max(usual.retry_s, 0.02 * robots),
        suspect_s=max(usual.suspect_s, 0.16 * robots),
        bid_s=max(usual.bid_s, 0.24 * robots),
        exclusion_s=max(usual.exclusion_s, 0.2 * robots),
    )


def _with_measured_travel(setup: TeamSetup) -> TeamSetup:
    """The setup with the travel measured over a map, so that it need not be measured again."""
    problem = setup.problem
    if not problem.has_paths:
        return setup
    return replace(setup, problem=replace(problem, known=problem.measured, mapped=problem.robot_paths))
