"""Auction with rising prices: in every round each robot is assigned one task, the sum of their bids is the least.

[bertsekas1988], the centralised market that [tcf-thesis], section 2.3, reviews: the price of a task rises until only
one robot still wants it. A round solves an assignment problem to within `precision` times its highest bid; as there
are more tasks than robots, rounds are repeated until nobody can take another task. What is optimal is each round, not
the plan: every robot takes a task in every round, whether it is near or not. Rounds: about n / m, each of some m^2
bids that look at n tasks.
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
from muster.mission.values.arrays import Floats
from muster.mission.values.ranges import require_within
from muster.model.problem import Problem
from muster_studies.alternatives.assignment_prices import assign


@dataclass(frozen=True, kw_only=True)
class Parameters(BidTerms):
    """Terms of bids, and the precision of a round.

    Raises
    ------
    ParameterError
        if one is out of range.
    """

    precision: float = 1e-3

    def __post_init__(self) -> None:
        super().__post_init__()
        require_within(1e-9, 1, precision=self.precision)


def allocate(problem: Problem, stop: Stop, seed: int, params: Parameters, start: Routes | None) -> Outcome:
    """Assign a task to each robot until nobody can do another; tasks in the start plan's routes stay there."""

    def hold(until: Stop, on_round: OnRound | None = None) -> Auctioneer:
        auctioneer = Auctioneer(problem, params, start, on_round, until)
        while not until.due():
            if not sell_one_to_each(problem, auctioneer, params.precision, until) and not until.due():
                return auctioneer
        until.cut()
        return auctioneer

    return held(problem, stop, hold)


def sell_one_to_each(problem: Problem, auctioneer: Auctioneer, precision: float, until: Stop) -> bool:
    """One round; whether anything was sold.

    An award can take away the place that another robot's bid was for (prerequisites across routes): then that robot
    waits for the next round.
    """
    if not problem.tasks:
        return False
    bids = np.array([auctioneer.bids(i) for i in range(len(problem.robots))])
    sold = False
    for robot, task in assignment(bids, precision):
        if until.due():
            break
        price = float(auctioneer.bids_for(task)[robot])
        if np.isfinite(price):
            auctioneer.assign(Sale(robot, task, price))
            sold = True
    return sold


def assignment(bids: Floats, precision: float) -> list[tuple[int, int]]:
    """Robots and their tasks, the lowest bid first: most robots get one, and the sum of bids is the least.

    `bids` is (m, n), inf where a robot makes none. An object for each robot stands for no task; it is worth less than
    any plan with one more task in it.
    """
    possible = np.isfinite(bids)
    tasks = np.flatnonzero(possible.any(axis=0))
    if not len(tasks):
        return []
    bids, possible = bids[:, tasks], possible[:, tasks]
    highest = max(1e-9, float(np.abs(bids[possible]).max()))
    robots = len(bids)
    no_task = -2.0 * (robots + 1) * highest
    benefit = np.full((robots, len(tasks) + robots), 2.0 * no_task * robots)
    benefit[:, : len(tasks)][possible] = -bids[possible]
    np.fill_diagonal(benefit[:, len(tasks) :], no_task)
    assigned = assign(benefit, precision * highest / robots)
    pairs = [(i, int(k)) for i, k in enumerate(assigned) if k < len(tasks) and possible[i, k]]
    pairs.sort(key=lambda pair: bids[pair])
    return [(i, int(tasks[k])) for i, k in pairs]


BERTSEKAS_AUCTION = Allocator(
    name="bertsekas-auction",
    summary="a task to each robot, round by round, at rising prices; reviewed in the TCF thesis",
    anytime=False,
    parameters=Parameters,
    algorithm=allocate,
    auctions=True,
)
