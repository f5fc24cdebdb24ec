"""What a robot bids, and where a task goes that is won: the rules of the auction in one process, asked by one robot.

Every robot keeps all routes, since some bids look at the team (`total+max`), or wait for others (`makespan`); but it
asks for its own bids alone. The same mission, terms and sales give the same bids, bit by bit, so that robots can follow
each other's routes without a word.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Protocol

import numpy as np

from muster.allocation.auctioneer import Auctioneer
from muster.allocation.problem import Problem
from muster.allocation.terms import Terms
from muster.allocation.winners import WINNER_RULES, Floats, Indices, Sale
from muster.negotiation.messages import Bid, RoundBids, Sold


class Valuer(Protocol):
    """What one robot's part in the auction needs to know of the mission."""

    def begin(self, routes: Mapping[str, Sequence[str]]) -> None:
        """An auction begins: these tasks have owners, all others are for sale."""
        ...

    def bids(self) -> tuple[Bid, ...]:
        """What the robot bids in this round, as the winner rule wants it."""
        ...

    def winner(self, bids: Sequence[RoundBids]) -> Sold | None:
        """What comes of a round in which all members bid this; None: nobody bids any more."""
        ...

    def award(self, sold: Sold) -> None:
        """A task has an owner."""
        ...

    def route(self, robot: str) -> list[str]:
        """The tasks of a robot, in the order in which it is going to do them."""
        ...


class AuctionValuer:
    """The auction of `allocation`, held by one of its robots.

    Parameters
    ----------
    problem, terms
        the same for all robots.
    robot
        which one this is.
    """

    def __init__(self, problem: Problem, terms: Terms, robot: str) -> None:
        self._problem, self.terms = problem, terms
        self._robots = {r.id: i for i, r in enumerate(problem.robots)}
        self._tasks = {t.id: j for j, t in enumerate(problem.tasks)}
        self._me = self._robots[robot]
        self._auctioneer = Auctioneer(problem, terms)

    def begin(self, routes: Mapping[str, Sequence[str]]) -> None:
        by_index: list[list[int]] = [[] for _ in self._problem.robots]
        for robot, tasks in routes.items():
            by_index[self._robots[robot]] = [self._tasks[task] for task in tasks]
        self._auctioneer.restore(by_index, {})

    def bids(self) -> tuple[Bid, ...]:
        if not self._tasks:
            return ()
        bids = self._auctioneer.bids(self._me)
        if self.terms.winner == "lowest":
            j = int(np.argmin(bids))
            return ((self._problem.tasks[j].id, float(bids[j])),) if np.isfinite(bids[j]) else ()
        return tuple((self._problem.tasks[j].id, float(bids[j])) for j in np.flatnonzero(np.isfinite(bids)).tolist())

    def winner(self, bids: Sequence[RoundBids]) -> Sold | None:
        heard = _Heard(self._robots, self._tasks, bids)
        if not any(said.bids for said in bids):
            return None
        rule = WINNER_RULES[self.terms.winner](heard)
        rule.note(range(len(self._robots)))
        sale = rule.winner()
        return None if sale is None else self._sold(sale)

    def award(self, sold: Sold) -> None:
        self._auctioneer.assign(Sale(self._robots[sold.robot], self._tasks[sold.task], sold.price))

    def route(self, robot: str) -> list[str]:
        return [self._problem.tasks[j].id for j in self._auctioneer.routes[self._robots[robot]]]

    def _sold(self, sale: Sale) -> Sold:
        return Sold(self._problem.robots[sale.robot].id, self._problem.tasks[sale.task].id, sale.price)


class _Heard:
    """The bids of a round, as a winner rule asks for them; who is not a member bids for nothing."""

    def __init__(self, robots: Mapping[str, int], tasks: Mapping[str, int], bids: Sequence[RoundBids]) -> None:
        self.shape = (len(robots), len(tasks))
        self._bids = np.full(self.shape, np.inf)
        for said in bids:
            for task, bid in said.bids:
                self._bids[robots[said.robot], tasks[task]] = bid

    def bids(self, robot: int) -> Floats:
        bids: Floats = self._bids[robot]
        return bids

    def lowest_bids(self) -> tuple[Indices, Floats]:
        tasks = np.argmin(self._bids, axis=1)
        return tasks, self._bids[np.arange(len(tasks)), tasks]
