"""What one robot knows of an auction without a centre: who owns what, and how that came. Plain data; goes to others."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

from muster.negotiation.epoch import Epoch, opening_of
from muster.negotiation.epoch_base import Base
from muster.negotiation.messages import Claim, RoundBids, Sold, Stage
from muster.negotiation.negotiator import Negotiator
from muster.negotiation.valuation import Opening

Routes = Mapping[str, tuple[str, ...]]
"""By robot its tasks, in the order in which it does them."""


@dataclass(frozen=True)
class Held:
    """The auction of an epoch, as far as it was seen.

    Parameters
    ----------
    members
        who could bid, in tie order.
    rounds
        seen in all before it.
    opening
        how things stood when it began.
    sales
        in order.
    published
        what members bid, by round; empty where sales tell all.
    whole
        whether that is all rounds.
    """

    members: tuple[str, ...]
    rounds: int
    opening: Opening
    sales: tuple[Sold, ...]
    published: tuple[tuple[RoundBids, ...], ...] = ()
    whole: bool = True


@dataclass(frozen=True)
class View:
    """What a robot knows.

    Parameters
    ----------
    robot
        whose view it is.
    stage
        how far the robot is.
    routes
        of all robots that have any; what was done stands first.
    claims
        of members: by robot what it owns, for which price, won in which round.
    twice
        tasks begun or done by several robots, with these.
    added
        tasks that the mission did not have, as `tasks.content_of` writes them, in tie order.
    auctions
        one an epoch, the last one last.
    sent
        messages that the robot has sent.
    """

    robot: str
    stage: Stage
    routes: Routes
    claims: Mapping[str, tuple[Claim, ...]]
    twice: Routes
    added: tuple[bytes, ...]
    auctions: tuple[Held, ...]
    sent: int

    @property
    def rounds(self) -> int:
        """How many rounds were seen in all."""
        return self.auctions[-1].rounds + len(self.auctions[-1].sales) if self.auctions else 0


def view_of(negotiator: Negotiator) -> View:
    """What a robot knows now; between two epochs, what it knew in the last."""
    epochs, counts = negotiator.epochs, negotiator.counts
    auctions = tuple(held for epoch in epochs if (held := _held(epoch)) is not None)
    last = epochs[-1].base if epochs else None
    routes = {} if last is None else {robot: tuple(negotiator.valuer.route(robot)) for robot in negotiator.rules.robots}
    return View(
        robot=negotiator.robot,
        stage=negotiator.stage,
        routes={robot: tasks for robot, tasks in routes.items() if tasks},
        claims={} if last is None else _claims(last, epochs[-1]),
        twice={} if last is None else dict(negotiator.twice),
        added=() if last is None else tuple(fact.content for fact in last.added),
        auctions=auctions,
        sent=counts.news + counts.repairs + counts.beats,
    )


def _held(epoch: Epoch) -> Held | None:
    if epoch.base is None:
        return None
    published = () if epoch.valuer.told_by_sales else epoch.published()
    whole = epoch.valuer.told_by_sales or len(published) == epoch.round
    return Held(epoch.own.members, epoch.base.rounds, opening_of(epoch.base), tuple(epoch.sales), published, whole)


def _claims(base: Base, epoch: Epoch) -> dict[str, tuple[Claim, ...]]:
    claims = {robot: list(owned) for robot, owned in base.routes.items()}
    for number, sold in enumerate(epoch.sales, base.rounds + 1):
        claims[sold.robot].append(Claim(sold.task, sold.price, number))
    return {robot: tuple(owned) for robot, owned in claims.items()}
