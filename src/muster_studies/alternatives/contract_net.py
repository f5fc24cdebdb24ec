"""Contract net: every task is announced once, bid for, and awarded at once.

The protocol of [smith1980], as reviewed by [auction-thesis], section 3.2: there are no rounds in which all open tasks
compete, and no award is taken back. Deterministic. Tasks are announced in the order of the mission or by priority,
each after its prerequisites; one for which nobody bids is not announced again. n awards, each from one bid of each
robot.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

from muster.allocation.allocator import Allocator, Outcome, Routes
from muster.allocation.auctions.auction_terms import BidTerms
from muster.allocation.auctions.auctioneer import Auctioneer, OnRound
from muster.allocation.auctions.book_keeper import held
from muster.allocation.stop import Stop
from muster.mission.errors import ParameterError
from muster.model.problem import Problem

ORDERS = ("mission", "priority")


@dataclass(frozen=True, kw_only=True)
class Parameters(BidTerms):
    """Terms of bids, and the order of announcements.

    Raises
    ------
    ParameterError
        if one is out of range.
    """

    order: str = "mission"

    def __post_init__(self) -> None:
        super().__post_init__()
        if self.order not in ORDERS:
            raise ParameterError(f"order: {self.order}; expected {' or '.join(ORDERS)}")


def allocate(problem: Problem, stop: Stop, seed: int, params: Parameters, start: Routes | None) -> Outcome:
    """Announce, collect bids, award; tasks in the start plan's routes stay there."""

    def hold(until: Stop, on_round: OnRound | None = None) -> Auctioneer:
        manager = Auctioneer(problem, params, start, on_round, closed=range(len(problem.tasks)))
        done = {j for route in start or () for j in route}
        for task in announcements(problem, params.order):
            if task in done:
                continue
            if until.due():
                until.cut()
                break
            manager.announce([task])
            sale = manager.select()
            if sale is not None:
                manager.assign(sale)
        return manager

    return held(problem, stop, hold)


def announcements(problem: Problem, order: str) -> Iterator[int]:
    """All tasks in the order of the mission, or the most important first; each after its prerequisites."""
    tasks = [problem.task_index[task.id] for task in problem.mission.tasks]
    if order == "priority":
        tasks.sort(key=lambda j: -problem.tasks[j].priority)
    announced: set[int] = set()
    for task in tasks:
        waiting = [task]
        while waiting:
            before = [k for k in problem.prerequisites[waiting[-1]] if k not in announced]
            if before:
                waiting.append(before[0])
                continue
            next_task = waiting.pop()
            if next_task not in announced:
                announced.add(next_task)
                yield next_task


CONTRACT_NET = Allocator(
    name="contract-net",
    summary="every task announced, bid for and awarded once; reviewed in the auction thesis",
    anytime=False,
    parameters=Parameters,
    algorithm=allocate,
    auctions=True,
)
