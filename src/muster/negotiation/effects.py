"""What a negotiator tells its process: messages to send, what happened, what to remember, and counts."""

from __future__ import annotations

from collections.abc import Collection, Mapping
from dataclasses import dataclass

from muster.negotiation.messages import Claim, Fact, Message


@dataclass(frozen=True, slots=True)
class Outgoing:
    """A message to one robot; None: to all."""

    message: Message
    to: str | None = None


@dataclass(frozen=True, slots=True)
class Happening:
    """Something that a robot noticed.

    Parameters
    ----------
    kind
        "silent": robots take part no longer. "back": they do again. "anew": one has started anew. "mute": one is heard,
        but keeps the others waiting, and is left out. "rival": another process has this robot's name. "renumbered":
        this robot has taken a higher incarnation, as the others knew a later one than its clock gave it. "dropped": the
        robot has lost a task that it owned, as another owns it, or it cannot be done any more. "twice": the robots have
        all begun or done the task.
    robots, task
        whose and what; without a task "".
    """

    kind: str
    robots: tuple[str, ...]
    task: str = ""


class Diary(list[Happening]):
    """What a robot noticed, in order."""

    def tell(self, kind: str, robots: Collection[str]) -> None:
        """Of these robots, if there are any."""
        if robots:
            self.append(Happening(kind, tuple(robots)))

    def tell_each(self, kind: str, robots: Collection[str]) -> None:
        self.extend(Happening(kind, (robot,)) for robot in robots)

    def tell_twice(self, twice: Mapping[str, tuple[str, ...]]) -> None:
        """Tasks that several have begun or done, with these; each is told once."""
        for happening in (Happening("twice", robots, task) for task, robots in twice.items()):
            if happening not in self:
                self.append(happening)


@dataclass(frozen=True, slots=True)
class Memory:
    """What a robot keeps to start again where it stopped.

    Parameters
    ----------
    claims, facts
        what it owns, and what it knows for good.
    epoch
        the last that it has entered: it never declares in it again.
    knows
        whether it knows all that it ever said.
    refused
        tasks for which it does not bid.
    reserved
        facts by which it has said that it is going to begin tasks for good.
    """

    claims: tuple[Claim, ...] = ()
    facts: tuple[Fact, ...] = ()
    epoch: int = 0
    knows: bool = True
    refused: frozenset[str] = frozenset()
    reserved: tuple[Fact, ...] = ()


@dataclass
class Counts:
    """What a robot has sent: messages with something new of its own, repairs of what others lacked, idle beats."""

    news: int = 0
    repairs: int = 0
    beats: int = 0
