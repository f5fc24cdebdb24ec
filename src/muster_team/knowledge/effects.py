"""The outputs of a negotiator for its process: messages to send, notices, the memory to store, message counts."""

from __future__ import annotations

from collections import Counter
from collections.abc import Collection, Mapping
from dataclasses import dataclass, field

from muster_team.knowledge.messages import Claim, Fact, Message


@dataclass(frozen=True, slots=True)
class Outgoing:
    """A message and the robot that it is for; None: all robots."""

    message: Message
    to: str | None = None


@dataclass(frozen=True, slots=True)
class Notice:
    """Something that a robot noticed.

    Parameters
    ----------
    kind
        "silent": robots no longer take part. "back": robots take part again. "restarted": a robot has restarted.
        "unresponsive": a robot is heard but delays the others, and is excluded. "rival": another process uses this
        robot's id. "renumbered": this robot has taken a higher incarnation, as the others knew a later one than its
        clock gave it. "refused": a robot has sent what is not admitted. "revoked": a robot is excluded
        for good; the reason says why. "dropped": the robot has lost a task that it owned, as another robot owns it
        or it cannot be done any more. "twice": these robots have all begun or done the task. "differs": a
        robot computes other routes from what was sold, so that all state their own again.
    robots, task
        the robots and the task concerned; "" without a task.
    reason
        why something was refused, or a robot excluded for good; "" otherwise.
    """

    kind: str
    robots: tuple[str, ...]
    task: str = ""
    reason: str = ""


REASONS = 100
"""The number of reasons for refusals that a robot tells and counts by sender; all are counted."""


class Notices(list[Notice]):
    """The notices of one robot, in order."""

    def tell(self, kind: str, robots: Collection[str]) -> None:
        """Add one notice about these robots, unless there are none."""
        if robots:
            self.append(Notice(kind, tuple(robots)))

    def tell_each(self, kind: str, robots: Collection[str]) -> None:
        self.extend(Notice(kind, (robot,)) for robot in robots)

    def tell_twice(self, twice: Mapping[str, tuple[str, ...]]) -> None:
        """Add a notice for each task that several robots have begun or done, once."""
        for happening in (Notice("twice", robots, task) for task, robots in twice.items()):
            if happening not in self:
                self.append(happening)

    def tell_refused(self, sender: str, reason: str) -> None:
        """Add a notice of what was refused from a sender, once for each reason, and at most REASONS in all."""
        notice = Notice("refused", (sender,), reason=reason)
        if notice not in self and sum(other.kind == "refused" for other in self) < REASONS:
            self.append(notice)


@dataclass(frozen=True, slots=True)
class Memory:
    """What a robot stores to continue after a restart.

    Parameters
    ----------
    claims, facts
        the tasks that it owns, and all facts that it knows.
    epoch
        the last epoch that it has entered; it never declares in that epoch again.
    knows
        whether it knows everything that it has ever stated.
    refused
        tasks for which it does not bid.
    reserved
        the facts by which it has announced that it is going to begin at-most-once tasks.
    """

    claims: tuple[Claim, ...] = ()
    facts: tuple[Fact, ...] = ()
    epoch: int = 0
    knows: bool = True
    refused: frozenset[str] = frozenset()
    reserved: tuple[Fact, ...] = ()


@dataclass
class Counts:
    """Numbers of messages sent: with news of the sender, repairs of what others lacked, idle heartbeats.

    `refused`: for each sender and reason how many messages, or parts of them, were not admitted.
    """

    news: int = 0
    repairs: int = 0
    heartbeats: int = 0
    refused: Counter[tuple[str, str]] = field(default_factory=Counter)

    def refuse(self, sender: str, reason: str) -> None:
        """Count what was refused; beyond REASONS different ones under no sender and reason, so that counts stay few."""
        is_new = (sender, reason) not in self.refused
        self.refused[("", "") if is_new and len(self.refused) >= REASONS else (sender, reason)] += 1
