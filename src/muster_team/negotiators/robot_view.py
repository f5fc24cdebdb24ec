"""One robot's view of the auction: who owns what, and how that came about. Plain data that can be sent."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

from muster_team.auctions.epoch import Epoch, EpochAuction
from muster_team.knowledge.epoch_base import Base
from muster_team.knowledge.messages import Claim, Stage
from muster_team.negotiators.negotiator import Negotiator

Routes = Mapping[str, tuple[str, ...]]
"""The tasks of each robot, in the order of execution."""


@dataclass(frozen=True)
class View:
    """What a robot knows.

    Parameters
    ----------
    robot
        the robot whose view it is.
    stage
        its progress.
    routes
        of all robots that have any; tasks that were done come first.
    claims
        for each member what it owns, with prices and rounds.
    twice
        tasks begun or done by several robots, with these.
    added
        tasks that were added to the mission, as `new_tasks.content_of` writes them, in tie order.
    auctions
        of the last epochs, at most `participant.PAST` + 1, the last one last.
    together
        whether the whole team took part in all auctions, those of earlier epochs among them.
    sent
        the number of messages that the robot has sent.
    """

    robot: str
    stage: Stage
    routes: Routes
    claims: Mapping[str, tuple[Claim, ...]]
    twice: Routes
    added: tuple[bytes, ...]
    auctions: tuple[EpochAuction, ...]
    together: bool
    sent: int

    @property
    def rounds(self) -> int:
        """The number of rounds seen in all."""
        return self.auctions[-1].rounds + len(self.auctions[-1].sales) if self.auctions else 0


def view_of(negotiator: Negotiator) -> View:
    """What a robot knows now; between two epochs, what it knew in the last one."""
    latest, counts = negotiator.latest, negotiator.counts
    auctions = () if latest is None else (*negotiator.past, latest.auction)
    last = None if latest is None else latest.base
    routes = {} if last is None else {robot: tuple(negotiator.valuer.route(robot)) for robot in negotiator.rules.robots}
    return View(
        robot=negotiator.robot,
        stage=negotiator.stage,
        routes={robot: tasks for robot, tasks in routes.items() if tasks},
        claims={} if latest is None or last is None else _claims(last, latest),
        twice={} if last is None else dict(negotiator.twice),
        added=() if last is None else tuple(fact.content for fact in last.added),
        auctions=auctions,
        together=negotiator.together,
        sent=counts.news + counts.repairs + counts.heartbeats,
    )


def _claims(base: Base, epoch: Epoch) -> dict[str, tuple[Claim, ...]]:
    claims = {robot: list(owned) for robot, owned in base.routes.items()}
    for number, sold in enumerate(epoch.sales, base.rounds + 1):
        for robot, task in sold.assignments:
            claims[robot].append(Claim(task, sold.price, number))
    return {robot: tuple(owned) for robot, owned in claims.items()}
