"""Keeps the book of an auction in one process: its rounds, their bids and winners."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator

import numpy as np

from muster.allocation.allocator import Outcome
from muster.allocation.auctions.auctioneer import Auctioneer, OnRound, Sales
from muster.allocation.auctions.winners import Sale
from muster.allocation.stop import Stop
from muster.mission.auction_book import Award, Bid, Book, TakeBid
from muster.model.problem import Problem

Hold = Callable[[Stop, OnRound], object]
"""Holds an auction until it is stopped."""


def held(problem: Problem, stop: Stop, hold: Callable[[Stop, OnRound | None], Auctioneer]) -> Outcome:
    """The plan of an auction that is held until it is time to stop, with its book."""
    auction = hold(stop, None)
    stop.improved(*problem.value(auction.routes))
    return Outcome(auction.routes, book_of(problem, auction.round, auction.sales, hold))


def book_of(problem: Problem, rounds: int, sales: Sales, hold: Hold) -> Book:
    """The book of an auction that was held for so many rounds.

    The sales were kept. Every bid of every round would fill the memory: to tell them, the auction is held again.
    """

    def for_each_bid(take: TakeBid) -> None:
        stop = Stop()

        def tell(auctioneer: Auctioneer, sale: Sale) -> None:
            for bid in bids_of_round(problem, auctioneer, sale, range(len(problem.robots))):
                take(bid)
            if auctioneer.round == rounds:
                stop.interrupt()

        if rounds:
            hold(stop, tell)

    return Book(rounds=rounds, awards=tuple(_awards(problem, sales)), for_each_bid=for_each_bid)


def bids_of_round(problem: Problem, auctioneer: Auctioneer, sale: Sale, robots: Iterable[int]) -> Iterator[Bid]:
    """Every bid of some robots in the round that ends with this sale."""
    winner = problem.robots[sale.robot].id
    for i in robots:
        bids = auctioneer.bids(i)
        for j in np.flatnonzero(np.isfinite(bids)).tolist():
            won = j == sale.task
            yield Bid(
                round=auctioneer.round,
                task=problem.tasks[j].id,
                robot=problem.robots[i].id,
                bid=float(bids[j]),
                winner=winner if won else None,
                price=sale.price if won else None,
            )


def _awards(problem: Problem, sales: Sales) -> Iterator[Award]:
    for number, sale, bids in sorted(sales.values(), key=lambda entry: entry[0]):
        order = np.argsort(bids, kind="stable")[: np.isfinite(bids).sum()]
        named = [(problem.robots[i].id, float(bids[i])) for i in order.tolist()]
        robot, task = problem.robots[sale.robot].id, problem.tasks[sale.task].id
        yield Award.of(number, task, robot, sale.price, named)
