"""The tasks that a robot owns: begin, reserve, finish and release them, and the facts that it states about that."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass, field, replace

from muster.mission.errors import ParameterError
from muster.mission.value_types import shown
from muster_team.auctions.epoch import Epoch
from muster_team.knowledge.effects import Memory
from muster_team.knowledge.epoch_base import Base
from muster_team.knowledge.facts import Knowledge, in_order
from muster_team.knowledge.messages import Claim, Fact
from muster_team.knowledge.rules import Rules
from muster_team.knowledge.signatures import Signatures
from muster_team.negotiators.joint_starts import JointStarts


@dataclass
class OwnedTasks:
    """The tasks of one robot.

    Parameters
    ----------
    robot, incarnation
        its id, and the number of its start.
    known
        the facts that it knows.
    begun, refused
        tasks that it has begun; tasks for which it does not bid.
    reserved
        for each at-most-once task that it has announced to begin the fact that says so.
    unsent
        facts that have not been sent yet.
    withdrawn
        whether it takes no more tasks.
    epoch_due
        whether the others have to learn of a change at once, in a new epoch.
    offers, keeps
        whether it puts what it has not begun up for sale again in the next epoch, and bids for that like the others;
        and the task that it keeps of these.
    joint
        its part in tasks that several robots begin at the same moment. Such a task is never `begun`: it is kept as long
        as the team is, and given up with it.
    """

    robot: str
    incarnation: int = 0
    known: Knowledge = field(default_factory=Knowledge)
    begun: set[str] = field(default_factory=set)
    refused: set[str] = field(default_factory=set)
    reserved: dict[str, Fact] = field(default_factory=dict)
    unsent: list[Fact] = field(default_factory=list)
    withdrawn: bool = False
    epoch_due: bool = False
    offers: bool = False
    keeps: str = ""
    joint: JointStarts = field(init=False)

    def __post_init__(self) -> None:
        self.joint = JointStarts(self.robot, self.known, self.say)

    @classmethod
    def remembered(cls, robot: str, incarnation: int, memory: Memory, signatures: Signatures) -> OwnedTasks:
        begun = {claim.task for claim in memory.claims if claim.begun}
        reserved = {fact.task: fact for fact in memory.reserved}
        known = Knowledge(signatures=signatures)
        work = cls(robot, incarnation, known, begun=begun, refused=set(memory.refused), reserved=reserved)
        work.known.learn(memory.facts)
        return work

    def memory(self, claims: tuple[Claim, ...], epoch: int, *, knows: bool) -> Memory:
        facts, reserved = in_order(self.known.facts), in_order(self.reserved.values())
        return Memory(self.left_of(claims), facts, epoch, knows, frozenset(self.refused), reserved)

    def left_of(self, claims: Iterable[Claim]) -> tuple[Claim, ...]:
        """The claims that still hold; tasks that were begun come first, also those begun with others."""
        done, joint = self.known.done - self.joint.under_way.keys(), self.joint.under_way
        mine = [replace(c, begun=c.task in self.begun) for c in claims if c.task not in done or c.task in self.begun]
        kept = [claim for claim in mine if claim.begun or not (self.withdrawn or claim.task in self.refused)]
        return tuple(sorted(kept, key=lambda claim: not (claim.begun or claim.task in joint)))

    def up_to_date(self, epoch: Epoch) -> tuple[Claim, ...]:
        """The claims of an epoch that still hold, without tasks that are known since then to have moved."""
        knew = epoch.own.facts if epoch.base is None else epoch.base.facts
        moved = {fact.task for fact in self.known.facts.difference(knew) if fact.kind == "moved"}
        claims = self.left_of(epoch.route())
        if self.offers:
            moved.update(claim.task for claim in claims if claim.task not in {*self.reserved, self.keeps})
        moved -= self.joint.under_way.keys()
        return tuple(claim for claim in claims if claim.begun or claim.task not in moved)

    def say(self, task: str, kind: str, content: bytes = b"") -> Fact:
        """State a fact once."""
        fact, is_new = self.known.say(task, self.robot, kind, content)
        self.unsent += [fact] if is_new else []
        return fact

    def say_again(self, task: str, kind: str, content: bytes) -> None:
        """State a fact of a kind that may be stated several times of one task."""
        self.unsent.append(self.known.add(task, self.robot, kind, content))

    def may_begin(self, task: str, epoch: Epoch, shown: Iterable[str], rules: Rules) -> bool:
        """Whether the robot may begin a task that it owns in this epoch; `shown` are members that have its base."""
        base = epoch.base
        if base is None or not epoch.ended or task not in {claim.task for claim in self.left_of(epoch.route())}:
            return False
        if task in self.begun:
            return True
        rules = rules.with_added(base.added)
        if task in rules.joint:  # these begin by their statements: see `joint`
            return False
        if not self.known.done.issuperset(rules.prerequisites[task]):
            return False
        return task not in rules.once or self._is_reserved(task, base, epoch, shown, rules)

    def begin(self, task: str) -> None:
        self.begun.add(task)

    def reserve(self, task: str) -> None:
        """Announce that the robot, in this incarnation, is going to begin an at-most-once task."""
        if task not in self.reserved:
            self.reserved[task] = self.say(task, "begun", str(self.incarnation).encode())

    def finish(self, task: str) -> None:
        self.begun.discard(task)
        self.say(task, "done")

    def abandon(self, task: str) -> None:
        if task in self.begun:
            self.begun.discard(task)
            self.epoch_due = True

    def release(self, task: str, rules: Rules) -> None:
        if task in rules.once and task in self.begun:
            raise ParameterError(f"release: {shown(task)}; expected a task that may be begun again")
        self.begun.discard(task)
        self.give_up(task)

    def give_up(self, task: str) -> None:
        """Do not bid for a task any more."""
        if task in self.reserved:
            self.say(task, "waived", self.reserved.pop(task).content)
        self.refused.add(task)
        self.epoch_due = True

    def withdraw(self) -> None:
        """Take no more tasks, and give back all that were not begun."""
        for task in self.reserved.keys() - self.begun:
            self.give_up(task)
        self.epoch_due |= not self.withdrawn
        self.withdrawn = True

    def give_up_lost(self, kept: Sequence[Claim]) -> None:
        """Give up tasks that were reserved and went to another robot before they were begun."""
        for task in self.reserved.keys() - self.begun - self.known.done - {claim.task for claim in kept}:
            self.give_up(task)

    def _is_reserved(self, task: str, base: Base, epoch: Epoch, shown: Iterable[str], rules: Rules) -> bool:
        """Whether a majority of the mission's robots knows that this robot is going to begin the task."""
        tell = [declared for robot in shown if (declared := epoch.declaration_of(robot)) is not None]
        said = self.reserved.get(task) in base.facts
        return said and sum(declared.knows for declared in tell) >= rules.majority
