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

from collections.abc import Collection, Mapping
from dataclasses import dataclass, field
from typing import Any

from muster.mission.errors import ParameterError
from muster.mission.kinds import shown
from muster.mission.model import Task
from muster.negotiation.base import Base, Rules
from muster.negotiation.epoch import Epoch
from muster.negotiation.happenings import Counts, Happening, Memory, Outgoing
from muster.negotiation.knowledge import in_order
from muster.negotiation.members import Members, Patience
from muster.negotiation.messages import Claim, Declaration, Fact, Message, Pulse, Stage
from muster.negotiation.repairs import Repairs
from muster.negotiation.tasks import content_of
from muster.negotiation.valuation import Valuer
from muster.negotiation.work import Work


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
        what it kept of its last life, if it remembers.
    forgot
        whether it may have taken part before and does not remember: its word does not count for tasks that nobody may
        begin twice until those that know have told it.
    """

    robot: str
    rules: Rules
    valuer: Valuer
    patience: Patience = field(default_factory=Patience)
    incarnation: int = 0
    remembered: Memory | None = None
    forgot: bool = False

    def __post_init__(self) -> None:
        memory = self.remembered or Memory(knows=not self.forgot)
        self.members = Members(self.robot, self.patience)
        self.counts = Counts()
        self.happenings: list[Happening] = []
        self.rivals: set[int] = set()  # incarnations of others under this robot's name
        self.epochs: list[Epoch] = []  # those of which the base was found
        self.knows = memory.knows
        self._before = memory
        self._work = Work.remembered(self.robot, self.incarnation, memory)
        self._shown: set[str] = set()  # members that have shown the base of this epoch
        self._told: set[tuple[str, tuple[str, ...]]] = set()  # what was done twice, by whom
        self._looked_at = 0  # the digest of what is known for good, when it was last looked at for news
        self._anew = False  # whether a robot has started anew since this epoch was entered
        self._number = 0
        self._agreed: set[str] = set()
        self._agreed_on = self._reached = Stage(0)
        self._repairs = Repairs(self.robot, self.patience.retry_s / 2)
        self._due_s = self._stage_s = 0.0
        self.epoch: Epoch

    def start(self, now: float) -> list[Outgoing]:
        """Begin, with the whole team for members."""
        self.members.expect(self.rules.robots, now)
        return self._enter(self._before.epoch + 1, now)

    @property
    def stage(self) -> Stage:
        return self.epoch.stage

    @property
    def settled(self) -> bool:
        """Whether all members are known to own what this robot thinks that they own, and nobody bids any more."""
        if not self.stage.ended or self._agreed_on != self.stage or self._work.fresh or self._work.restless:
            return False
        return self._agreed.issuperset(self.epoch.own.members)

    @property
    def superseded(self) -> bool:
        """Whether a later process has this robot's name: this one is silent, and owns nothing."""
        return any(rival > self.incarnation for rival in self.rivals)

    @property
    def route(self) -> tuple[Claim, ...]:
        """What this robot owns, in the order in which it is going to do it; nothing before it has heard the others."""
        return self._work.left_of(self.epoch.route()) if self.epochs and not self.superseded else ()

    @property
    def facts(self) -> frozenset[Fact]:
        """What it knows for good."""
        return frozenset(self._work.known.facts)

    @property
    def known(self) -> int:
        """A digest of `facts`."""
        return self._work.known.digest

    @property
    def twice(self) -> Mapping[str, tuple[str, ...]]:
        """Tasks that several have done or begun, with these, as far as this robot knows."""
        base = self.epochs[-1].base if self.epochs else None
        done = {task: doers for task, doers in self._work.known.doers.items() if len(doers) > 1}
        return {**(base.twice if base else {}), **done}

    @property
    def memory(self) -> Memory:
        """What to keep to start again where it stopped; to be kept before what was returned last is sent."""
        return self._work.memory(self.epoch.route(), self.stage.epoch, knows=self.knows)

    @property
    def due_s(self) -> float:
        """When `tick` is to be called next at the latest."""
        return self._due_s

    def handle(self, message: Message, now: float) -> list[Outgoing]:
        """Take in a message; returns what is to be sent."""
        sender, out = message.sender, list[Outgoing]()
        if self._is_mine(Pulse(sender, message.incarnation, message.number)) or self.superseded:
            return out
        if sender not in self.rules.robots or message.incarnation < self.members.incarnation(sender):
            return out
        self._hear(message, now)
        if message.stage.epoch > self.stage.epoch:
            self._lose_patience_too(message, now)
            out += self._enter(message.stage.epoch, now)
        if message.stage.epoch == self.stage.epoch and self._absorb(message):
            out += self._go_on(now)
        if self._is_outdated():
            out += self._enter(self.stage.epoch + 1, now)
        self._note_agreement(message)
        return out + self._answer(message, now)

    def tick(self, now: float) -> list[Outgoing]:
        """Let time go by; returns what is to be sent."""
        out: list[Outgoing] = []
        if self.superseded:
            return out
        self._lose_patience(now)
        if self._present(now) != self.epoch.own.members or self._is_outdated() or self._has_news():
            out += self._enter(self.stage.epoch + 1, now)
        if self._work.fresh or (now >= self._due_s and not out):
            out.append(Outgoing(self._beat(now)))
        return out

    def may_begin(self, task: str) -> bool:
        """Whether the robot may begin a task now.

        It must own it, by an auction that has ended, and what the task waits for must be done. Of a task that nobody
        may begin twice a majority of the mission's robots must know, too, that this robot is going to: see `begin`.
        """
        return bool(self.route) and self._work.may_begin(task, self.epoch, self._shown, self.rules)

    def begin(self, task: str) -> bool:
        """Begin a task, if the robot may; whether it has begun.

        For a task that nobody may begin twice the first call tells the others; once enough know, a later call begins.
        """
        if self.may_begin(task):
            self._work.begin(task)
            return True
        if task in self._rules.once and any(claim.task == task for claim in self.route):
            self._work.reserve(task)
        return False

    def finish(self, task: str) -> None:
        """Tell that the robot has done a task."""
        self._work.finish(task)

    def announce(self, task: Task) -> None:
        """Add a task to the mission: it is auctioned at once.

        Raises
        ------
        MissionError, ParameterError
            if the task does not fit into the mission, or there is one of its name.
        """
        if task.id in {*self.rules.tasks, *(fact.task for fact in self.facts if fact.kind == "added")}:
            raise ParameterError(f"new task: {shown(task.id)}; expected an id that no task has")
        self.valuer.check(task)
        self._work.say(task.id, "added", content_of(task))

    def cancel(self, task: str) -> None:
        """Take a task out of the mission; who has begun it goes on."""
        self._work.say(task, "cancelled")

    def release(self, task: str) -> None:
        """Give a task back, also one that was begun: others may have it, this robot does not bid for it any more.

        Raises
        ------
        ParameterError
            if it was begun and nobody may begin it twice.
        """
        self._work.release(task, self._rules)

    def withdraw(self) -> None:
        """The robot is out: it gives back all that it has not begun, and does not bid any more."""
        for claim in self.route:
            if not claim.begun:
                self._work.give_up(claim.task)
        self._work.out = self._work.restless = True

    @property
    def _rules(self) -> Rules:
        """The rules with the tasks that were added."""
        base = self.epochs[-1].base if self.epochs else None
        return self.rules.with_added(base.added) if base else self.rules

    def _enter(self, number: int, now: float) -> list[Outgoing]:
        """Leave the epoch, declare what came of it, and hold the auction of another one."""
        before = self.epoch if hasattr(self, "epoch") else None
        members, work = self._present(now), self._work
        own = Declaration(
            robot=self.robot,
            incarnation=self.incarnation,
            epoch=number,
            members=members,
            route=work.left_of(before.route() if before else self._before.claims),
            facts=in_order(work.known.facts),
            rounds=before.rounds if before else 0,
            incarnations=tuple(self.incarnation if r == self.robot else self.members.incarnation(r) for r in members),
            knows=self.knows,
        )
        if before:
            self._tell_all("silent", [robot for robot in before.own.members if robot not in members])
            self._tell_all("back", [robot for robot in members if robot not in before.own.members])
        refused = frozenset({*self._rules.tasks, *(f.task for f in work.known.facts)} if work.out else work.refused)
        self.epoch = Epoch(own, self.rules, self.valuer, refused)
        self._shown, self._anew, work.restless = set(), False, False
        work.fresh.clear()  # the declaration tells them
        self._reached, self._stage_s = self.stage, now
        self.counts.news += 1
        return [Outgoing(self._message(now, declarations=(own,))), *self._go_on(now)]

    def _hear(self, message: Message, now: float) -> None:
        """Take in who lives, and what is true for good."""
        heard = [Pulse(message.sender, message.incarnation, message.number), *message.pulses]
        for said in message.declarations:
            heard += map(Pulse, said.members, said.incarnations, (-1,) * len(said.members))
            self._learn(said.facts)
        self._learn(message.facts)
        for pulse in heard:
            if not self._is_mine(pulse) and self.members.hear(pulse, now):
                self._anew = True
                self._tell_all("anew", [pulse.robot])
        self._repairs.hear(message)

    def _is_mine(self, pulse: Pulse) -> bool:
        """Whether this is said of this robot itself; of another life than this one, it is of a rival or long past."""
        if pulse.robot != self.robot:
            return False
        number = self._number if pulse.incarnation == self.incarnation else -1
        if (pulse.incarnation >= self.incarnation and pulse.number > number) or pulse.incarnation > self.incarnation:
            if pulse.incarnation not in self.rivals:
                self.happenings.append(Happening("rival", (self.robot,)))
            self.rivals.add(pulse.incarnation)
        return True

    def _learn(self, facts: Collection[Fact]) -> None:
        if any(fact.done for fact in self._work.known.learn(facts)):
            self._tell_twice(self.twice)

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
        had_base = self.epoch.base is not None
        published = self.epoch.advance()
        if self.epoch.base is not None and not had_base:
            self._note_base(self.epoch.base)
        if self.stage != self._reached:
            self._reached, self._stage_s = self.stage, now
        if self.stage.ended and self._agreed_on != self.stage:
            self._agreed, self._agreed_on = {self.robot}, self.stage
            self.members.forgive(self.epoch.own.members)
            self._due_s = min(self._due_s, now)  # tell it at once
        self.counts.news += len(published)
        return [Outgoing(self._message(now, bids=(bids,), **self._last_sale())) for bids in published]

    def _note_base(self, base: Base) -> None:
        """Take in what all have declared."""
        self.epochs.append(self.epoch)
        self._shown = {self.robot}
        self._learn(base.facts)
        said = [d for d in map(self.epoch.declaration_of, self.epoch.own.members) if d is not None]
        me = self.epoch.own.members.index(self.robot)
        told = sum(d.knows and d.incarnations[me] == self.incarnation for d in said if d.robot != self.robot)
        self.knows = self.knows or told >= self.rules.majority
        self._work.give_up_lost(base.routes[self.robot])
        self.happenings += [Happening("dropped", (robot,), task) for robot, task in base.dropped]
        self._tell_twice(base.twice)

    def _note_agreement(self, message: Message) -> None:
        if self.epoch.base is not None and message.stage.base == self.epoch.base.digest:
            self._shown.add(message.sender)
            self._shown.update(message.agreed)
        if self.stage.ended and message.stage == self.stage:
            self._agreed.update(message.agreed)

    def _answer(self, message: Message, now: float) -> list[Outgoing]:
        """Send the sender of a message what it lacks, if that is here; not again at once."""
        what = self._repairs.answer(message, self.epoch, self._work.known, now)
        if what is None:
            return []
        self.counts.repairs += 1
        return [Outgoing(self._message(None, **what), message.sender)]

    def _lose_patience(self, now: float) -> None:
        """Leave out who is heard, but has kept the others waiting for `bid_s`."""
        if now - self._stage_s >= self.patience.bid_s:
            self._leave_out([r for r in self.epoch.lacks if r != self.robot], now)
            self._stage_s = now

    def _lose_patience_too(self, message: Message, now: float) -> None:
        """Leave out with the others whom one of them leaves out, if this robot has waited for it about as long."""
        if now - self._stage_s >= self.patience.bid_s / 2:
            waited = set(self.epoch.lacks).difference([self.robot, message.sender])
            self._leave_out(
                [
                    r
                    for r in sorted(waited)
                    if message.declarations and all(r not in d.members for d in message.declarations)
                ],
                now,
            )

    def _leave_out(self, robots: Collection[str], now: float) -> None:
        for robot in robots:
            if self.members.silent_s(robot, now) < self.patience.suspect_s / 2:
                self.members.mute(robot, now, bids=self.epoch.base is not None)
                self._tell_all("mute", [robot])

    def _is_outdated(self) -> bool:
        """Whether a member has started anew since it declared."""
        if not self._anew:
            return False
        said = map(self.epoch.declaration_of, self.epoch.own.members)
        return any(d is not None and self.members.incarnation(d.robot) > d.incarnation for d in said)

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
        said = [d for d in map(self.epoch.declaration_of, self.epoch.own.members) if d is not None]
        return self.epoch.ended and not self.knows and sum(d.knows for d in said) >= self.rules.majority

    def _beat(self, now: float) -> Message:
        """That the robot lives, whom it has heard, what it lacks; and what others may lack of its own words."""
        fresh = tuple(self._work.fresh)
        self._work.fresh.clear()
        self.counts.news += bool(fresh)
        self.counts.beats += not fresh
        known, said = self._work.known.digest, self._repairs.passed_on(self.epoch)
        return self._message(now, lacks=self.epoch.lacks, pulses=self._pulses(), facts=fresh, known=known, **said)

    def _message(self, sent_s: float | None, **said: Any) -> Message:
        """The next message; one that goes to all, at `sent_s`, puts off the next beat."""
        self._number += 1
        if sent_s is not None:
            wait = self.patience.beat_s if self.stage.ended else self.patience.retry_s
            self._due_s = sent_s + wait
        agreed = tuple(self._agreed) if self.stage.ended else ()
        return Message(self.robot, self.incarnation, self._number, self.stage, agreed=agreed, **said)

    def _last_sale(self) -> dict[str, Any]:
        """What came of the last round, for those that have missed some of its bids."""
        sales = self.epoch.sales
        return {"sales": (sales[-1],), "sales_from": len(sales) - 1} if sales else {}

    def _pulses(self) -> tuple[Pulse, ...]:
        return self.members.pulses(Pulse(self.robot, self.incarnation, self._number), list(self.rules.robots))

    def _present(self, now: float) -> tuple[str, ...]:
        return tuple(sorted(self.members.present(now), key=lambda robot: self.rules.robots[robot]))

    def _tell_all(self, kind: str, robots: Collection[str]) -> None:
        if robots:
            self.happenings.append(Happening(kind, tuple(robots)))

    def _tell_twice(self, twice: Mapping[str, tuple[str, ...]]) -> None:
        for task, robots in twice.items():
            if (task, robots) not in self._told:
                self._told.add((task, robots))
                self.happenings.append(Happening("twice", robots, task))
