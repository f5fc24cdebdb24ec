"""What a robot does with the tasks that it owns: begin them, finish them, give them back; and what it says of that."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass, field, replace

from muster.mission.errors import ParameterError
from muster.mission.value_types import shown
from muster.negotiation.effects import Memory
from muster.negotiation.epoch import Epoch
from muster.negotiation.epoch_base import Base, Rules
from muster.negotiation.knowledge import Knowledge, in_order
from muster.negotiation.messages import Claim, Fact


@dataclass
class Work:
    """The work of one robot.

    Parameters
    ----------
    robot, incarnation
        its id, and how often it has started.
    known
        what it knows for good.
    begun, refused
        tasks that it has begun; for which it does not bid.
    reserved
        by task that it has said it is going to begin for good the fact that tells so.
    fresh
        facts that have not been sent yet.
    out
        whether it takes no tasks any more.
    restless
        whether the others must hear of a change at once: a new epoch is due.
    """

    robot: str
    incarnation: int = 0
    known: Knowledge = field(default_factory=Knowledge)
    begun: set[str] = field(default_factory=set)
    refused: set[str] = field(default_factory=set)
    reserved: dict[str, Fact] = field(default_factory=dict)
    fresh: list[Fact] = field(default_factory=list)
    out: bool = False
    restless: bool = False

    @classmethod
    def remembered(cls, robot: str, incarnation: int, memory: Memory) -> Work:
        begun = {claim.task for claim in memory.claims if claim.begun}
        reserved = {fact.task: fact for fact in memory.reserved}
        work = cls(robot, incarnation, begun=begun, refused=set(memory.refused), reserved=reserved)
        work.known.learn(memory.facts)
        return work

    def memory(self, claims: tuple[Claim, ...], epoch: int, *, knows: bool) -> Memory:
        facts, reserved = in_order(self.known.facts), in_order(self.reserved.values())
        return Memory(self.left_of(claims), facts, epoch, knows, frozenset(self.refused), reserved)

    def left_of(self, claims: Iterable[Claim]) -> tuple[Claim, ...]:
        """The claims that still hold, with what has been begun first."""
        done = self.known.done
        mine = [replace(c, begun=c.task in self.begun) for c in claims if c.task not in done or c.task in self.begun]
        kept = [claim for claim in mine if claim.begun or not (self.out or claim.task in self.refused)]
        return (*(claim for claim in kept if claim.begun), *(claim for claim in kept if not claim.begun))

    def up_to_date(self, epoch: Epoch) -> tuple[Claim, ...]:
        """What is left of an epoch's route without tasks that were heard to be elsewhere since it began."""
        knew = epoch.own.facts if epoch.base is None else epoch.base.facts
        moved = {fact.task for fact in self.known.facts.difference(knew) if fact.kind == "moved"}
        return tuple(claim for claim in self.left_of(epoch.route()) if claim.begun or claim.task not in moved)

    def say(self, task: str, kind: str, content: bytes = b"") -> Fact:
        """Say something that is true for good, once."""
        fact, is_new = self.known.say(task, self.robot, kind, content)
        self.fresh += [fact] if is_new else []
        return fact

    def say_again(self, task: str, kind: str, content: bytes) -> None:
        """The same of what may be said of a task more than once."""
        self.fresh.append(self.known.add(task, self.robot, kind, content))

    def may_begin(self, task: str, epoch: Epoch, shown: Iterable[str], rules: Rules) -> bool:
        """Whether the robot may begin a task that it owns in this epoch; `shown` are members that have its base."""
        base = epoch.base
        if base is None or not epoch.ended or task not in {claim.task for claim in self.left_of(epoch.route())}:
            return False
        if task in self.begun:
            return True
        rules = rules.with_added(base.added)
        if not self.known.done.issuperset(rules.prerequisites[task]):
            return False
        return task not in rules.once or self._is_reserved(task, base, epoch, shown, rules)

    def begin(self, task: str) -> None:
        self.begun.add(task)

    def reserve(self, task: str) -> None:
        """Say that the robot, in this incarnation, is going to begin a task that nobody may begin twice."""
        if task not in self.reserved:
            self.reserved[task] = self.say(task, "begun", str(self.incarnation).encode())

    def finish(self, task: str) -> None:
        self.begun.discard(task)
        self.say(task, "done")

    def abandon(self, task: str) -> None:
        if task in self.begun:
            self.begun.discard(task)
            self.restless = True

    def release(self, task: str, rules: Rules) -> None:
        if task in rules.once and task in self.begun:
            raise ParameterError(f"release: {shown(task)}; expected a task that may be begun again")
        self.begun.discard(task)
        self.give_up(task)

    def give_up(self, task: str) -> None:
        """Never bid for a task again."""
        if task in self.reserved:
            self.say(task, "waived", self.reserved.pop(task).content)
        self.refused.add(task)
        self.restless = True

    def withdraw(self) -> None:
        """Take no tasks any more, and give back all that has not been begun."""
        for task in self.reserved.keys() - self.begun:
            self.give_up(task)
        self.restless |= not self.out
        self.out = True

    def give_up_lost(self, kept: Sequence[Claim]) -> None:
        """Give up what was reserved and went to another before it was begun."""
        for task in self.reserved.keys() - self.begun - self.known.done - {claim.task for claim in kept}:
            self.give_up(task)

    def _is_reserved(self, task: str, base: Base, epoch: Epoch, shown: Iterable[str], rules: Rules) -> bool:
        """Whether a majority of the mission's robots knows that this one is going to begin the task."""
        tell = [declared for robot in shown if (declared := epoch.declaration_of(robot)) is not None]
        said = self.reserved.get(task) in base.facts
        return said and sum(declared.knows for declared in tell) >= rules.majority
