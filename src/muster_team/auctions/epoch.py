"""One epoch: all members declare what they own, then the remaining tasks are auctioned round by round.

Auction thesis, section 4.2.3 and Algorithm 1: each robot publishes one bid per round under its own id, receives the
others' bids, finds the winner itself, and removes the task from its list. Everything that members do in an epoch
follows from their declarations and from bids that follow from these. So all members resolve a round alike, and results
can be relayed.
"""

from __future__ import annotations

import json
from collections import defaultdict
from collections.abc import Collection, Sequence
from dataclasses import dataclass, field
from hashlib import blake2b

from muster_team.auctions.valuation import Opening, Valuer
from muster_team.knowledge.epoch_base import Base, agreed
from muster_team.knowledge.facts import deeds
from muster_team.knowledge.joint_statements import Members
from muster_team.knowledge.messages import Claim, Declaration, Evidence, RoundBids, Sold, Stage
from muster_team.knowledge.rules import Rules
from muster_team.knowledge.signatures import NO_KEYS, Signatures

EARLY = 4
"""How many bids a member, before it has found the base, keeps of each member."""

AHEAD = 1
"""How many rounds others may be ahead: without this member's bids they do not come further."""


Statement = Declaration | RoundBids


@dataclass(frozen=True)
class EpochAuction:
    """The auction of an epoch, as far as the robot has seen it.

    Parameters
    ----------
    members
        the robots that could bid, in tie order.
    rounds
        the number of rounds seen in all before it.
    opening
        the state of the mission when it began.
    sales
        in order.
    published
        the members' bids by round; empty where sales contain everything.
    whole
        whether these are all rounds.
    """

    members: tuple[str, ...]
    rounds: int
    opening: Opening
    sales: tuple[Sold, ...]
    published: tuple[tuple[RoundBids, ...], ...] = ()
    whole: bool = True


@dataclass
class Epoch:
    """An epoch as one member sees it.

    Parameters
    ----------
    own
        the member's declaration, with the epoch's number and members.
    rules, valuer
        the rules of the mission, and the computation of bids.
    refused
        tasks for which this member does not bid.
    stage
        its progress.
    signatures
        the proofs of who has stated what.
    """

    own: Declaration
    rules: Rules
    valuer: Valuer
    refused: Collection[str] = ()
    base: Base | None = None
    sales: list[Sold] = field(default_factory=list)
    stage: Stage = field(init=False)
    signatures: Signatures = NO_KEYS
    _declared: dict[str, Declaration] = field(default_factory=dict)
    _waits_for: set[str] = field(default_factory=set)  # members that have not declared the same members
    _bids: defaultdict[int, dict[str, RoundBids]] = field(default_factory=lambda: defaultdict(dict))
    _early: list[tuple[bytes, RoundBids]] = field(default_factory=list)  # of those that found the base before this one

    _evidence: list[Evidence] = field(default_factory=list)
    _refused: list[tuple[str, str]] = field(default_factory=list)  # the robot, "" for any, and the reason
    _void: set[tuple[int, str]] = field(default_factory=set)  # rounds and robots whose bids were refused

    def __post_init__(self) -> None:
        self.stage = Stage(self.own.epoch)
        self._declared[self.own.robot] = self.own
        self._waits_for = set(self.own.members) - {self.own.robot}

    @property
    def round(self) -> int:
        return self.stage.round

    @property
    def ended(self) -> bool:
        return self.stage.ended

    def hear_declaration(self, declaration: Declaration) -> bool:
        """Note a member's declaration; return whether the epoch can go on now."""
        robot = declaration.robot
        self._compare(b"", self._declared.get(robot), declaration)
        if self.base is not None or declaration.epoch != self.own.epoch or robot == self.own.robot:
            return False
        if self._declared.get(robot) == declaration:
            return False
        self._declared[robot] = declaration
        if declaration.members == self.own.members:
            self._waits_for.discard(robot)
        elif robot in self.own.members:
            self._waits_for.add(robot)
        return not self._waits_for

    def hear_bids(self, digest: bytes, bids: RoundBids) -> bool:
        """Note a member's bids on a base; return whether the epoch can go on now."""
        if self.base is None:
            if len(self._early) < EARLY * len(self.own.members):
                self._early.append((digest, bids))
            return False
        if digest != self.base.digest or bids.robot not in self.base.routes:
            return False
        if not self.stage.round <= bids.round <= self.stage.round + AHEAD or (bids.round, bids.robot) in self._void:
            return False
        heard = self._bids[bids.round]
        if bids.robot in heard:
            self._compare(digest, heard[bids.robot], bids)
            return False
        heard[bids.robot] = bids
        return bids.round == self.stage.round and len(heard) == len(self.own.members)

    def learn(self, stage: Stage, sales: Sequence[Sold], sales_from: int) -> bool:
        """Take over what another member has resolved on the same base; return whether the epoch can go on now."""
        if self.base is None or stage.base != self.base.digest:
            return False
        if not (self.valuer.sales_suffice or (stage.ended and sales)):
            return False  # it has to go through the rounds itself, or take over all that came of them
        before, known = self.stage, len(self.sales)
        for sold in sales[max(0, known - sales_from) :] if sales_from <= known else ():
            if self.ended or (reason := self.valuer.sale_fault(sold)):
                self._refused += [] if self.ended else [("", reason)]
                break
            self._sell(sold)
            self._reach(self.round + self.valuer.sales_suffice)
        complete = self.round == stage.round if self.valuer.sales_suffice else sales_from <= known
        if stage.ended and complete and not self.ended:
            self._reach(stage.round, ended=True)
        return self.stage is not before

    def advance(self) -> list[RoundBids]:
        """Advance as far as the received messages allow; return this member's new bids."""
        published: list[RoundBids] = []
        if self.base is None and not self._begin():
            return published
        while not self.ended:
            heard = self._bids[self.round]
            if self.own.robot not in heard:
                own = RoundBids(self.own.robot, self.round, self.valuer.bids(self.refused))
                assert self.base is not None
                heard[self.own.robot] = self.signatures.sign(own, self.base.digest)
                published.append(heard[self.own.robot])
            if len(heard) == len(self.own.members):
                self._void_bids(heard)
            if len(heard) < len(self.own.members):
                break
            resolution = self.valuer.resolve([heard[robot] for robot in self.own.members])
            for sold in resolution.sales:
                self._sell(sold)
            self._reach(self.round + (bool(resolution.sales) or not resolution.over), ended=resolution.over)
        return published

    def take_refused(self) -> list[tuple[str, str]]:
        """What was refused since the last call: the robot that said it, or "" for the sender, and the reason."""
        refused, self._refused = self._refused, []
        return refused

    def take_evidence(self) -> list[Evidence]:
        """Statements that contradict each other, since the last call."""
        evidence, self._evidence = self._evidence, []
        return evidence

    def _compare(self, context: bytes, first: Statement | None, second: Statement) -> None:
        """Note two different statements of one robot; whether they convict it is for `signatures` to say."""
        if first is not None and first != second:
            self._evidence.append(Evidence(context, first, second))

    def _void_bids(self, heard: dict[str, RoundBids]) -> None:
        """Take out bids that no member can mean in this round: their robots keep the others waiting, and are excluded.

        All members do so alike, as they know what is for sale.
        """
        for robot in [robot for robot in heard if robot != self.own.robot]:
            if reason := self.valuer.bids_fault(heard[robot]):
                del heard[robot]
                self._void.add((self.round, robot))
                self._refused.append((robot, reason))

    @property
    def lacks(self) -> tuple[str, ...]:
        """Members for whose declaration, or bids in this round, this one waits."""
        if self.base is None:
            return tuple(robot for robot in self.own.members if robot in self._waits_for)
        if self.ended:
            return ()
        heard = self._bids.get(self.round, {})
        return tuple(robot for robot in self.own.members if robot not in heard)

    def published(self) -> tuple[tuple[RoundBids, ...], ...]:
        """The bids of all members by round, up to the first round that was not heard completely."""
        rounds = []
        for number in range(self.round):
            heard = self._bids.get(number, {})
            if len(heard) < len(self.own.members):
                break
            rounds.append(tuple(heard[robot] for robot in self.own.members))
        return tuple(rounds)

    @property
    def declarations(self) -> list[Declaration]:
        """The declarations of members that were heard."""
        return [self._declared[robot] for robot in self.own.members if robot in self._declared]

    def declaration_of(self, robot: str) -> Declaration | None:
        return self._declared.get(robot)

    def bids_of(self, robot: str, number: int) -> RoundBids | None:
        return self._bids.get(number, {}).get(robot)

    @property
    def rounds(self) -> int:
        """The number of rounds seen in all, counted by sales: awards are numbered so."""
        return (self.own.rounds if self.base is None else self.base.rounds) + len(self.sales)

    @property
    def auction(self) -> EpochAuction:
        """What is kept of the epoch when another one follows; its base has been found."""
        assert self.base is not None
        published = () if self.valuer.sales_suffice else self.published()
        whole = self.valuer.sales_suffice or len(published) == self.round
        opening = opening_of(self.base)
        return EpochAuction(self.own.members, self.base.rounds, opening, tuple(self.sales), published, whole)

    def route(self) -> tuple[Claim, ...]:
        """What this member owns now, in the order of its route."""
        if self.base is None:
            return self.own.route
        owned = self.base.routes[self.own.robot]
        claims = {claim.task: claim for claim in owned if not claim.begun}
        for number, sold in enumerate(self.sales, self.base.rounds + 1):
            for robot, task in sold.assignments:
                if robot == self.own.robot:
                    claims[task] = Claim(task, sold.price, number)
        ahead = (claims[task] for task in self.valuer.route(self.own.robot) if task in claims)
        return (*(claim for claim in owned if claim.begun), *ahead)

    def owners(self, tasks: Collection[str]) -> Members:
        """The members that own one of these tasks, in order, each with its task; none before the base is found."""
        owned = {} if self.base is None else self.base.routes
        claimed = [(robot, claim.task) for robot, claims in owned.items() for claim in claims]
        claimed += [pair for sold in self.sales for pair in sold.assignments]
        return tuple(sorted((robot, task) for robot, task in claimed if task in tasks))

    def _begin(self) -> bool:
        """Find the base if all members have declared the same members; return whether it was found."""
        if self._waits_for:
            return False
        base = agreed(self.declarations, self.rules)
        self.base = base.keeping(self.valuer.begin(opening_of(base)))
        self._reach(0)
        for digest, bids in self._early:
            self.hear_bids(digest, bids)
        self._early.clear()
        return True

    def sees_other_routes(self, stage: Stage) -> bool:
        """Whether a member at the same end has computed other routes from the same sales: its processor rounds so."""
        return self.ended and stage == self.stage and stage.routes not in (b"", self.stage.routes)

    def _reach(self, number: int, *, ended: bool = False) -> None:
        assert self.base is not None
        self.stage = Stage(self.own.epoch, self.base.digest, number, ended, self._digest_of_routes() if ended else b"")

    def _digest_of_routes(self) -> bytes:
        assert self.base is not None
        routes = {robot: self.valuer.route(robot) for robot in self.base.routes}
        return blake2b(json.dumps(routes, sort_keys=True).encode(), digest_size=4).digest()

    def _sell(self, sold: Sold) -> None:
        self.valuer.award(sold)
        self.sales.append(sold)


def opening_of(base: Base) -> Opening:
    """The state of the mission on a base. A task that was done or begun several times counts for the first of them."""
    past: dict[str, list[str]] = {}
    done = deeds(base.facts)
    counted = [(fact.task, fact.robot) for fact in base.done if fact in done[fact.task][0]]
    over = set(done)
    for robot, claims in base.routes.items():
        for claim in claims:
            if claim.begun and claim.task not in over:
                over.add(claim.task)
                counted.append((claim.task, robot))
    for task, robot in counted:
        past.setdefault(robot, []).append(task)
    ahead = {robot: [claim.task for claim in claims if not claim.begun] for robot, claims in base.routes.items()}
    return Opening(past, ahead, base.closed, tuple(fact.content for fact in base.added), base.seen)
