"""The sales of single tasks in an epoch, as each robot computes them: the rules of the auction in one process."""

from __future__ import annotations

from collections.abc import Collection, Iterator, Mapping, Sequence

import numpy as np

from muster.allocation.allocator import Routes
from muster.allocation.auctions.auction_terms import Terms
from muster.allocation.auctions.auctioneer import Auctioneer
from muster.allocation.auctions.book_keeper import bids_of_round
from muster.allocation.auctions.winners import WINNER_RULES, Sale
from muster.mission.auction_book import Award
from muster.mission.auction_book import Bid as BookedBid
from muster.mission.values.arrays import Floats, Indices
from muster.model.problem import Problem
from muster_team.knowledge.messages import Bid, RoundBids, Sold


class TaskSales:
    """What was sold since these routes; all tasks that are neither in them nor closed are for sale."""

    def __init__(self, problem: Problem, terms: Terms, routes: Routes, closed: Collection[int]) -> None:
        self._problem, self._terms, self._closed = problem, terms, closed
        self._auctioneer = Auctioneer(problem, terms)
        self._auctioneer.restore(routes, {}, closed)

    @property
    def routes(self) -> Routes:
        return self._auctioneer.routes

    def bids(self, robot: int, refused: Collection[str]) -> tuple[Bid, ...]:
        """What a robot bids, as the winner rule needs it; none for tasks that it has refused."""
        bids = self._auctioneer.bids(robot)
        if refused:
            bids[[j for task, j in self._problem.task_index.items() if task in refused]] = np.inf
        if self._terms.winner == "lowest":
            j = int(np.argmin(bids))
            return ((self._problem.tasks[j].id, float(bids[j])),) if np.isfinite(bids[j]) else ()
        return tuple((self._problem.tasks[j].id, float(bids[j])) for j in np.flatnonzero(np.isfinite(bids)).tolist())

    def winner(self, bids: Sequence[RoundBids]) -> Sold | None:
        """The sale of a round with these bids of all members; None: there is none."""
        rule = WINNER_RULES[self._terms.winner](_Heard(self._problem.robot_index, self._problem.task_index, bids))
        rule.note(range(len(self._problem.robots)))
        sale = rule.winner()
        return None if sale is None else self._sold(sale)

    def may_bid(self, robot: int, task: int) -> bool:
        """Whether a robot can win a task in this round."""
        return self.can_win([(robot, task)])

    def can_win(self, pairs: Sequence[tuple[int, int]]) -> bool:
        """Whether a robot can win a task in this round; more than one pair cannot be won at once."""
        if len(pairs) != 1:
            return False
        ((robot, task),) = pairs
        is_for_sale = task not in self._closed and not any(task in route for route in self._auctioneer.routes)
        return is_for_sale and bool(np.isfinite(self._auctioneer.bids_for(task)[robot]))

    def award(self, sold: Sold) -> None:
        """Put a task into the route of its winner."""
        self._auctioneer.assign(self._sale_of(sold))

    def booked_bids(self, number: int, sold: Sold, members: Sequence[int]) -> Iterator[BookedBid]:
        """Every bid of the members in the round of this number, in which this is going to be sold."""
        self._auctioneer.round = number
        return bids_of_round(self._problem, self._auctioneer, self._sale_of(sold), members)

    def awards(self, number: int, sold: Sold, members: Sequence[int]) -> Iterator[Award]:
        """How the task that is going to be sold in the round of this number comes to its robot."""
        bids = self._auctioneer.bids_for(self._problem.task_index[sold.task])
        bidders = [i for i in members if np.isfinite(bids[i])]
        named = [(self._problem.robots[i].id, float(bids[i])) for i in sorted(bidders, key=lambda i: bids[i])]
        yield Award.of(number, sold.task, sold.robot, sold.price, named)

    def _sale_of(self, sold: Sold) -> Sale:
        """The same by index."""
        return Sale(self._problem.robot_index[sold.robot], self._problem.task_index[sold.task], sold.price)

    def _sold(self, sale: Sale) -> Sold:
        return Sold(self._problem.robots[sale.robot].id, self._problem.tasks[sale.task].id, sale.price)


class _Heard:
    """The bids of a round, in the form that a winner rule needs; robots that are not members bid for nothing."""

    def __init__(self, robots: Mapping[str, int], tasks: Mapping[str, int], bids: Sequence[RoundBids]) -> None:
        self.shape = (len(robots), len(tasks))
        self._bids = {robots[said.robot]: [(bid, tasks[task]) for task, bid in said.bids] for said in bids if said.bids}

    def bids(self, robot: int) -> Floats:
        bids = np.full(self.shape[1], np.inf)
        for bid, task in self._bids.get(robot, ()):
            bids[task] = bid
        return bids

    def lowest_bids(self) -> tuple[Indices, Floats]:
        tasks, lowest = np.zeros(self.shape[0], dtype=np.int64), np.full(self.shape[0], np.inf)
        for robot, bids in self._bids.items():
            lowest[robot], tasks[robot] = min(bids)
        return tasks, lowest
