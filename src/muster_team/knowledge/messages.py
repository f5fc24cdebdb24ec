"""The protocol's message and its parts: what the sender knows, and what it lacks.

Robots and tasks are named by their ids. What is agreed depends on no time: the clocks of robots need not agree. Only
the facts of a joint begin contain times, those of the mission.
"""

from __future__ import annotations

from dataclasses import dataclass, field

Bid = tuple[str, float]
"""A task, and what is bid for it."""


@dataclass(frozen=True, slots=True)
class Claim:
    """A task that a robot owns: the price and the round in which it won the task, and whether it has begun it."""

    task: str
    price: float
    round: int
    begun: bool = False


FACTS = ("done", "begun", "waived", "added", "moved", "cancelled", "ready", "left", "joined", "part", "revoked")
"""The kinds of facts."""

AUTHORITY = "@operator"
"""Who revokes keys of robots, in place of a robot: its public key stands under this name in the roster."""

ORDERS = ("added", "moved")
"""The kinds of facts that contain a task."""

PRESENCE = ("ready", "left", "joined", "part")
"""The kinds of facts that robots state of a task that they begin together."""


@dataclass(frozen=True, slots=True)
class Fact:
    """A statement that stays true.

    Parameters
    ----------
    task, robot
        the task, and the robot that states the fact. Of "revoked": the robot whose key is revoked, and AUTHORITY.
    kind
        "done": the robot has done the task. "begun": the robot has begun an at-most-once task or is going to. "waived":
        it has not and never will, in the incarnation that announced it. "added": the task belongs to the mission from
        now on. "moved": it has another position. "cancelled": it need not be done. "ready", "left", "joined" and
        "part": of a task that several robots begin at the same moment, see `joint_statements`. "revoked": the
        robot does not take part any more, and nothing that it states from then on counts.
    order
        above that of all facts that the robot knew, so that a fact comes after those that it follows from.
    content
        of "added" and "moved": the task, as `new_tasks.content_of` writes it. Of "begun" and "waived": the incarnation
        that announced the task. Of "ready", "left", "joined" and "part": as `joint_statements` writes it.
    proof
        by the key of the robot: see `signatures`; empty where robots have no keys.
    """

    task: str
    robot: str
    kind: str
    order: int = 0
    content: bytes = b""
    proof: bytes = b""

    @property
    def done(self) -> bool:
        return self.kind == "done"

    @property
    def opens_epoch(self) -> bool:
        """Whether all have to learn of it in a new epoch, as it changes what is for sale or who may begin."""
        return self.kind in ("begun", "waived", "added", "moved", "cancelled", "revoked")


@dataclass(frozen=True, slots=True)
class Reach:
    """How many pieces of the map a robot has that another one made in one of its lives, without a gap."""

    robot: str
    life: int
    pieces: int


@dataclass(frozen=True, slots=True)
class Declaration:
    """What a robot declares at the beginning of an epoch, once per epoch.

    Parameters
    ----------
    members
        the robots that take part in this epoch's auction as this robot sees it, itself included, in tie order.
    route
        the tasks that it owns and has not done, in the order of execution.
    facts
        all facts that it knows, in causal order.
    rounds
        the number of rounds that it has seen in all.
    incarnations
        for each member the highest incarnation heard of; -1: none.
    knows
        whether it remembers everything that it has ever stated; False after a start without memory until others have
        told it.
    seen
        the pieces of the map that it has, where robots build one.
    proof
        by the key of the robot: see `signatures`; empty where robots have no keys.
    """

    robot: str
    incarnation: int
    epoch: int
    members: tuple[str, ...]
    route: tuple[Claim, ...] = ()
    facts: tuple[Fact, ...] = ()
    rounds: int = 0
    incarnations: tuple[int, ...] = ()
    knows: bool = True
    seen: tuple[Reach, ...] = ()
    proof: bytes = b""


@dataclass(frozen=True, slots=True)
class RoundBids:
    """The bids of a robot in one round of an epoch: none, its lowest, or all, depending on the winner rule.

    `proof`: by its key, of these bids on the base of the epoch.
    """

    robot: str
    round: int
    bids: tuple[Bid, ...]
    proof: bytes = b""


@dataclass(frozen=True, slots=True)
class Sold:
    """The result of a round: a task went to a robot at a price.

    `others`: the other robots, with their tasks, where several robots won a task, or tasks that begin together.
    """

    robot: str
    task: str
    price: float
    others: tuple[tuple[str, str], ...] = ()

    @property
    def winner(self) -> str:
        """The robots, for people: `r_0+r_1`."""
        return "+".join(dict.fromkeys(robot for robot, _ in self.assignments))

    @property
    def what(self) -> str:
        """The tasks, for people."""
        return ", ".join(dict.fromkeys(task for _, task in self.assignments))

    @property
    def assignments(self) -> tuple[tuple[str, str], ...]:
        """All robots that won, each with its task."""
        return ((self.robot, self.task), *self.others)


@dataclass(frozen=True, slots=True)
class Stage:
    """The progress of a robot: its epoch, the digest of the epoch's base (empty: not known yet), rounds resolved.

    `ended`: nobody bids any more. `routes`: then a digest of all routes, as the robot computes them from what was sold;
    stages are equal whatever it is.
    """

    epoch: int
    base: bytes = b""
    round: int = 0
    ended: bool = False
    routes: bytes = field(default=b"", compare=False)


@dataclass(frozen=True, slots=True)
class Heartbeat:
    """The last sign of life of a robot, direct or relayed: its incarnation and the number of its message.

    Number 0 is no sign of life: it tells those that accept an earlier incarnation that this one is known, and silent.
    """

    robot: str
    incarnation: int
    number: int


@dataclass(frozen=True, slots=True)
class Birth:
    """A start of a robot, with the proof by its key, so that nobody can pretend that it has started again."""

    robot: str
    incarnation: int
    proof: bytes = b""


@dataclass(frozen=True, slots=True)
class Evidence:
    """Two statements of one robot of which it may make one: it does not follow the protocol.

    `context`: what both belong to, as they were signed.
    """

    context: bytes
    first: Declaration | RoundBids
    second: Declaration | RoundBids

    @property
    def robot(self) -> str:
        return self.first.robot


@dataclass(frozen=True, slots=True)
class Message:
    """The sender's progress, its own statements, what it relays, and what it lacks.

    Parameters
    ----------
    sender, incarnation, number
        the sender; the number of its start; the number of the message, which grows.
    stage
        the sender's progress. Declarations, bids and sales belong to its epoch, bids and sales to its base.
    declarations, bids
        the sender's own, and those of others that a robot lacks.
    sales, sales_from
        results of rounds, and the number of the first of these.
    lacks
        robots whose declaration, or bids in this round, the sender waits for.
    heartbeats
        in a heartbeat: its own, those of robots that others do not hear, and one other in turn.
    agreed
        members that are known to be at the same ended stage.
    facts, known
        facts that others may lack, and a digest of all facts that the sender knows; 0: none.
    unheard
        robots that the sender has not heard directly for a while, or never.
    births
        the starts of the robots in `heartbeats`; none where robots have no keys.
    evidence
        against robots that have stated two different things.
    """

    sender: str
    incarnation: int
    number: int
    stage: Stage
    declarations: tuple[Declaration, ...] = ()
    bids: tuple[RoundBids, ...] = ()
    sales: tuple[Sold, ...] = ()
    sales_from: int = 0
    lacks: tuple[str, ...] = ()
    heartbeats: tuple[Heartbeat, ...] = ()
    agreed: tuple[str, ...] = ()
    facts: tuple[Fact, ...] = ()
    known: int = 0
    unheard: tuple[str, ...] = ()
    births: tuple[Birth, ...] = ()
    evidence: tuple[Evidence, ...] = ()

    @property
    def heartbeat(self) -> Heartbeat:
        """The sign of life that the message is."""
        return Heartbeat(self.sender, self.incarnation, self.number)

    @property
    def is_idle(self) -> bool:
        """Whether it is a mere heartbeat, without news of the sender."""
        return bool(self.heartbeats) and not self.facts
