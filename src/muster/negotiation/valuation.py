"""What a robot bids, and where a task goes that is won: the rules of the auction in one process, asked by one robot.

Every robot keeps all routes, since some bids look at the team (`total+max`), or wait for others (`makespan`); but it
asks for its own bids alone. The same mission, terms and sales give the same bids, bit by bit, so that robots can follow
each other's routes without a word.
"""

from __future__ import annotations

from collections.abc import Collection, Mapping, Sequence
from dataclasses import dataclass, field
from typing import Protocol

import numpy as np

from muster.allocation.auctioneer import Auctioneer
from muster.allocation.fixed import admissible_part, with_past
from muster.allocation.problem import Problem
from muster.allocation.terms import Terms
from muster.allocation.winners import WINNER_RULES, Floats, Indices, Sale
from muster.mission.model import Task
from muster.negotiation.messages import Bid, RoundBids, Sold
from muster.negotiation.tasks import content_of, with_tasks


@dataclass(frozen=True)
class Opening:
    """How things stand when an auction begins.

    Parameters
    ----------
    past
        for each robot what it has done and then what it has begun, in order; no task stands twice.
    ahead
        for each robot what else it owns, in order.
    closed
        tasks that are not for sale.
    added
        tasks that the mission did not have, as `tasks.content_of` writes them, in tie order.
    """

    past: Mapping[str, Sequence[str]] = field(default_factory=dict)
    ahead: Mapping[str, Sequence[str]] = field(default_factory=dict)
    closed: Collection[str] = ()
    added: tuple[bytes, ...] = ()


class Valuer(Protocol):
    """What one robot's part in the auction needs to know of the mission."""

    def check(self, task: Task) -> None:
        """Whether a new task fits into the mission; raises MissionError if not."""
        ...

    def begin(self, opening: Opening) -> Mapping[str, Sequence[str]]:
        """An auction begins; returns what robots own as far as they can still do it, behind their past."""
        ...

    def bids(self, refused: Collection[str] = ()) -> tuple[Bid, ...]:
        """What the robot bids in this round, as the winner rule wants it; nothing for what it has refused."""
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
        self.terms = terms
        self._given, self._robots = problem, problem.robot_index
        self._me = self._robots[robot]
        self._added: tuple[bytes, ...] = ()
        self._whole = problem
        self._take_up(problem)

    def check(self, task: Task) -> None:
        with_tasks(self._whole, [content_of(task)])

    def begin(self, opening: Opening) -> Mapping[str, Sequence[str]]:
        if opening.added != self._added:
            self._added, self._whole = opening.added, with_tasks(self._given, opening.added)
        number = self._whole.task_index
        past, ahead = self._by_index(opening.past, number), self._by_index(opening.ahead, number)
        self._take_up(with_past(self._whole, past) if any(past) else self._whole)
        begun = [self._problem.beginning(i) for i in range(len(past))]
        routes = admissible_part(self._problem, [[*before, *after] for before, after in zip(begun, ahead, strict=True)])
        closed = {number[task] for task in opening.closed}.union(*past)
        self._auctioneer.restore(routes, {}, closed)
        return {robot.id: self.route(robot.id)[len(begun[i]) :] for i, robot in enumerate(self._problem.robots)}

    def bids(self, refused: Collection[str] = ()) -> tuple[Bid, ...]:
        if not self._tasks:
            return ()
        bids = self._auctioneer.bids(self._me)
        if refused:
            bids[[j for task, j in self._tasks.items() if task in refused]] = np.inf
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

    def _take_up(self, problem: Problem) -> None:
        self._problem, self._tasks = problem, problem.task_index
        self._auctioneer = Auctioneer(problem, self.terms)

    def _by_index(self, routes: Mapping[str, Sequence[str]], number: Mapping[str, int]) -> list[list[int]]:
        by_index: list[list[int]] = [[] for _ in self._robots]
        for robot, tasks in routes.items():
            by_index[self._robots[robot]] = [number[task] for task in tasks]
        return by_index

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
