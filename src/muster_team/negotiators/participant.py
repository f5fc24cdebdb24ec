"""One robot's part in the distributed auction, as a state machine without clock, socket or thread (sans-I/O).

`handle` takes a message and `tick` lets time pass; both return messages to send. Epochs (`auctions.epoch`) follow one
another whenever the set of participating robots changes: a member falls silent, another robot is heard, a member
restarts. Every robot that learns of a higher epoch enters it. A robot never declares or bids twice for the same thing
and never returns to an epoch that it has left; so two robots that count each other as members never own the same task
(see docs/negotiation.md).

No message is assumed to be delivered. Each robot states its progress and what it lacks at least every `heartbeat_s`; a
robot that has the lacking data sends it.
"""

from __future__ import annotations

from collections import defaultdict, deque
from collections.abc import Callable, Collection, Iterable, Mapping
from dataclasses import dataclass, field, replace
from itertools import repeat
from typing import Any

from muster_team.auctions.epoch import Epoch, EpochAuction
from muster_team.auctions.valuation import Valuer
from muster_team.knowledge.admission import admit, healed
from muster_team.knowledge.effects import Counts, Memory, Notice, Notices, Outgoing
from muster_team.knowledge.epoch_base import Base
from muster_team.knowledge.facts import in_order
from muster_team.knowledge.messages import (
    Birth,
    Claim,
    Declaration,
    Evidence,
    Fact,
    Heartbeat,
    Message,
    Reach,
    Stage,
)
from muster_team.knowledge.rules import Rules
from muster_team.knowledge.signatures import NO_KEYS, Signatures
from muster_team.knowledge.verdicts import Refused
from muster_team.membership.convictions import Convictions
from muster_team.membership.identity import LEAP as LATER
from muster_team.membership.identity import Identity
from muster_team.membership.members import Members, Timeouts
from muster_team.membership.peer_progress import PeerProgress
from muster_team.membership.stalled_members import StalledMembers
from muster_team.negotiators.owned_tasks import OwnedTasks
from muster_team.negotiators.repairs import Repairs

LEAP = 2**20
"""The most epochs that a robot goes on at once. So no number that arrives uses up all that there are."""

PAST = 32
"""The number of earlier epochs whose auctions are kept for the book of bids. Of older ones nothing is."""

RESTATED = 3
"""How often other routes of a robot lead to a new epoch. So a liar does not keep the team busy."""


def _no_pieces() -> tuple[Reach, ...]:
    return ()


@dataclass
class Participant:
    """One robot of the auction.

    Parameters
    ----------
    robot
        its id.
    rules, valuer, timeouts
        the rules of the mission, the computation of this robot's bids, and the protocol's time limits.
    incarnation
        the number of this start of the robot; higher than all earlier ones.
    remembered
        what the robot kept from its last incarnation, if it kept anything.
    forgot
        whether the robot may have taken part before without remembering it. Then it does not count towards the majority
        for at-most-once tasks until robots that remember have declared together with it.
    absent
        robots that join later; nobody waits for them.
    signatures
        the proofs of who has stated what, where robots have keys of their own.
    seen
        tells which pieces of the map the robot has, where robots build one.
    """

    robot: str
    rules: Rules
    valuer: Valuer
    timeouts: Timeouts = field(default_factory=Timeouts)
    incarnation: int = 0
    remembered: Memory | None = None
    forgot: bool = False
    absent: Collection[str] = ()
    signatures: Signatures = NO_KEYS
    seen: Callable[[], tuple[Reach, ...]] = _no_pieces

    def __post_init__(self) -> None:
        self.rules = replace(self.rules, misfit=self.valuer.misfit)
        self._convictions = Convictions(self.signatures)
        self.members = Members(self.robot, self.timeouts)
        self.counts = Counts()
        self.notices = Notices()
        memory, refused = healed(self.remembered or Memory(knows=not self.forgot), self.rules, self.signatures)
        for reason in refused:
            self._refuse(self.robot, reason)
        self.latest: Epoch | None = None  # the last epoch whose base was found
        self.past: deque[EpochAuction] = deque(maxlen=PAST)  # what is kept of those before
        self.together = True  # whether the whole team took part in each
        self.knows = memory.knows
        self._before = memory
        self._identity = Identity(self.robot, self.incarnation)
        self._owned = OwnedTasks.remembered(self.robot, self.incarnation, memory, self.signatures)
        self._peer_progress = PeerProgress(self.robot)
        self._stalled = StalledMembers(self.members)
        self._repairs = Repairs(self.robot, self.timeouts.retry_s)
        self._differing: defaultdict[str, set[int]] = defaultdict(set)  # the epochs in which it computed other routes
        self._looked_at = 0  # the digest of what is known for good, when it was last looked at for news
        self._restart_heard = False  # whether a robot has started restarted since this epoch was entered
        self._due_s = 0.0
        self.epoch: Epoch  # from `start` on

    def start(self, now: float) -> list[Outgoing]:
        """Start, with the whole team as expected members; return the messages to send."""
        self.members.expect(self.rules.robots, now, self.absent)
        self._apply_revocations(self._owned.known.facts)
        claims = self._owned.left_of(self._before.claims)
        out = self._open(self._declaration(self._before.epoch + 1, claims, 0, now), now)
        return [] if self._identity.superseded else out

    @property
    def stage(self) -> Stage:
        return self.epoch.stage

    @property
    def settled(self) -> bool:
        """Whether all members are known to agree with this robot on all owners, and nobody bids any more."""
        quiet = not (self._owned.unsent or self._owned.epoch_due)
        return quiet and self._peer_progress.holds(self.stage, self.epoch.own.members)

    @property
    def twice(self) -> Mapping[str, tuple[str, ...]]:
        """Tasks that several robots have begun or done, with these robots, as far as this robot knows."""
        base = self._base
        return {**(base.twice if base else {}), **self._owned.known.twice}

    @property
    def due_s(self) -> float:
        """The latest time at which `tick` has to be called next."""
        return self._due_s

    def handle(self, message: Message, now: float) -> list[Outgoing]:
        """Process a message; return the messages to send. What is refused changes nothing."""
        if self._identity.superseded:
            return []
        verdict = admit(self.rules, message, self.signatures)
        if isinstance(verdict, Refused):
            self._refuse(str(message.sender), verdict.reason)
            return []
        if not self._hear(message, now):
            return self._correct(message, now)
        out: list[Outgoing] = []
        number = min(message.stage.epoch, self.epoch.own.epoch + LEAP)
        if self.epoch.own.incarnation < self.incarnation:
            out += self._enter(max(number, self.epoch.own.epoch + 1), now)
        if number > self.epoch.own.epoch:
            self.notices.tell_each("exclude", self._stalled.too_long_for(message, self.epoch, now))
            out += self._enter(number, now)
        if number == self.epoch.own.epoch and self._absorb(message):
            out += self._go_on(now)
        for robot, reason in self.epoch.take_refused():
            self._refuse(robot or message.sender, reason)
        for evidence in self.epoch.take_evidence():
            self._convict(evidence)
        if unknown := self._convictions.unknown_to(message):
            out.append(Outgoing(self._message(None, evidence=unknown), message.sender))
        if self._restart_heard and self._is_outdated():
            out += self._enter(self.epoch.own.epoch + 1, now)
        self._compare_routes(message)
        self._peer_progress.hear(message, self.epoch.stage)
        if (what := self._repairs.answer(message, self.epoch, self._owned.known, now)) is not None:
            self.counts.repairs += 1
            out.append(Outgoing(self._message(None, **what), message.sender))
        return out

    def tick(self, now: float) -> list[Outgoing]:
        """Let time pass; return the messages to send."""
        out: list[Outgoing] = []
        if self._identity.superseded:
            return out
        self.notices.tell_each("exclude", self._stalled.too_long(self.epoch, now))
        outdated = self._restart_heard and self._is_outdated()
        if outdated or self.members.present(now) != self.epoch.own.members or self._has_news():
            out += self._enter(self.epoch.own.epoch + 1, now)
        if self._owned.unsent or (now >= self._due_s and not out):
            out.append(Outgoing(self._heartbeat(now)))
        return out

    def _convict(self, evidence: Evidence) -> None:
        """Count a robot out for good that has stated two different things, and tell the others."""
        if not self._convictions.convict(evidence):
            return
        self._shut_out(evidence.robot, "it has stated two different things")

    def _shut_out(self, robot: str, reason: str) -> None:
        """Count a robot out for good; this one falls silent, as another process has its key."""
        self.notices.append(Notice("revoked", (robot,), reason=reason))
        if robot == self.robot:
            self._identity.superseded = True
        else:
            self.members.revoke(robot)
            self._owned.epoch_due = True

    def _apply_revocations(self, facts: Iterable[Fact]) -> None:
        for fact in facts:
            if fact.kind == "revoked":
                self._shut_out(fact.task, "an operator has revoked its key")

    def _compare_routes(self, message: Message) -> None:
        """Tell of a sender that computes other routes; all state their own in another epoch, RESTATED times at most."""
        if not self.epoch.sees_other_routes(message.stage):
            return
        seen, epoch = self._differing[message.sender], self.epoch.own.epoch
        if epoch not in seen and len(seen) < RESTATED:
            seen.add(epoch)
            self.notices.tell("differs", [message.sender])
            self._owned.epoch_due = True

    def _refuse(self, sender: str, reason: str) -> None:
        """Count what was refused, and tell of it once for each reason."""
        self.counts.refuse(sender, reason)
        self.notices.tell_refused(sender, reason)

    @property
    def _base(self) -> Base | None:
        """The base of the last epoch whose base was found."""
        return self.latest.base if self.latest else None

    @property
    def _rules(self) -> Rules:
        """The rules of the mission with the tasks that were added."""
        base = self._base
        return self.rules.with_added(base.added) if base else self.rules

    def _enter(self, number: int, now: float) -> list[Outgoing]:
        """Leave the current epoch and enter the one with this number."""
        before, left = self.epoch.own.members, self.epoch
        own = self._declaration(number, self._owned.up_to_date(left), left.rounds, now)
        self.notices.tell("silent", [robot for robot in before if robot not in own.members])
        self.notices.tell("back", [robot for robot in own.members if robot not in before])
        return self._open(own, now)

    def _declaration(self, number: int, route: tuple[Claim, ...], rounds: int, now: float) -> Declaration:
        """The declaration of this robot in an epoch, with this route and after this number of rounds."""
        members = self.members.present(now)
        own = Declaration(
            robot=self.robot,
            incarnation=self.incarnation,
            epoch=number,
            members=members,
            route=route,
            facts=in_order(self._owned.known.facts),
            rounds=rounds,
            incarnations=tuple(self.incarnation if r == self.robot else self.members.incarnation(r) for r in members),
            knows=self.knows,
            seen=self.seen(),
        )
        return self.signatures.sign(own)

    def _open(self, own: Declaration, now: float) -> list[Outgoing]:
        """Declare, and begin the auction of this epoch."""
        work = self._owned
        refused = frozenset(
            {*self._rules.tasks, *(f.task for f in work.known.facts)} if work.withdrawn else work.refused
        )
        self.epoch = Epoch(own, self.rules, self.valuer, refused, signatures=self.signatures)
        self._restart_heard = work.epoch_due = False
        work.unsent.clear()  # the declaration contains them
        work.offers = False  # it does not claim what it offers
        self._peer_progress.enter()
        self._stalled.enter(self.stage, now)
        self.counts.news += 1
        return [Outgoing(self._message(now, declarations=(own,))), *self._go_on(now)]

    def _hear(self, message: Message, now: float) -> bool:
        """Note who is alive and which facts hold; False for a stranger, a rival, or an earlier incarnation."""
        if message.sender == self.robot:
            self._identity.may_renumber = False  # another process of this name lives
        if message.sender == self.robot or not self.members.accepts(message):
            self._hear_of(message.heartbeat, now, relayed=False)
            return False
        if self.members.hear_from(message, now):
            self._note_restart(message.sender)
        for birth in message.births:
            self.members.hear_birth(birth)
        for evidence in message.evidence:
            self._convict(evidence)
        for heartbeat in message.heartbeats:
            self._hear_of(heartbeat, now)
        for said in message.declarations:
            if said != self.epoch.declaration_of(said.robot):
                for heartbeat in map(Heartbeat, said.members, said.incarnations, repeat(-1)):
                    self._hear_of(heartbeat, now)
                self._learn(said.facts)
        if message.facts:
            self._learn(message.facts)
        self._repairs.hear(message)
        return True

    def _correct(self, message: Message, now: float) -> list[Outgoing]:
        """Tell a sender whose key was revoked so, and one with an outdated incarnation which incarnation is known.

        It may have started without memory after its clock was set back. It then takes a higher incarnation. While the
        known incarnation is heard, another process has the id, and nobody is told.
        """
        order = [f for f in self._owned.known.facts if f.kind == "revoked" and f.task == message.sender]
        if order and message.heartbeats and self._repairs.may_answer(message, now):
            return [Outgoing(self._message(None, facts=tuple(order)), message.sender)]
        is_past = self.members.incarnation(message.sender) > message.incarnation
        if not is_past or not message.heartbeats or not self._repairs.may_answer(message, now):
            return []
        correction = self.members.correction(message.sender, now)
        if correction is None:
            return []
        self.counts.repairs += 1
        told = self._message(None, heartbeats=(correction,), births=self._births([correction]))
        return [Outgoing(told, message.sender)]

    def _hear_of(self, heartbeat: Heartbeat, now: float, *, relayed: bool = True) -> None:
        """Note that a robot was alive. For this robot's own id it may be another process, or an earlier incarnation.

        Where robots have keys, a later start counts only with its proof. Where they have none this robot refutes a
        later start of its own that others tell of.
        """
        is_mine, by_key = heartbeat.robot == self.robot, self.signatures.has_keys
        known = self.incarnation if is_mine else self.members.incarnation(heartbeat.robot)
        if (by_key and not self.members.is_born(heartbeat)) or heartbeat.incarnation > max(known, 0) + LATER:
            return
        if is_mine:
            self._identity.may_renumber |= heartbeat.number == 0  # a correction: no rival lives
            is_hearsay, before_s = relayed and not by_key, now - self.timeouts.suspect_s
            if self._identity.renumber_above(heartbeat) or (is_hearsay and self._identity.refute(heartbeat, now)):
                self._renumber()
            elif self._identity.gives_way(heartbeat, before_s) or self._identity.hear(heartbeat):
                self.notices.tell("rival", [self.robot])
        elif self.members.hear(heartbeat, now):
            self._note_restart(heartbeat.robot)

    def _renumber(self) -> None:
        """Continue under a higher incarnation, as after a restart with memory; the next epoch is entered with it."""
        self.incarnation = self._owned.incarnation = self._identity.incarnation
        self.latest = None
        self.past.clear()
        self.notices.tell("renumbered", [self.robot])

    def _note_restart(self, robot: str) -> None:
        self._restart_heard = True
        self.notices.tell("restarted", [robot])

    def _learn(self, facts: Collection[Fact]) -> None:
        new = self._owned.known.learn(facts)
        self._apply_revocations(new)
        if any(fact.kind in ("done", "part") for fact in new):
            self.notices.tell_twice(self.twice)

    def _absorb(self, message: Message) -> bool:
        """Process the parts of a message that belong to this epoch; return whether the auction can go on."""
        epoch, new = self.epoch, False
        for declaration in message.declarations:
            if declaration.incarnation >= self.members.incarnation(declaration.robot):
                new |= epoch.hear_declaration(declaration)
                if self.robot in declaration.members:
                    self.members.readmit(declaration.robot)
        for bids in message.bids:
            new |= epoch.hear_bids(message.stage.base, bids)
        if message.sales or message.stage.ended:
            new |= epoch.learn(message.stage, message.sales, message.sales_from)
        return new

    def _go_on(self, now: float) -> list[Outgoing]:
        """Advance the auction as far as possible; return messages with the bids to publish."""
        had_base = self.epoch.base is not None
        published = self.epoch.advance()
        if self.epoch.base is not None and not had_base:
            self._note_base(self.epoch.base)
        self._stalled.reach(self.stage, now)
        if self.stage.ended and self._peer_progress.end(self.stage):
            self.members.reset_exclusions(self.epoch.own.members)
            self._due_s = min(self._due_s, now)  # report it at once
        self.counts.news += len(published)
        return [Outgoing(self._message(now, bids=(bids,), **self._last_sale())) for bids in published]

    def _note_base(self, base: Base) -> None:
        """Process the base of the epoch, which follows from the declarations of all members."""
        self.past += [] if self.latest is None else [self.latest.auction]
        self.latest = self.epoch
        self.together &= len(base.routes) == len(self.rules.robots)
        self._identity.may_renumber &= len(base.routes) == 1  # else the others have accepted the incarnation
        self._peer_progress.find_base()
        self._learn(base.facts)
        me = self.epoch.own.members.index(self.robot)
        others = [d for d in self.epoch.declarations if d.robot != self.robot]
        told = sum(d.knows and d.incarnations[me] == self.incarnation for d in others)
        self.knows = self.knows or told >= self.rules.majority
        self._owned.give_up_lost(base.routes[self.robot])
        self.notices += [Notice("dropped", (robot,), task) for robot, task in base.dropped]
        self.notices.tell_twice(base.twice)

    def _is_outdated(self) -> bool:
        """Whether a member has restarted since it declared in this epoch."""
        return any(self.members.incarnation(d.robot) > d.incarnation for d in self.epoch.declarations)

    def _has_news(self) -> bool:
        """Whether something has to be declared that was not known when this epoch began, so that a new epoch is due."""
        base = self.epoch.base
        if self._owned.epoch_due or base is None:
            return self._owned.epoch_due
        if self._looked_at == (state := self._owned.known.digest) and self.knows:
            return False
        self._looked_at = state
        return self._could_be_told() or any(f.opens_epoch and f not in base.facts for f in self._owned.known.facts)

    def _could_be_told(self) -> bool:
        """Whether this robot has lost its memory and enough members that remember are here."""
        know = sum(declared.knows for declared in self.epoch.declarations)
        return self.epoch.ended and not self.knows and know >= self.rules.majority

    def _heartbeat(self, now: float) -> Message:
        """A heartbeat: that this robot is alive, whom it has heard, what it lacks, and its last statements."""
        unsent = tuple(self._owned.unsent)
        self._owned.unsent.clear()
        self.counts.news += bool(unsent)
        self.counts.heartbeats += not unsent
        return self._message(
            now,
            lacks=self.epoch.lacks,
            heartbeats=(heard := self.members.heartbeats(self._identity.heartbeat, now)),
            births=self._births(heard),
            unheard=self.members.unheard(now),
            facts=unsent,
            known=self._owned.known.digest,
            **self._repairs.passed_on(self.epoch),
        )

    def _message(self, sent_s: float | None, **said: Any) -> Message:
        """The next message. One that goes to all at `sent_s` delays the next heartbeat."""
        self._identity.number += 1
        if sent_s is not None:
            asks_s = self._repairs.asks_s(self._identity.number, len(self.epoch.own.members))
            self._due_s = sent_s + (self.timeouts.heartbeat_s if self.stage.ended else asks_s)
        agreed = tuple(sorted(self._peer_progress.agreed)) if self.stage.ended else ()
        if sent_s is not None and (evidence := self._convictions.take_unsent()):
            said["evidence"] = evidence
        return Message(self.robot, self.incarnation, self._identity.number, self.stage, agreed=agreed, **said)

    def _births(self, heartbeats: Iterable[Heartbeat]) -> tuple[Birth, ...]:
        """The proofs of the starts that heartbeats name."""
        if not self.signatures.has_keys:
            return ()
        others = (self.members.birth_of(heartbeat) for heartbeat in heartbeats)
        own = self.signatures.sign(Birth(self.robot, self.incarnation))
        return (own, *(birth for birth in others if birth is not None))

    def _last_sale(self) -> dict[str, Any]:
        """The result of the last round, for members that have missed some of its bids."""
        sales = self.epoch.sales
        return {"sales": (sales[-1],), "sales_from": len(sales) - 1} if sales else {}
