"""What robots tell each other. One kind of message: what a sender knows, and what it lacks.

Robots and tasks are named by their ids. Nothing in a message is a time: clocks of robots need not agree.
"""

from __future__ import annotations

from dataclasses import dataclass

Bid = tuple[str, float]
"""A task, and what is bid for it."""


@dataclass(frozen=True, slots=True)
class Claim:
    """A task that a robot owns: what it won it for, in which round, and whether it has begun it."""

    task: str
    price: float
    round: int
    begun: bool = False


@dataclass(frozen=True, slots=True)
class Fact:
    """Something that is true for ever once it is said.

    Parameters
    ----------
    task, robot
        of which task, and who says so.
    kind
        "done": the robot has done it. "begun": the robot has begun a task that nobody may begin twice, or is going to.
        "waived": it has not, and is never going to, in the life that said so. "added": the task belongs to the mission
        from now on. "moved": it is elsewhere. "cancelled": nobody need do it.
    order
        above that of all facts that the robot knew: what follows from another fact comes after it.
    content
        of "added" and "moved": the task, as `tasks.content_of` writes it. Of "begun" and "waived": the incarnation of
        the robot that was going to begin.
    """

    task: str
    robot: str
    kind: str
    order: int = 0
    content: bytes = b""

    @property
    def done(self) -> bool:
        return self.kind == "done"


@dataclass(frozen=True, slots=True)
class Declaration:
    """What a robot says of itself at the beginning of an epoch; made once for each epoch.

    Parameters
    ----------
    members
        the robots with which it is going to hold this epoch's auction, itself included, in tie order.
    route
        the tasks that it owns, in the order in which it is going to do them; what it has done is not among them.
    facts
        all that it knows, of others too, in order.
    rounds
        how many rounds it has seen in all.
    incarnations
        of each member the last that was heard of it; -1: nothing.
    knows
        whether it remembers all that it ever said: False from a start without memory until others have told it.
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


@dataclass(frozen=True, slots=True)
class RoundBids:
    """What a robot bids in a round of an epoch: nothing, its lowest bid, or all, as the winner rule asks."""

    robot: str
    round: int
    bids: tuple[Bid, ...]


@dataclass(frozen=True, slots=True)
class Sold:
    """What came of a round: a task went to a robot at a price."""

    robot: str
    task: str
    price: float


@dataclass(frozen=True, slots=True)
class Stage:
    """How far a robot is: which epoch, what all declared in it (empty: not known yet), how many rounds are resolved.

    `ended` tells that nobody bid any more.
    """

    epoch: int
    base: bytes = b""
    round: int = 0
    ended: bool = False


@dataclass(frozen=True, slots=True)
class Pulse:
    """The last that was heard of a robot, by whatever way: its incarnation, and the number of its message."""

    robot: str
    incarnation: int
    number: int


@dataclass(frozen=True, slots=True)
class Message:
    """How far a robot is, what it says, what it passes on, and what it lacks.

    Parameters
    ----------
    sender, incarnation, number
        who sends it; how often that robot has started, as it knows itself; a number that grows from message to message.
    stage
        how far the sender is. Declarations, bids and sales are of its epoch, bids and sales of its base.
    declarations, bids
        the sender's own, and those of others that somebody lacks.
    sales, sales_from
        what came of rounds, the first of which is `sales_from`.
    lacks
        robots whose declaration, or bids in this round, the sender waits for.
    pulses
        of a beat: its own, those of robots that others miss, and that of another one, in turn.
    misses
        robots that the sender has not heard for a while, or never, but from others.
    agreed
        members of which it knows that they are at the same stage, which has ended.
    facts, known
        facts that others may not know yet, and a digest of all that the sender knows; 0: none.
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
    pulses: tuple[Pulse, ...] = ()
    agreed: tuple[str, ...] = ()
    facts: tuple[Fact, ...] = ()
    known: int = 0
    misses: tuple[str, ...] = ()

    @property
    def pulse(self) -> Pulse:
        """That its sender lived."""
        return Pulse(self.sender, self.incarnation, self.number)

    @property
    def is_idle(self) -> bool:
        """Whether it is a beat: it tells nothing new, but that the sender lives, and what it lacks."""
        return bool(self.pulses) and not self.facts
