"""What a robot knows for good: tasks done, begun for good, added, cancelled. It only grows, and order does not matter.

Robots whose digests are equal know the same; the digest is of the facts alone, not of the way in which they came.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass, field
from hashlib import blake2b

from muster.negotiation.messages import Fact

AT_ONCE = 40
"""So many facts go into a message at most; who lacks more asks again, and gets others."""


@dataclass
class Knowledge:
    """The facts that one robot knows."""

    facts: set[Fact] = field(default_factory=set)
    digest: int = 0

    def learn(self, facts: Iterable[Fact]) -> list[Fact]:
        """Take in facts; returns those that are new."""
        new = [fact for fact in facts if fact not in self.facts]
        for fact in new:
            if fact not in self.facts:
                self.facts.add(fact)
                self.digest ^= _hash(fact)
        return new

    def say(self, task: str, robot: str, kind: str, content: bytes = b"") -> tuple[Fact, bool]:
        """Add a fact of the robot itself, unless it has said so before; the fact, and whether it is new."""
        for fact in in_order(self.facts):
            if (fact.task, fact.robot, fact.kind, fact.content) == (task, robot, kind, content):
                return fact, False
        return self.add(task, robot, kind, content), True

    def add(self, task: str, robot: str, kind: str, content: bytes = b"") -> Fact:
        """Add a fact of the robot itself, which follows from all that it knows."""
        said = Fact(task, robot, kind, 1 + max((fact.order for fact in self.facts), default=0), content)
        self.learn([said])
        return said

    @property
    def done(self) -> set[str]:
        return {fact.task for fact in self.facts if fact.done}

    @property
    def doers(self) -> dict[str, tuple[str, ...]]:
        """By task that was done those that have done it, the first one first."""
        doers: dict[str, tuple[str, ...]] = {}
        for fact in in_order(self.facts):
            if fact.done:
                doers[fact.task] = (*doers.get(fact.task, ()), fact.robot)
        return doers

    def some(self, number: int) -> tuple[Fact, ...]:
        """At most AT_ONCE facts, others for the next number."""
        facts = in_order(self.facts)
        if len(facts) <= AT_ONCE:
            return facts
        first = number * AT_ONCE % len(facts)
        return (*facts, *facts)[first : first + AT_ONCE]


def in_order(facts: Iterable[Fact]) -> tuple[Fact, ...]:
    """Facts so that what follows from another comes after it."""
    return tuple(sorted(facts, key=lambda fact: (fact.order, fact.robot, fact.task, fact.kind)))


def holders(facts: Iterable[Fact]) -> dict[str, tuple[str, ...]]:
    """By task that nobody may begin twice the robots that may have begun it, the first one first.

    What a robot waives it waives for the life in which it said that it was going to begin: it may have forgotten that.
    """
    waived = {(fact.task, fact.robot, fact.content) for fact in facts if fact.kind == "waived"}
    may: dict[str, dict[str, None]] = {}
    for fact in in_order(facts):
        if fact.kind == "begun" and (fact.task, fact.robot, fact.content) not in waived:
            may.setdefault(fact.task, {})[fact.robot] = None
    return {task: tuple(robots) for task, robots in may.items()}


def _hash(fact: Fact) -> int:
    said = repr((fact.task, fact.robot, fact.kind, fact.order, fact.content)).encode()
    return int.from_bytes(blake2b(said, digest_size=7).digest(), "big")
