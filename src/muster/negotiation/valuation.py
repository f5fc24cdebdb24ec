"""A robot's bids, and the place of a won task in its route: the rules of the auction in one process, for one robot.

Every robot keeps all routes, since some bids depend on the team (`total+max`), or wait for others (`makespan`). It
computes only its own bids. The same mission, terms and sales give exactly the same bids, so that robots follow each
other's routes without messages.
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Collection, Mapping, Sequence
from dataclasses import dataclass, field
from typing import Protocol

import numpy as np

from muster.allocation.allocator import Routes
from muster.allocation.auction_terms import Terms
from muster.allocation.auctioneer import Auctioneer
from muster.allocation.fixed import admissible_part, with_past
from muster.allocation.problem import Problem
from muster.allocation.winners import WINNER_RULES, Floats, Indices, Sale
from muster.negotiation.capabilities import refuse_what_is_not_agreed
from muster.negotiation.messages import Bid, RoundBids, Sold
from muster.negotiation.new_tasks import with_tasks


@dataclass(frozen=True)
class Opening:
    """The state of the mission when an auction begins.

    Parameters
    ----------
    past
        for each robot what it has done and then what it has begun, in order; no task occurs twice.
    ahead
        for each robot what else it owns, in order.
    closed
        tasks that are not for sale.
    added
        tasks that were added to the mission, as `new_tasks.content_of` writes them, in tie order.
    """

    past: Mapping[str, Sequence[str]] = field(default_factory=dict)
    ahead: Mapping[str, Sequence[str]] = field(default_factory=dict)
    closed: Collection[str] = ()
    added: tuple[bytes, ...] = ()


@dataclass(frozen=True)
class Resolution:
    """The result of a round: the tasks sold, and whether it was the last round."""

    sales: tuple[Sold, ...] = ()
    over: bool = False


class Valuer(Protocol):
    """The computation of one robot's part in the auction."""

    @property
    def sales_suffice(self) -> bool:
        """Whether a robot that missed rounds needs to know only what was sold in them; else also what was bid."""
        ...

    def check(self, tasks: Sequence[bytes]) -> None:
        """Raise MissionError unless these added or moved tasks, as `new_tasks.content_of` writes them, fit.

        ParameterError if robots cannot agree on them (`capabilities`).
        """
        ...

    def begin(self, opening: Opening) -> Mapping[str, Sequence[str]]:
        """Begin an auction; return what robots own as far as they can still do it, without their past."""
        ...

    def bids(self, refused: Collection[str] = ()) -> tuple[Bid, ...]:
        """The robot's bids in this round, as the winner rule needs them; none for tasks that it has refused."""
        ...

    def resolve(self, bids: Sequence[RoundBids]) -> Resolution:
        """The result of a round with these bids of all members; not awarded yet."""
        ...

    def award(self, sold: Sold) -> None:
        """Assign a task to its owner."""
        ...

    def route(self, robot: str) -> list[str]:
        """The tasks of a robot, in the order of execution."""
        ...


class TeamValuer(ABC):
    """Common parts of all methods: the mission with its added tasks, and what robots own already.

    Parameters
    ----------
    problem
        the same for all robots; from `begin` on with added tasks and past work.
    robot
        the robot whose bids are computed.
    """

    def __init__(self, problem: Problem, robot: str) -> None:
        refuse_what_is_not_agreed(problem)
        self._given = self._whole = self.problem = problem
        self._robots, self._tasks = problem.robot_index, problem.task_index
        self._me = self._robots[robot]
        self._added: tuple[bytes, ...] = ()

    def check(self, tasks: Sequence[bytes]) -> None:
        refuse_what_is_not_agreed(with_tasks(self._given, tasks))

    def begin(self, opening: Opening) -> Mapping[str, Sequence[str]]:
        if opening.added != self._added:
            self._added, self._whole = opening.added, with_tasks(self._given, opening.added)
        number = self._whole.task_index
        past, ahead = self._by_index(opening.past, number), self._by_index(opening.ahead, number)
        self.problem = with_past(self._whole, past) if any(past) else self._whole
        self._tasks = self.problem.task_index
        begun = [self.problem.beginning(i) for i in range(len(past))]
        routes = admissible_part(self.problem, [[*before, *after] for before, after in zip(begun, ahead, strict=True)])
        closed = {number[task] for task in opening.closed}.union(*past)
        self._open(routes, closed)
        return {robot.id: self.route(robot.id)[len(begun[i]) :] for i, robot in enumerate(self.problem.robots)}

    @abstractmethod
    def _open(self, routes: Routes, closed: Collection[int]) -> None:
        """Begin an auction: these tasks have owners, all others are for sale except for those that are closed."""

    @abstractmethod
    def route(self, robot: str) -> list[str]: ...

    def _by_index(self, routes: Mapping[str, Sequence[str]], number: Mapping[str, int]) -> list[list[int]]:
        by_index: list[list[int]] = [[] for _ in self._robots]
        for robot, tasks in routes.items():
            by_index[self._robots[robot]] = [number[task] for task in tasks]
        return by_index


class AuctionValuer(TeamValuer):
    """The auction of `allocation`, run by one of its robots; `terms` are the same for all."""

    sales_suffice = True

    def __init__(self, problem: Problem, terms: Terms, robot: str) -> None:
        super().__init__(problem, robot)
        self.terms = terms

    def _open(self, routes: Routes, closed: Collection[int]) -> None:
        self.auctioneer = Auctioneer(self.problem, self.terms)
        self.auctioneer.restore(routes, {}, closed)

    def bids(self, refused: Collection[str] = ()) -> tuple[Bid, ...]:
        if not self._tasks:
            return ()
        bids = self.auctioneer.bids(self._me)
        if refused:
            bids[[j for task, j in self._tasks.items() if task in refused]] = np.inf
        if self.terms.winner == "lowest":
            j = int(np.argmin(bids))
            return ((self.problem.tasks[j].id, float(bids[j])),) if np.isfinite(bids[j]) else ()
        return tuple((self.problem.tasks[j].id, float(bids[j])) for j in np.flatnonzero(np.isfinite(bids)).tolist())

    def resolve(self, bids: Sequence[RoundBids]) -> Resolution:
        if not any(said.bids for said in bids):
            return Resolution(over=True)
        rule = WINNER_RULES[self.terms.winner](_Heard(self._robots, self._tasks, bids))
        rule.note(range(len(self._robots)))
        sale = rule.winner()
        return Resolution(over=True) if sale is None else Resolution((self._sold(sale),))

    def award(self, sold: Sold) -> None:
        self.auctioneer.assign(self.sale_of(sold))

    def route(self, robot: str) -> list[str]:
        return [self.problem.tasks[j].id for j in self.auctioneer.routes[self._robots[robot]]]

    def sale_of(self, sold: Sold) -> Sale:
        """The same by index."""
        return Sale(self._robots[sold.robot], self._tasks[sold.task], sold.price)

    def _sold(self, sale: Sale) -> Sold:
        return Sold(self.problem.robots[sale.robot].id, self.problem.tasks[sale.task].id, sale.price)


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
