"""How a robot takes part in an auction without a centre: sans-I/O, without clock, socket or thread.

`handle` takes a message, `tick` lets time go by; both return what is to be sent. Epochs (`epoch`) follow one another
whenever the robots that take part change: a member fell silent, one is heard that was not there, one has started anew.
Every robot that sees a higher epoch enters it. A robot never declares or bids twice for the same thing, and never goes
back to an epoch that it has left; so two robots that take each other for members never own the same task (see
docs/negotiation.md).

No message is taken for delivered. Each tells how far its sender is and what it lacks, at least every `beat_s`; whoever
has what is lacking sends it.
"""

from __future__ import annotations

from collections.abc import Collection, Mapping
from dataclasses import dataclass, field
from itertools import repeat
from typing import Any

from muster.negotiation.effects import Counts, Diary, Happening, Memory, Outgoing
from muster.negotiation.epoch import Epoch
from muster.negotiation.epoch_base import Base, Rules
from muster.negotiation.identity import Identity
from muster.negotiation.knowledge import in_order
from muster.negotiation.members import Members, Patience
from muster.negotiation.messages import Claim, Declaration, Fact, Message, Pulse, Stage
from muster.negotiation.owned_tasks import Work
from muster.negotiation.peer_progress import Agreement
from muster.negotiation.repairs import Repairs
from muster.negotiation.stalled_members import Waiting
from muster.negotiation.valuation import Valuer


@dataclass
class Participant:
    """One robot.

    Parameters
    ----------
    robot
        its id.
    rules, valuer, patience
        of the mission, of this robot's bids, and how long it waits.
    incarnation
        how often it has started: above all that it had before.
    remembered
        what it kept of its last life, if it remembers.
    forgot
        whether it may have taken part before and does not remember: its word does not count for tasks that nobody may
        begin twice until those that know have told it.
    absent
        robots that come later: nobody waits for them.
    """

    robot: str
    rules: Rules
    valuer: Valuer
    patience: Patience = field(default_factory=Patience)
    incarnation: int = 0
    remembered: Memory | None = None
    forgot: bool = False
    absent: Collection[str] = ()

    def __post_init__(self) -> None:
        memory = self.remembered or Memory(knows=not self.forgot)
        self.members = Members(self.robot, self.patience)
        self.counts = Counts()
        self.happenings = Diary()
        self.epochs: list[Epoch] = []  # those of which the base was found
        self.knows = memory.knows
        self._before = memory
        self._identity = Identity(self.robot, self.incarnation)
        self._work = Work.remembered(self.robot, self.incarnation, memory)
        self._agreement = Agreement(self.robot)
        self._waiting = Waiting(self.members)
        self._repairs = Repairs(self.robot, self.patience.retry_s)
        self._looked_at = 0  # the digest of what is known for good, when it was last looked at for news
        self._anew = False  # whether a robot has started anew since this epoch was entered
        self._due_s = 0.0
        self.epoch: Epoch  # from `start` on

    def start(self, now: float) -> list[Outgoing]:
        """Begin, with the whole team for members."""
        self.members.expect(self.rules.robots, now, self.absent)
        claims = self._work.left_of(self._before.claims)
        return self._open(self._declaration(self._before.epoch + 1, claims, 0, now), now)

    @property
    def stage(self) -> Stage:
        return self.epoch.stage

    @property
    def settled(self) -> bool:
        """Whether all members are known to own what this robot thinks that they own, and nobody bids any more."""
        quiet = not (self._work.fresh or self._work.restless)
        return quiet and self._agreement.holds(self.stage, self.epoch.own.members)

    @property
    def twice(self) -> Mapping[str, tuple[str, ...]]:
        """Tasks that several have done or begun, with these, as far as this robot knows."""
        base = self._base
        done = {task: doers for task, doers in self._work.known.doers.items() if len(doers) > 1}
        return {**(base.twice if base else {}), **done}

    @property
    def due_s(self) -> float:
        """When `tick` is to be called next at the latest."""
        return self._due_s

    def handle(self, message: Message, now: float) -> list[Outgoing]:
        """Take in a message; returns what is to be sent."""
        if self._identity.superseded:
            return []
        if not self._hear(message, now):
            return self._correct(message, now)
        out: list[Outgoing] = []
        number = message.stage.epoch
        if self.epoch.own.incarnation < self.incarnation:
            out += self._enter(max(number, self.epoch.own.epoch + 1), now)
        if number > self.epoch.own.epoch:
            self.happenings.tell_each("mute", self._waiting.too_long_for(message, self.epoch, now))
            out += self._enter(number, now)
        if number == self.epoch.own.epoch and self._absorb(message):
            out += self._go_on(now)
        if self._anew and self._is_outdated():
            out += self._enter(self.epoch.own.epoch + 1, now)
        self._agreement.hear(message, self.epoch.stage)
        if (what := self._repairs.answer(message, self.epoch, self._work.known, now)) is not None:
            self.counts.repairs += 1
            out.append(Outgoing(self._message(None, **what), message.sender))
        return out

    def tick(self, now: float) -> list[Outgoing]:
        """Let time go by; returns what is to be sent."""
        out: list[Outgoing] = []
        if self._identity.superseded:
            return out
        self.happenings.tell_each("mute", self._waiting.too_long(self.epoch, now))
        outdated = self._anew and self._is_outdated()
        if outdated or self.members.present(now) != self.epoch.own.members or self._has_news():
            out += self._enter(self.epoch.own.epoch + 1, now)
        if self._work.fresh or (now >= self._due_s and not out):
            out.append(Outgoing(self._beat(now)))
        return out

    @property
    def _base(self) -> Base | None:
        """The last that was found."""
        return self.epochs[-1].base if self.epochs else None

    @property
    def _rules(self) -> Rules:
        """The rules with the tasks that were added."""
        base = self._base
        return self.rules.with_added(base.added) if base else self.rules

    def _enter(self, number: int, now: float) -> list[Outgoing]:
        """Leave the epoch for another one."""
        before, left = self.epoch.own.members, self.epoch
        own = self._declaration(number, self._work.up_to_date(left), left.rounds, now)
        self.happenings.tell("silent", [robot for robot in before if robot not in own.members])
        self.happenings.tell("back", [robot for robot in own.members if robot not in before])
        return self._open(own, now)

    def _declaration(self, number: int, route: tuple[Claim, ...], rounds: int, now: float) -> Declaration:
        """What the robot says of itself in an epoch, with this route and after so many rounds."""
        members = self.members.present(now)
        return Declaration(
            robot=self.robot,
            incarnation=self.incarnation,
            epoch=number,
            members=members,
            route=route,
            facts=in_order(self._work.known.facts),
            rounds=rounds,
            incarnations=tuple(self.incarnation if r == self.robot else self.members.incarnation(r) for r in members),
            knows=self.knows,
        )

    def _open(self, own: Declaration, now: float) -> list[Outgoing]:
        """Declare, and hold the auction of this epoch."""
        work = self._work
        refused = frozenset({*self._rules.tasks, *(f.task for f in work.known.facts)} if work.out else work.refused)
        self.epoch = Epoch(own, self.rules, self.valuer, refused)
        self._anew = work.restless = False
        work.fresh.clear()  # the declaration tells them
        self._agreement.enter()
        self._waiting.enter(self.stage, now)
        self.counts.news += 1
        return [Outgoing(self._message(now, declarations=(own,))), *self._go_on(now)]

    def _hear(self, message: Message, now: float) -> bool:
        """Take in who lives, and what is true for good; False: it is said by a stranger, a rival, or in a life past."""
        if message.sender == self.robot:
            self._identity.may_rise = False  # another process of this name lives
        if message.sender == self.robot or not self.members.heeds(message):
            self._hear_of(message.pulse, now)
            return False
        if self.members.hear_from(message, now):
            self._note_anew(message.sender)
        for pulse in message.pulses:
            self._hear_of(pulse, now)
        for said in message.declarations:
            if said != self.epoch.declaration_of(said.robot):
                for pulse in map(Pulse, said.members, said.incarnations, repeat(-1)):
                    self._hear_of(pulse, now)
                self._learn(said.facts)
        if message.facts:
            self._learn(message.facts)
        self._repairs.hear(message)
        return True

    def _correct(self, message: Message, now: float) -> list[Outgoing]:
        """Tell a robot that sends with the incarnation of a past life which incarnation the others know.

        It may have started without memory after its clock was set back; it takes a higher incarnation then.
        """
        last = self.members.last_pulse(message.sender)
        is_past = last is not None and last.incarnation > message.incarnation
        if last is None or not (is_past and message.pulses and self._repairs.may_answer(message, now)):
            return []
        self.counts.repairs += 1
        return [Outgoing(self._message(None, pulses=(last,)), message.sender)]

    def _hear_of(self, pulse: Pulse, now: float) -> None:
        """Take in that a robot lived; one of this name may be another process, or a past life of this one."""
        if pulse.robot == self.robot:
            if self._identity.rise_above(pulse):
                self._rise()
            elif self._identity.hear(pulse):
                self.happenings.tell("rival", [self.robot])
        elif self.members.hear(pulse, now):
            self._note_anew(pulse.robot)

    def _rise(self) -> None:
        """Go on under a higher incarnation, as after a restart with memory; the next epoch is entered with it."""
        self.incarnation = self._work.incarnation = self._identity.incarnation
        self.epochs.clear()
        self.happenings.tell("renumbered", [self.robot])

    def _note_anew(self, robot: str) -> None:
        self._anew = True
        self.happenings.tell("anew", [robot])

    def _learn(self, facts: Collection[Fact]) -> None:
        if any(fact.done for fact in self._work.known.learn(facts)):
            self.happenings.tell_twice(self.twice)

    def _absorb(self, message: Message) -> bool:
        """Take in what a message of this epoch says; whether anything is new."""
        epoch, new = self.epoch, False
        for declaration in message.declarations:
            if declaration.incarnation >= self.members.incarnation(declaration.robot):
                new |= epoch.hear_declaration(declaration)
                if self.robot in declaration.members:
                    self.members.welcome(declaration.robot)
        for bids in message.bids:
            new |= epoch.hear_bids(message.stage.base, bids)
        if message.sales or message.stage.ended:
            new |= epoch.learn(message.stage, message.sales, message.sales_from)
        return new

    def _go_on(self, now: float) -> list[Outgoing]:
        """Go on with the auction as far as it goes; returns the bids to be published."""
        had_base = self.epoch.base is not None
        published = self.epoch.advance()
        if self.epoch.base is not None and not had_base:
            self._note_base(self.epoch.base)
        self._waiting.reach(self.stage, now)
        if self.stage.ended and self._agreement.end(self.stage):
            self.members.forgive(self.epoch.own.members)
            self._due_s = min(self._due_s, now)  # tell it at once
        self.counts.news += len(published)
        return [Outgoing(self._message(now, bids=(bids,), **self._last_sale())) for bids in published]

    def _note_base(self, base: Base) -> None:
        """Take in what all have declared."""
        self.epochs.append(self.epoch)
        self._identity.may_rise &= len(base.routes) == 1  # else the others have accepted the incarnation
        self._agreement.find_base()
        self._learn(base.facts)
        me = self.epoch.own.members.index(self.robot)
        others = [d for d in self.epoch.declarations if d.robot != self.robot]
        told = sum(d.knows and d.incarnations[me] == self.incarnation for d in others)
        self.knows = self.knows or told >= self.rules.majority
        self._work.give_up_lost(base.routes[self.robot])
        self.happenings += [Happening("dropped", (robot,), task) for robot, task in base.dropped]
        self.happenings.tell_twice(base.twice)

    def _is_outdated(self) -> bool:
        """Whether a member has started anew since it declared."""
        return any(self.members.incarnation(d.robot) > d.incarnation for d in self.epoch.declarations)

    def _has_news(self) -> bool:
        """Whether the others must know of something that was not known when this epoch began."""
        base = self.epoch.base
        if self._work.restless or base is None:
            return self._work.restless
        if self._looked_at == (state := self._work.known.digest) and self.knows:
            return False
        self._looked_at = state
        return self._could_be_told() or any(not f.done and f not in base.facts for f in self._work.known.facts)

    def _could_be_told(self) -> bool:
        """Whether this robot has forgotten what it said, and enough that know it are here."""
        know = sum(declared.knows for declared in self.epoch.declarations)
        return self.epoch.ended and not self.knows and know >= self.rules.majority

    def _beat(self, now: float) -> Message:
        """That the robot lives, whom it has heard, what it lacks; and what others may lack of its own words."""
        fresh = tuple(self._work.fresh)
        self._work.fresh.clear()
        self.counts.news += bool(fresh)
        self.counts.beats += not fresh
        return self._message(
            now,
            lacks=self.epoch.lacks,
            pulses=self.members.pulses(self._identity.pulse, now),
            misses=self.members.misses(now),
            facts=fresh,
            known=self._work.known.digest,
            **self._repairs.passed_on(self.epoch),
        )

    def _message(self, sent_s: float | None, **said: Any) -> Message:
        """The next message; one that goes to all, at `sent_s`, puts off the next beat."""
        self._identity.number += 1
        if sent_s is not None:
            asks_s = self._repairs.asks_s(self._identity.number, len(self.epoch.own.members))
            self._due_s = sent_s + (self.patience.beat_s if self.stage.ended else asks_s)
        agreed = tuple(sorted(self._agreement.agreed)) if self.stage.ended else ()
        return Message(self.robot, self.incarnation, self._identity.number, self.stage, agreed=agreed, **said)

    def _last_sale(self) -> dict[str, Any]:
        """What came of the last round, for those that have missed some of its bids."""
        sales = self.epoch.sales
        return {"sales": (sales[-1],), "sales_from": len(sales) - 1} if sales else {}
