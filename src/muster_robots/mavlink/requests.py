"""Requests to a drone in order, each repeated until it is answered. Sans-I/O.

A script is a generator that yields what it asks and is given the answer. It ends, or raises `FaultError`.
"""

from __future__ import annotations

from collections.abc import Callable, Generator, Sequence
from dataclasses import dataclass
from typing import Any

from muster_robots.mavlink.dialect import Message
from muster_robots.mavlink.faults import FaultError, Kind


@dataclass(frozen=True)
class Request:
    """Something that is said until it is answered.

    Parameters
    ----------
    messages
        what is said, and said again after each time-out.
    answer
        of a message that is heard: the answer, or None if it is none.
    what
        for what, in words.
    within_s, tries
        how long an answer is waited for, and how often it is asked for.
    may_fail
        whether no answer is an answer, None, and no fault.
    """

    messages: Sequence[Message]
    answer: Callable[[Message], Any]
    what: str
    within_s: float = 1.5
    tries: int = 8
    may_fail: bool = False


Script = Generator[Request, Any, None]


def pause(seconds: float) -> Request:
    """Say nothing for a while."""
    return Request((), lambda message: None, "", seconds, 1, may_fail=True)


class RequestSequence:
    """A script that is under way.

    Parameters
    ----------
    script
        what is asked.
    say
        is given each message that is to be sent.
    now
        seconds of any clock that does not go back.
    """

    def __init__(self, script: Script, say: Callable[[Message], None], now: float) -> None:
        self._script, self._say = script, say
        self._ask: Request | None = None
        self._tries, self._due_s = 0, now
        self._go_on(None, now)

    @property
    def done(self) -> bool:
        """Whether the script has ended."""
        return self._ask is None

    def hear(self, message: Message, now: float) -> None:
        """Go on if this answers what was asked last."""
        answer = None if self._ask is None else self._ask.answer(message)
        if answer is not None:
            self._go_on(answer, now)

    def tick(self, now: float) -> None:
        """Ask again if that is due.

        Raises
        ------
        FaultError
            if it was asked often enough.
        """
        if self._ask is None or now < self._due_s:
            return
        if self._tries < self._ask.tries:
            self._say_it(now)
        elif self._ask.may_fail:
            self._go_on(None, now)
        else:
            raise FaultError(Kind.NO_ANSWER, f"{self._ask.what}: asked {self._tries} times")

    def _go_on(self, answer: Any, now: float) -> None:
        try:
            self._ask = self._script.send(answer)
        except StopIteration:
            self._ask = None
            return
        self._tries = 0
        self._say_it(now)

    def _say_it(self, now: float) -> None:
        assert self._ask is not None
        for message in self._ask.messages:
            self._say(message)
        self._tries += 1
        self._due_s = now + self._ask.within_s
