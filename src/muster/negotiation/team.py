"""A whole team on this machine, a process a robot: started, watched, and ended, whatever happens."""

from __future__ import annotations

import os
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
from muster.mission.interrupts import ctrl_c_held_back
from muster.negotiation.members import Patience
from muster.negotiation.optional_parts import require_net
from muster.negotiation.process_reports import GO, SHOW, Born, Failed, Gone, News, Order, Ready
from muster.negotiation.robot_view import View

_ENDING_S = 3.0
_BORN_S = 0.05


class Team:
    """Processes of robots that hold an auction. A context manager: none of them outlives it.

    `on_word` is told all that a robot says beside how far it is.

    Attributes
    ----------
    pids
        by robot its process; of one that has started again, the last.
    news
        by robot the last it has told.
    gone
        by robot why its process has ended, if it has not started again.
    began_s
        when all were ready and the auction began, by the monotonic clock; None before.

    Raises
    ------
    MissingExtraError
        if the extra `net` is not installed.
    MusterError
        from `hear`, if a robot cannot take part at all.
    """

    def __init__(self, order: Order, on_word: Callable[[str, object], None] = lambda robot, word: None) -> None:
        require_net("cryptography", "msgpack", *(("zenoh",) if order.transport == "zenoh" else ()))
        self.robots = [robot.id for robot in order.problem.mission.robots]
        self.news: dict[str, News] = {}
        self.gone: dict[str, str] = {}
        self.began_s: float | None = None
        self._ready: set[str] = set()
        self._order, self._on_word = order, on_word
        self._life = {robot: 1 for robot in self.robots if robot not in order.late}  # of those that have started
        self._born: dict[tuple[str, int], int] = {}
        self._pipes: dict[str, Connection] = {}  # of those that live
        self._unborn: dict[tuple[str, int], Connection] = {}  # seats that are not taken yet

    def __enter__(self) -> Team:
        self._nursery_pipe, theirs = Pipe()
        seats = self._order.seats
        pairs = [Pipe() for _ in seats]
        ends = [theirs, *(end for _, end in pairs)]
        descriptors = [end.fileno() for end in ends]
        with ctrl_c_held_back():
            self._nursery = subprocess.Popen(
                [sys.executable, "-m", "muster.negotiation.process_factory", *map(str, descriptors)],
                pass_fds=descriptors,
            )
        for end in ends:
            end.close()
        self._unborn = {seat: pipe for seat, (pipe, _) in zip(seats, pairs, strict=True)}
        self._pipes = {robot: self._unborn.pop((robot, 1)) for robot in self._life}
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
        for pipe in (*self._pipes.values(), *self._unborn.values(), self._nursery_pipe):
            pipe.close()  # who has not ended yet hears that
        try:
            self._nursery.wait(_ENDING_S)
        except subprocess.TimeoutExpired:
            self._kill_all()
        finally:
            self._nursery.kill()
            self._nursery.wait()

    @property
    def pids(self) -> dict[str, int]:
        return {robot: pid for (robot, life), pid in self._born.items() if life == self._life.get(robot)}

    @property
    def living(self) -> list[str]:
        """Robots that have started, and whose processes have not ended."""
        return [robot for robot in self.robots if robot in self._life and robot not in self.gone]

    def may_start(self, robot: str) -> bool:
        """Whether the order has one more life for a robot."""
        return (robot, self._life.get(robot, 0) + 1) in self._unborn

    def start(self, robot: str) -> None:
        """Start a robot that comes late, or one more time.

        Raises
        ------
        KeyError
            if the order has no life for that.
        """
        self._life[robot] = life = self._life.get(robot, 0) + 1
        self._pipes[robot] = self._unborn.pop((robot, life))
        self.gone.pop(robot, None)
        self.news.pop(robot, None)
        self.tell(robot, GO)

    def kill(self, robot: str) -> None:
        """End a robot's process, in the middle of whatever it does."""
        while robot not in self.pids:  # it has just been started
            self.hear(_BORN_S)
        with suppress(ProcessLookupError):
            os.kill(self.pids[robot], signal.SIGKILL)

    def tell(self, robot: str, word: object) -> None:
        """Say something to a robot; nothing if it has just ended."""
        if robot in self._pipes:
            with suppress(OSError):
                self._pipes[robot].send(word)

    def hear(self, wait_s: float) -> None:
        """Take in all that robots have told; waits for the first word for so long at most."""
        ends: dict[object, str | None] = {pipe: robot for robot, pipe in self._pipes.items()}
        for end in wait([self._nursery_pipe, *self._pipes.values()], wait_s):
            robot = ends.get(end)
            if robot is None:
                self._hear_nursery()
            else:
                self._hear_out(robot)
        if self.began_s is None and self._ready.issuperset(self._life):
            self.began_s = time.monotonic()
            for robot in self._life:
                self.tell(robot, GO)

    def agreement(self, wait_s: float = 5.0) -> dict[str, View] | None:
        """What each living robot knows, if all know the same and are alone with each other; else None."""
        if not self.living:
            raise MusterError(f"no robot is left: {self.robots[-1]} {self.gone[self.robots[-1]]}")
        if not self.agree(self.living):
            return None
        views = self.views(self.living, wait_s)
        stages, living = {view.stage for view in views.values()}, self.living
        return views if len(views) == len(living) and len(stages) == 1 and self.agree(living) else None

    def views(self, robots: Collection[str], wait_s: float = 5.0) -> dict[str, View]:
        """What robots know, of those that live and say so in time; all of them have been heard."""
        for robot in robots:
            self.news[robot] = replace(self.news[robot], view=None)
            self.tell(robot, SHOW)
        until_s = time.monotonic() + wait_s
        while any(self._owes_view(robot) for robot in robots) and time.monotonic() < until_s:
            self.hear(0.1)
        return {robot: view for robot in robots if robot in self.news and (view := self.news[robot].view) is not None}

    def _owes_view(self, robot: str) -> bool:
        return robot not in self.gone and robot in self.news and self.news[robot].view is None

    def agree(self, robots: Collection[str]) -> bool:
        """Whether these robots take each other, and nobody else, for members, and are at the same end."""
        if any(robot not in self.news for robot in robots):
            return False
        stages = {self.news[robot].stage for robot in robots}
        told = [self.news[robot].status for robot in robots]
        return len(stages) == 1 and all(status.settled and set(status.members) == set(robots) for status in told)

    def _hear_nursery(self) -> None:
        try:
            word = self._nursery_pipe.recv()
        except (EOFError, OSError):
            raise MusterError("the process that starts the robots has ended; expected it to stay") from None
        if isinstance(word, Born):
            self._born[word.robot, word.life] = word.pid
        elif isinstance(word, Gone) and word.life == self._life.get(word.robot):
            self._lose(word.robot, word.why)

    def _hear_out(self, robot: str) -> None:
        """Take in all that a robot has told, if it has not ended."""
        while robot in self._pipes and self._pipes[robot].poll():
            self._hear_robot(robot)

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
        else:
            self._on_word(robot, word)

    def _kill_all(self) -> None:
        for robot in self.living:
            if robot in self.pids:
                self.kill(robot)

    def _lose(self, robot: str, why: str) -> None:
        self._hear_out(robot)  # its last words may tell more than its end
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
    return replace(order, problem=replace(problem, known=problem.measured, mapped=problem.roads))
