"""A whole team on this machine, a process a robot: started, watched, and ended, whatever happens."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
import time
from contextlib import suppress
from dataclasses import replace
from multiprocessing import Pipe
from multiprocessing.connection import Connection, wait
from types import TracebackType

from muster.mission.errors import MusterError
from muster.mission.interrupts import ctrl_c_held_back
from muster.negotiation.extra import require_net
from muster.negotiation.members import Patience
from muster.negotiation.view import View
from muster.negotiation.watch import GO, SHOW, Born, Failed, Gone, News, Order, Ready

_ENDING_S = 3.0


class Team:
    """Processes of robots that hold an auction. A context manager: none of them outlives it.

    Attributes
    ----------
    pids
        by robot its process.
    news
        by robot the last it has told.
    gone
        by robot why its process has ended.
    began_s
        when all were ready and the auction began, by the monotonic clock; None before.

    Raises
    ------
    MissingExtraError
        if the extra `net` is not installed.
    MusterError
        from `hear`, if a robot cannot take part at all.
    """

    def __init__(self, order: Order) -> None:
        require_net()
        self.robots = [robot.id for robot in order.problem.mission.robots]
        self.pids: dict[str, int] = {}
        self.news: dict[str, News] = {}
        self.gone: dict[str, str] = {}
        self.began_s: float | None = None
        self._ready: set[str] = set()
        self._order = order

    def __enter__(self) -> Team:
        self._nursery_pipe, theirs = Pipe()
        pairs = [Pipe() for _ in self.robots]
        ends = [theirs, *(end for _, end in pairs)]
        descriptors = [end.fileno() for end in ends]
        with ctrl_c_held_back():
            self._nursery = subprocess.Popen(
                [sys.executable, "-m", "muster.negotiation.nursery", *map(str, descriptors)], pass_fds=descriptors
            )
        for end in ends:
            end.close()
        self._pipes: dict[str, Connection] = {r: pipe for r, (pipe, _) in zip(self.robots, pairs, strict=True)}
        try:
            self._nursery_pipe.send(_light(self._order))
        except BaseException:
            self.__exit__(*sys.exc_info())
            raise
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        if kind is not None:
            self._kill_all()
        for pipe in (*self._pipes.values(), self._nursery_pipe):
            pipe.close()  # who has not ended yet hears that
        try:
            self._nursery.wait(_ENDING_S)
        except subprocess.TimeoutExpired:
            self._kill_all()
        finally:
            self._nursery.kill()
            self._nursery.wait()

    @property
    def living(self) -> list[str]:
        """Robots whose processes have not ended."""
        return [robot for robot in self.robots if robot not in self.gone]

    def hear(self, wait_s: float) -> None:
        """Take in what robots tell; waits for the first word for so long at most."""
        ends: dict[object, str | None] = {pipe: robot for robot, pipe in self._pipes.items()}
        for end in wait([self._nursery_pipe, *self._pipes.values()], wait_s):
            robot = ends.get(end)
            if robot is None:
                self._hear_nursery()
            elif robot in self._pipes:  # else the nursery has just told of its end
                self._hear_robot(robot)
        if self.began_s is None and self._ready == set(self.robots):
            self.began_s = time.monotonic()
            self._tell(GO)

    def agreement(self, wait_s: float = 5.0) -> dict[str, View] | None:
        """What each living robot knows, if all know the same and are alone with each other; else None."""
        if not self._agree():
            return None
        self.news = {robot: replace(news, view=None) for robot, news in self.news.items()}
        self._tell(SHOW)
        until_s = time.monotonic() + wait_s
        while any(self.news[robot].view is None for robot in self.living) and time.monotonic() < until_s:
            self.hear(0.1)
        views = {robot: view for robot in self.living if (view := self.news[robot].view) is not None}
        stages = {view.stage for view in views.values()}
        return views if len(views) == len(self.living) and len(stages) == 1 and self._agree() else None

    def _agree(self) -> bool:
        """Whether all that live take all that live, and nobody else, for members, and are at the same end."""
        living = self.living
        if not living:
            raise MusterError(f"no robot is left: {self.robots[-1]} {self.gone[self.robots[-1]]}")
        if any(robot not in self.news for robot in living):
            return False
        stages = {self.news[robot].stage for robot in living}
        told = [self.news[robot].status for robot in living]
        return len(stages) == 1 and all(status.settled and set(status.members) == set(living) for status in told)

    def _tell(self, command: str) -> None:
        for pipe in self._pipes.values():
            with suppress(OSError):  # if it has just ended; that is heard next
                pipe.send(command)

    def _hear_nursery(self) -> None:
        try:
            word = self._nursery_pipe.recv()
        except (EOFError, OSError):
            raise MusterError("the process that starts the robots has ended; expected it to stay") from None
        if isinstance(word, Born):
            self.pids[word.robot] = word.pid
        elif isinstance(word, Gone):
            self._lose(word.robot, word.why)

    def _hear_robot(self, robot: str) -> None:
        try:
            word = self._pipes[robot].recv()
        except (EOFError, OSError):
            self._pipes.pop(robot).close()  # why, the nursery tells
            return
        if isinstance(word, Ready):
            self._ready.add(robot)
        elif isinstance(word, Failed):
            raise MusterError(f"{robot}: {word.why}")
        elif isinstance(word, News):
            before = self.news.get(robot)
            self.news[robot] = replace(word, view=word.view if before is None else word.view or before.view)

    def _kill_all(self) -> None:
        for robot in self.living:
            if robot in self.pids:
                with suppress(ProcessLookupError):
                    os.kill(self.pids[robot], signal.SIGKILL)

    def _lose(self, robot: str, why: str) -> None:
        while robot in self._pipes and self._pipes[robot].poll():  # its last words may tell more than its end
            self._hear_robot(robot)
        self.gone[robot] = why
        pipe = self._pipes.pop(robot, None)
        if pipe is not None:
            pipe.close()
        if self.began_s is None:
            raise MusterError(f"{robot}: {why} before the auction began; expected it to take part")


def patience_here(robots: int) -> Patience:
    """The patience of robots that share this machine: the more there are, the longer an answer takes.

    Robots that ask again too soon make each other slower still: 50 of them on two cores sent seven times what they had
    to, and took twice as long; and one that waits long for its turn on a core is not lost.
    """
    usual = Patience()
    return Patience(
        beat_s=max(usual.beat_s, 0.02 * robots),
        retry_s=max(usual.retry_s, 0.02 * robots),
        suspect_s=max(usual.suspect_s, 0.16 * robots),
        bid_s=max(usual.bid_s, 0.24 * robots),
        mute_s=max(usual.mute_s, 0.2 * robots),
    )


def _light(order: Order) -> Order:
    """The order with what was measured on a map, so that it need not be measured again."""
    problem = order.problem
    if problem.mission.travel_rule != "map":
        return order
    return replace(order, problem=replace(problem, known=problem.measured))
