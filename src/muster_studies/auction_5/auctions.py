"""One auction held, judged."""

from __future__ import annotations

import time
from collections.abc import Mapping
from dataclasses import dataclass

from muster.allocation.allocator import make_parameters
from muster.allocation.registry import allocator_named
from muster.allocation.stop import Stop
from muster.mission.auction_book import Bid
from muster.mission.plan import Plan
from muster.model.problem import Problem
from muster.verification import Verdict
from muster_studies.runs import accepted, mission_named

BIDS = ("total", "max", "average", "average-as-printed", "total+max", "makespan")
PUBLISHED_NAMES: Mapping[str, str] = {"total": "MiniSum", "max": "MiniMax", "average": "MiniAve"}


@dataclass(frozen=True, kw_only=True)
class Auction:
    """An auction: a mission and the terms."""

    mission: str
    bid: str
    placement: str
    winner: str = "lowest"


@dataclass(frozen=True)
class AuctionResult:
    """The result of an auction: its plan with the book, the verdict, and the processor time of the allocator alone."""

    plan: Plan
    verdict: Verdict
    cpu_s: float

    def bids(self) -> dict[int, dict[str, dict[str, Bid]]]:
        """Every bid, by round, robot and task."""
        found: dict[int, dict[str, dict[str, Bid]]] = {}
        for bid in self.plan.book.bids if self.plan.book else ():
            found.setdefault(bid.round, {}).setdefault(bid.robot, {})[bid.task] = bid
        return found


def hold(auction: Auction) -> AuctionResult:
    """Hold an auction.

    Raises
    ------
    MusterError
        if the judge rejects the plan, which no allocator may make happen.
    """
    mission, allocator = mission_named(auction.mission), allocator_named("auction")
    terms = {"bid": auction.bid, "placement": auction.placement, "winner": auction.winner}
    params, problem = make_parameters(allocator, terms), Problem.compile(mission).ready()
    begin = time.process_time()
    plan = allocator.solve(problem, Stop(), params=params)
    cpu_s = time.process_time() - begin
    return AuctionResult(plan, accepted(mission, plan, f"internal error: {auction}"), cpu_s)
