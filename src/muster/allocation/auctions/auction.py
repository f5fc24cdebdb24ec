"""Sequential single-item auction: in each round every robot bids, and one task is sold.

[auction-thesis], chapter 4; [lagoudakis2005]. Deterministic. A robot that can
do none of the tasks left makes no bid; a task is offered once its prerequisites are sold.
Where times, teams or relations bind tasks, coalitions bid (`CoalitionAuction`).
"""

from __future__ import annotations

from dataclasses import dataclass

from muster.allocation.allocator import Allocator, Outcome, Routes
from muster.allocation.auctions.auction_terms import Terms
from muster.allocation.auctions.auctioneer import Auctioneer, OnRound
from muster.allocation.auctions.book_keeper import held
from muster.allocation.auctions.coalitions import CoalitionAuction, OnBids, coalition_book
from muster.allocation.capabilities import FOR_GOOD
from muster.allocation.stop import Stop
from muster.model.problem import Problem


@dataclass(frozen=True, kw_only=True)
class Parameters(Terms):
    """Terms of the auction."""


def allocate(problem: Problem, stop: Stop, seed: int, params: Parameters, start: Routes | None) -> Outcome:
    """Sell all tasks that are not in the start plan's routes; without one, all but those that stay where they are."""
    if problem.core.is_timed:
        return _to_coalitions(problem, stop, params, start)

    def hold(until: Stop, on_round: OnRound | None = None) -> Auctioneer:
        auctioneer = Auctioneer(problem, params, start, on_round, until)
        if not auctioneer.sell(until):
            until.cut()
        return auctioneer

    return held(problem, stop, hold)


def _to_coalitions(problem: Problem, stop: Stop, params: Parameters, start: Routes | None) -> Outcome:
    """Sell units of work to coalitions of robots."""

    def hold_again(until: Stop, on_bids: OnBids) -> None:
        CoalitionAuction(problem, params, start).sell(until, on_bids)

    auction = CoalitionAuction(problem, params, start)
    if not auction.sell(stop):
        stop.cut()
    stop.improved(*problem.value(auction.routes))
    return Outcome(auction.routes, coalition_book(problem, auction.sales, hold_again))


AUCTION = Allocator(
    name="auction",
    summary="tasks sold one by one to the best bid; the auction thesis",
    anytime=False,
    parameters=Parameters,
    algorithm=allocate,
    auctions=True,
    keeps_fixed=True,
    can=FOR_GOOD,
)
