"""Market with relinquishing and annealing.

[market-paper], Algorithm 1. With `usage: time` the cost of a route is the
paper's A + B, travel by speed and work by efficiency, bounded by the energy as work capacity; its objective is `max`.

Where the text leaves room: the first auction stands before the loop, so that a plan is there whatever the number of
iterations; the best allocation is kept apart from the current one, which a worse one replaces with the probability
`ro`, else the current one comes back; a task that others wait for takes those with it when it is given back; bids are
those of the objective.
"""

from __future__ import annotations

from dataclasses import dataclass
from random import Random

from muster import core
from muster.allocation.allocator import Allocator, Outcome, Routes
from muster.allocation.auctions.auction_terms import Terms
from muster.allocation.auctions.auctioneer import Auctioneer, OnRound, Sales
from muster.allocation.auctions.book_keeper import book_of
from muster.allocation.capabilities import BY_OBJECTIVE
from muster.allocation.stop import Stop
from muster.mission.values.ranges import require_counts, require_within
from muster.model.problem import Problem

_TRADING = 0.9  # share of a time limit; the rest is for the annealing


@dataclass(frozen=True, kw_only=True)
class Parameters(Terms):
    """Terms of its auctions, and parameters of the market.

    Raises
    ------
    ParameterError
        if one is out of range.
    """

    ro: float = 0.5  # "user define percentage"; high values did best on the shipped missions
    annealing_steps: int = 20_000  # for each route

    def __post_init__(self) -> None:
        super().__post_init__()
        require_within(0, 1, ro=self.ro)
        require_counts(0, annealing_steps=self.annealing_steps)


def allocate(problem: Problem, stop: Stop, seed: int, params: Parameters, start: Routes | None) -> Outcome:
    """Algorithm 1: trade, then optimize the order of each route (24)."""

    def hold(until: Stop, on_round: OnRound | None = None) -> Allocation:
        return trade(problem, until, seed, params, start, on_round)

    best = hold(stop)
    routes = optimize(problem, stop, seed, params, best.routes)
    return Outcome(routes, book_of(problem, best.round, best.sales, hold))


@dataclass(frozen=True)
class Allocation:
    """Routes, how good they are, and the sales that led to them."""

    rank: tuple[float, float]
    """Minus the weight done, and the objective: lower is better."""
    routes: Routes
    round: int
    sales: Sales


def trade(
    problem: Problem, stop: Stop, seed: int, params: Parameters, start: Routes | None, on_round: OnRound | None
) -> Allocation:
    """Lines 8 to 23; the best allocation."""
    random = Random(seed)
    with stop.first_plan():
        auctioneer = Auctioneer(problem, params, start, on_round, stop)
        before = _allocation(problem, auctioneer)
        if not auctioneer.sell(stop):
            stop.cut()
    current = _allocation(problem, auctioneer)
    best = min(before, current, key=_rank)
    stop.improved(-best.rank[0], best.rank[1])
    for _ in stop.iterations():
        if stop.share_of_time > _TRADING:
            break
        relinquish(auctioneer, random)  # 15, of the iteration before
        auctioneer.sell(stop)  # 10 to 14
        new = _allocation(problem, auctioneer)
        if new.rank < best.rank:  # 16 and 17
            best = new
            stop.improved(-best.rank[0], best.rank[1])
        if new.rank <= current.rank or params.ro > random.random():  # 19 and 20
            current = new
        else:
            auctioneer.restore(current.routes, current.sales)
    return best


def relinquish(auctioneer: Auctioneer, random: Random) -> None:
    """Every robot gives one random task back."""
    returned: set[int] = set()
    for route in auctioneer.routes:
        left = [task for task in route if task not in returned]
        if left:
            returned.update(auctioneer.relinquish(random.choice(left)))
    auctioneer.announce(sorted(returned))


def optimize(problem: Problem, stop: Stop, seed: int, params: Parameters, routes: Routes) -> Routes:
    """Simulated annealing of each robot's order."""
    annealing = core.Annealing(problem.core, routes, seed)
    for robot in range(len(routes)):
        if stop.due():
            break
        annealing.anneal(robot, params.annealing_steps)
    stop.improved(*problem.value(annealing.routes))
    return annealing.routes


def _allocation(problem: Problem, auctioneer: Auctioneer) -> Allocation:
    routes = auctioneer.routes
    weight, objective = problem.value(routes)
    sales = {j: auctioneer.sales[j] for route in routes for j in route if j in auctioneer.sales}
    return Allocation((-weight, objective), routes, auctioneer.round, sales)


def _rank(allocation: Allocation) -> tuple[float, float]:
    return allocation.rank


MARKET = Allocator(
    name="market",
    summary="auctions in which robots give tasks back, then annealing; the market paper",
    anytime=True,
    parameters=Parameters,
    algorithm=allocate,
    auctions=True,
    can=BY_OBJECTIVE,
)
