"""A robot's part in an auction without a centre: sans-I/O, without clock, socket or thread.

`handle` takes a message, `tick` lets time go by; both return what is to be sent. Epochs (`epoch`) follow one another
whenever the robots that take part change: a member fell silent, one is heard that was not there, one has started anew.
Every robot that sees a higher epoch enters it. A robot never declares or bids twice for the same thing, and never goes
back to an epoch that it has left; so two robots that take each other for members never own the same task (see
docs/negotiation.md).

No message is taken for delivered. Each tells how far its sender is and what it lacks, at least every `beat_s`; whoever
has what is lacking sends it.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from zlib import crc32

from muster.negotiation.base import Rules, with_begun
from muster.negotiation.epoch import Epoch
from muster.negotiation.members import Members, Patience
from muster.negotiation.messages import Claim, Declaration, Fact, Message, Pulse, RoundBids, Sold, Stage
from muster.negotiation.valuation import Valuer

HELPERS = 2
"""Of those that could send what somebody lacks, about so many do, besides the one whose it is."""


@dataclass(frozen=True, slots=True)
class Outgoing:
    """A message to one robot; None: to all."""

    message: Message
    to: str | None = None


@dataclass
class Counts:
    """What a robot has sent: messages with something new of its own, repairs of what others lacked, idle beats."""

    news: int = 0
    repairs: int = 0
    beats: int = 0


@dataclass
class Negotiator:
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
        what it owned before it stopped, if it remembers.
    """

    robot: str
    rules: Rules
    valuer: Valuer
    patience: Patience = field(default_factory=Patience)
    incarnation: int = 0
    remembered: tuple[Claim, ...] = ()

    def __post_init__(self) -> None:
        self.members = Members(self.robot, self.patience)
        self.counts = Counts()
        self.facts: set[Fact] = set()
        self.rivals: set[int] = set()  # incarnations of others under this robot's name
        self.epochs: list[Epoch] = []  # those of which the base was found
        self._begun: set[str] = {claim.task for claim in self.remembered if claim.begun}
        self._number = 0
        self._agreed: set[str] = set()
        self._agreed_on = Stage(0)
        self._stages: dict[str, Stage] = {}
        self._answered: dict[str, tuple[float, Stage]] = {}
        self._due_s = self._entered_s = self._stage_s = 0.0
        self.epoch: Epoch

    def start(self, now: float) -> list[Outgoing]:
        """Begin, with the whole team for members."""
        self.members.expect(self.rules.robots, now)
        return self._enter(1, now)

    @property
    def stage(self) -> Stage:
        return self.epoch.stage

    @property
    def settled(self) -> bool:
        """Whether all members are known to own what this robot thinks that they own, and nobody bids any more."""
        return self.stage.ended and self._agreed_on == self.stage and self._agreed.issuperset(self.epoch.own.members)

    @property
    def route(self) -> tuple[Claim, ...]:
        """What this robot owns, in the order in which it is going to do it."""
        done = {fact.task for fact in self.facts if fact.done}
        claims = self.epoch.route()
        for task in self._begun:
            claims = with_begun(claims, task)
        return tuple(claim for claim in claims if claim.task not in done)

    @property
    def due_s(self) -> float:
        """When `tick` is to be called next at the latest."""
        return self._due_s

    def handle(self, message: Message, now: float) -> list[Outgoing]:
        """Take in a message; returns what is to be sent."""
        sender, out = message.sender, list[Outgoing]()
        if sender == self.robot:
            if message.incarnation != self.incarnation:
                self.rivals.add(message.incarnation)
            return out
        if message.incarnation < self.members.incarnation(sender):
            return out
        anew = self.members.hear(Pulse(sender, message.incarnation, message.number), now)
        for pulse in message.pulses:
            anew |= self.members.hear(pulse, now)
        if message.stage.epoch > self.stage.epoch:
            out += self._enter(message.stage.epoch, now)
        elif anew:
            out += self._enter(self.stage.epoch + 1, now)
        if message.stage.epoch == self.stage.epoch and self._absorb(message):
            out += self._go_on(now)
        self._stages[sender] = message.stage
        self._note_agreement(message)
        return out + self._answer(message, now)

    def tick(self, now: float) -> list[Outgoing]:
        """Let time go by; returns what is to be sent."""
        out: list[Outgoing] = []
        self._lose_patience(now)
        if self._in_order(self.members.present(now)) != self.epoch.own.members:
            out += self._enter(self.stage.epoch + 1, now)
        if now >= self._due_s and not out:
            self.counts.beats += 1
            out.append(Outgoing(self._message(now, lacks=self.epoch.lacks, pulses=self._pulses())))
        return out

    def begin(self, task: str) -> None:
        """Begin a task that the robot owns: nobody else is going to have it."""
        self._begun.add(task)

    def finish(self, task: str) -> None:
        """Tell that the robot has done a task."""
        self._begun.discard(task)
        self.facts.add(Fact(task, self.robot, done=True))

    def _enter(self, number: int, now: float) -> list[Outgoing]:
        """Leave the epoch, declare what came of it, and hold the auction of another one."""
        if hasattr(self, "epoch"):
            route, rounds = self.route, self.epoch.rounds
        else:
            route, rounds = self.remembered, 0
        own = Declaration(
            robot=self.robot,
            incarnation=self.incarnation,
            epoch=number,
            members=self._in_order(self.members.present(now)),
            route=route,
            facts=tuple(sorted(self.facts, key=lambda fact: (self.rules.tasks[fact.task], fact.robot, fact.done))),
            rounds=rounds,
        )
        self.epoch = Epoch(own, self.rules, self.valuer)
        self._entered_s = self._stage_s = now
        self.counts.news += 1
        return [Outgoing(self._message(now, declarations=(own,))), *self._go_on(now)]

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
        return epoch.learn(message.stage, message.sales, message.sales_from) or new

    def _go_on(self, now: float) -> list[Outgoing]:
        """Go on with the auction as far as it goes; returns the bids to be published."""
        had_base, before = self.epoch.base is not None, self.stage
        published = self.epoch.advance()
        if self.epoch.base is not None and not had_base:
            self.facts |= self.epoch.base.facts
            self.epochs.append(self.epoch)
        if self.stage != before:
            self._stage_s = now
        if self.stage.ended and self._agreed_on != self.stage:
            self._agreed, self._agreed_on = {self.robot}, self.stage
            self._due_s = min(self._due_s, now)  # tell it at once
        self.counts.news += len(published)
        return [Outgoing(self._message(now, bids=(bids,))) for bids in published]

    def _note_agreement(self, message: Message) -> None:
        if self.stage.ended and message.stage == self.stage:
            self._agreed.update(message.agreed)

    def _answer(self, message: Message, now: float) -> list[Outgoing]:
        """Send the sender of a message what it lacks, if that is here; not again at once."""
        if not message.pulses:  # who has news is not waiting; if it is, its next beat tells so
            return []
        to, stage = message.sender, message.stage
        last_s, last_stage = self._answered.get(to, (-1.0, None))
        if stage == last_stage and now < last_s + self.patience.retry_s / 2:
            return []
        what = self._what_lacks(message)
        if what is None:
            return []
        self._answered[to] = now, stage
        self.counts.repairs += 1
        return [Outgoing(what, to)]

    def _what_lacks(self, message: Message) -> Message | None:
        epoch, stage, own = self.epoch, message.stage, self.stage
        if stage.epoch < own.epoch:
            return self._message(None, declarations=(epoch.own,))
        if stage.epoch > own.epoch:
            return None
        if not stage.base:
            lacked = [robot for robot in message.lacks if self._helps(message, robot)]
            said = tuple(d for d in map(epoch.declaration_of, lacked) if d is not None)
            return self._message(None, declarations=said) if said else None
        if stage.base != own.base:
            return None
        if stage.round < own.round or (own.ended and not stage.ended):
            if not self._helps(message, None):
                return None
            return self._message(None, sales=tuple(epoch.sales[stage.round :]), sales_from=stage.round)
        if stage.round == own.round:
            lacked = [robot for robot in message.lacks if self._helps(message, robot)]
            bids = tuple(b for b in (epoch.bids_of(robot, stage.round) for robot in lacked) if b is not None)
            return self._message(None, bids=bids) if bids else None
        return None

    def _helps(self, message: Message, whose: str | None) -> bool:
        """Whether it is this robot that sends what is lacking: its own always, else about HELPERS of all."""
        if whose == self.robot:
            return True
        others = sum(stage == message.stage for stage in self._stages.values())
        able = max(1, len(self.epoch.own.members) - others)
        return crc32(f"{message.sender} {message.number} {self.robot}".encode()) % able < HELPERS

    def _lose_patience(self, now: float) -> None:
        """Leave out who is heard, but keeps the others waiting."""
        if now - self._stage_s < self.patience.bid_s:
            return
        for robot in self.epoch.lacks:
            if robot != self.robot and self.members.silent_s(robot, now) < self.patience.suspect_s / 2:
                self.members.mute(robot, now, bids=self.epoch.base is not None)
        self._stage_s = now

    def _message(
        self,
        sent_s: float | None,
        *,
        lacks: tuple[str, ...] = (),
        pulses: tuple[Pulse, ...] = (),
        declarations: tuple[Declaration, ...] = (),
        bids: tuple[RoundBids, ...] = (),
        sales: tuple[Sold, ...] = (),
        sales_from: int = 0,
    ) -> Message:
        """The next message; one that goes to all, at `sent_s`, puts off the next beat."""
        self._number += 1
        if sent_s is not None:
            wait = self.patience.beat_s if self.stage.ended else self.patience.retry_s
            self._due_s = sent_s + wait
        agreed = tuple(self._agreed) if self.stage.ended else ()
        return Message(
            self.robot,
            self.incarnation,
            self._number,
            self.stage,
            declarations,
            bids,
            sales,
            sales_from,
            lacks,
            pulses,
            agreed,
        )

    def _pulses(self) -> tuple[Pulse, ...]:
        return self.members.pulses(Pulse(self.robot, self.incarnation, self._number), list(self.rules.robots))

    def _in_order(self, robots: Sequence[str]) -> tuple[str, ...]:
        return tuple(sorted(robots, key=lambda robot: self.rules.robots[robot]))
