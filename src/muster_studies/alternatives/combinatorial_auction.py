"""Combinatorial auction: robots bid on bundles of tasks, and the bids that gain most together win.

The alternative that [auction-thesis], section 4.2.2, names; bundles of up to three tasks, as in [berhault2003]. In a
round a robot grows a bundle from each of the `seeds` tasks that it bids least for, each time by the task that gains
most; its bid on the bundle is the sum of its bids for the tasks one after the other. A task is worth `worth` times the
highest single bid of the round, times its priority; a bundle gains what its tasks are worth, less the bid. Each robot
wins at most one bundle a round.

Optimal is the choice of winners among the bids of a round, where it takes at most `combinations` (`bundle_clearing`);
not the bundles that are bid on, nor the rounds together. Rounds: at least n / (m b) for bundles of b tasks; a round
has m times `seeds` times b trials of a route.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from muster.allocation.allocator import Allocator, Outcome, Routes
from muster.allocation.auctions.auction_terms import BidTerms
from muster.allocation.auctions.auctioneer import Auctioneer, OnRound
from muster.allocation.auctions.book_keeper import held
from muster.allocation.auctions.winners import Sale
from muster.allocation.stop import Stop
from muster.mission.errors import ParameterError
from muster.mission.values.arrays import Floats
from muster.mission.values.ranges import require_counts
from muster.model.problem import Problem
from muster_studies.alternatives.bundle_clearing import BundleBid, clear


@dataclass(frozen=True, kw_only=True)
class Parameters(BidTerms):
    """Terms of bids, and of bundles.

    Raises
    ------
    ParameterError
        if one is out of range.
    """

    bundle_size: int = 3
    seeds: int = 10
    worth: float = 2.0
    combinations: int = 20_000

    def __post_init__(self) -> None:
        super().__post_init__()
        require_counts(1, bundle_size=self.bundle_size, seeds=self.seeds, combinations=self.combinations)
        if not 1 < self.worth <= 1e6:
            raise ParameterError(f"worth: {self.worth:g}; expected a number above 1, at most 1e+06")


def allocate(problem: Problem, stop: Stop, seed: int, params: Parameters, start: Routes | None) -> Outcome:
    """Round by round until nobody bids; tasks in the start plan's routes stay there."""

    def hold(until: Stop, on_round: OnRound | None = None) -> Auctioneer:
        auctioneer = Auctioneer(problem, params, start, on_round, until)
        while not until.due() and (bids := bundle_bids(problem, auctioneer, params, until)) is not None:
            if not award(auctioneer, clear(bids, params.combinations).winners, until) and not until.due():
                return auctioneer
        until.cut()
        return auctioneer

    return held(problem, stop, hold)


def award(auctioneer: Auctioneer, winners: tuple[BundleBid, ...], until: Stop) -> bool:
    """Sell the tasks of the winners one after the other; whether any was sold.

    What another winner's tasks made impossible (prerequisites across routes) is not sold in this round.
    """
    sold = False
    for bid in winners:
        for task in bid.tasks:
            price = float(auctioneer.bids_for(task)[bid.robot])
            if until.due() or not np.isfinite(price):
                break
            auctioneer.assign(Sale(bid.robot, task, price))
            sold = True
    return sold


def bundle_bids(problem: Problem, auctioneer: Auctioneer, params: Parameters, until: Stop) -> list[BundleBid] | None:
    """The bids of all robots in a round; None if it is time to stop before all have bid."""
    if not problem.tasks:
        return []
    single = np.array([auctioneer.bids(i) for i in range(len(problem.robots))])
    finite = np.isfinite(single)
    if not finite.any():
        return []
    highest = max(1e-9, float(np.abs(single[finite]).max()))
    priority = np.array([task.priority for task in problem.tasks])
    worth = np.where(finite.any(axis=0), params.worth * highest * priority, -np.inf)
    bids: list[BundleBid] = []
    for i, own in enumerate(single):
        if until.due():
            return None
        seeds = np.argsort(own, kind="stable")[: params.seeds]
        for task in seeds[np.isfinite(own[seeds])].tolist():
            bids += grown(auctioneer.trial(), i, task, worth, params.bundle_size)
    return bids


def grown(trial: Auctioneer, robot: int, task: int, worth: Floats, size: int) -> list[BundleBid]:
    """A robot's bids on the bundle of one task, of two, and so on; the next is always the task that gains most."""
    bids: list[BundleBid] = []
    tasks: tuple[int, ...] = ()
    gains, gain = worth - trial.bids(robot), 0.0
    while np.isfinite(gains[task]):
        gain += float(gains[task])
        tasks = (*tasks, task)
        bids.append(BundleBid(robot, tasks, gain))
        if len(tasks) == size:
            break
        trial.assign(Sale(robot, task, 0.0))
        gains = worth - trial.bids(robot)
        task = int(np.argmax(gains))
    return bids


COMBINATORIAL_AUCTION = Allocator(
    name="combinatorial-auction",
    summary="bids on bundles of tasks, the best choice of winners; reviewed in the auction thesis",
    anytime=False,
    parameters=Parameters,
    algorithm=allocate,
    auctions=True,
)
