"""The set of facts that a robot knows: tasks done, begun at most once, added, moved, cancelled ... It only grows.

Sets are joined in any order. Robots with equal digests know the same facts.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass, field
from hashlib import blake2b

from muster_team.knowledge.joint_statements import parts_of_deeds
from muster_team.knowledge.messages import Fact
from muster_team.knowledge.signatures import NO_KEYS, Signatures

AT_ONCE = 40
"""The largest number of facts in a repair. A robot that lacks more asks again and receives others."""


UNHEARD = 10_000
"""More facts than a robot may know of without knowing those that came before them."""


@dataclass
class Knowledge:
    """The facts that one robot knows."""

    facts: set[Fact] = field(default_factory=set)
    digest: int = 0
    signatures: Signatures = NO_KEYS
    _deeds_at: int = 0  # the digest for which these deeds were found
    _deeds_found: dict[str, list[tuple[Fact, ...]]] = field(default_factory=dict)

    def learn(self, facts: Iterable[Fact]) -> list[Fact]:
        """Add facts; return those that were new."""
        new = [fact for fact in facts if fact not in self.facts]
        for fact in new:
            if fact not in self.facts:
                self.facts.add(fact)
                self.digest ^= _hash(fact)
        return new

    def say(self, task: str, robot: str, kind: str, content: bytes = b"") -> tuple[Fact, bool]:
        """Add a fact that the robot itself states, once; return the fact and whether it is new."""
        for fact in in_order(self.facts):
            if (fact.task, fact.robot, fact.kind, fact.content) == (task, robot, kind, content):
                return fact, False
        return self.add(task, robot, kind, content), True

    def add(self, task: str, robot: str, kind: str, content: bytes = b"") -> Fact:
        """Add a fact stated by the robot itself, ordered after all facts that it knows.

        An order far above the number of facts is no robot's that counts them: it leaves that of the others alone.
        """
        most = len(self.facts) + UNHEARD
        said = Fact(task, robot, kind, 1 + max((f.order for f in self.facts if f.order <= most), default=0), content)
        said = self.signatures.sign(said)
        self.learn([said])
        return said

    @property
    def done(self) -> set[str]:
        return set(self._deeds)

    @property
    def twice(self) -> dict[str, tuple[str, ...]]:
        """Tasks that were done more than once, with all that have done them."""
        return {task: _robots(found) for task, found in self._deeds.items() if len(found) > 1}

    def is_done_by(self, task: str, part: bytes) -> bool:
        """Whether a task is done as all robots of a team have stated this part."""
        return any(found[0].content == part for found in self._deeds.get(task, ()) if found[0].kind == "part")

    @property
    def _deeds(self) -> dict[str, list[tuple[Fact, ...]]]:
        if self._deeds_at != self.digest:
            self._deeds_at, self._deeds_found = self.digest, deeds(self.facts)
        return self._deeds_found

    def some(self, number: int) -> tuple[Fact, ...]:
        """At most AT_ONCE facts; another number gives other facts."""
        facts = in_order(self.facts)
        if len(facts) <= AT_ONCE:
            return facts
        first = number * AT_ONCE % len(facts)
        return (*facts, *facts)[first : first + AT_ONCE]


def in_order(facts: Iterable[Fact]) -> tuple[Fact, ...]:
    """Facts in causal order: a fact comes after all facts that its author knew."""
    return tuple(sorted(facts, key=lambda fact: (fact.order, fact.robot, fact.task, fact.kind, fact.content)))


def deeds(facts: Iterable[Fact]) -> dict[str, list[tuple[Fact, ...]]]:
    """For each task that was done the facts by which it is, for each time that it was: the first time first.

    One robot states that it has done a task; of a team each robot states its part, and the task is done when all have.
    """
    facts = in_order(facts)
    times: list[tuple[str, tuple[Fact, ...]]] = [(fact.task, (fact,)) for fact in facts if fact.done]
    times += [(task, parts) for (task, _), parts in parts_of_deeds(facts).items()]
    found: dict[str, list[tuple[Fact, ...]]] = {}
    for task, by in sorted(times, key=lambda deed: (deed[1][-1].order, deed[1][-1].robot)):
        found.setdefault(task, []).append(by)
    return found


def _robots(found: Iterable[tuple[Fact, ...]]) -> tuple[str, ...]:
    return tuple(dict.fromkeys(fact.robot for facts in found for fact in facts))


def holders(facts: Iterable[Fact]) -> dict[str, tuple[str, ...]]:
    """For each at-most-once task the robots that may have begun it, the first one first.

    A robot waives a task for the incarnation that announced it, since a later incarnation may not know what that one
    did.
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
