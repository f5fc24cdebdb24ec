"""The auctioneer of an auction in one process: it announces tasks, collects bids, selects winners and keeps records."""

from __future__ import annotations

from collections.abc import Callable, Collection, Sequence
from copy import copy

import numpy as np

from muster import core
from muster.allocation.allocator import Routes
from muster.allocation.auctions.auction_terms import BidTerms
from muster.allocation.auctions.bids import BID_RULES, Penalties, Standing, in_quanta, weighted
from muster.allocation.auctions.winners import WINNER_RULES, KeptLowest, Lowest, Sale, WinnerRule
from muster.allocation.stop import Stop
from muster.mission.values.arrays import Floats, Indices
from muster.model.problem import Problem

Sales = dict[int, tuple[int, Sale, Floats]]
"""By task: round, sale and (m,) the bids for the task, of the last time that it was sold."""
OnRound = Callable[["Auctioneer", Sale], None]


_PAIRS_AT_ONCE = 2_000_000  # of robot and task, announced between two looks at the clock


class Auctioneer:
    """Sells tasks one by one to the robots of a team: announce, then select and assign round by round.

    Tasks are sold only when their prerequisites are. `on_round` is told of every sale before the task is assigned. All
    tasks but those `closed` are announced at first, as far as there is time `until` that stops.
    """

    def __init__(
        self,
        problem: Problem,
        terms: BidTerms,
        routes: Routes | None = None,
        on_round: OnRound | None = None,
        until: Stop | None = None,
        closed: Collection[int] = (),
    ) -> None:
        self._problem = problem
        self._terms = terms
        self._rule = BID_RULES[terms.bid or problem.objective]
        self._bidders = core.Bidders(problem.core, insert=terms.placement == "insert", figure=self._rule.figure)
        by_task = terms.suitability_weight or terms.quality_weight  # the lowest figure need not make the lowest bid
        rule = WINNER_RULES[terms.winner_rule]
        self._penalties = Penalties(problem, terms)
        self._winner_rule: WinnerRule = KeptLowest(self) if by_task and rule is Lowest else rule(self)
        self._on_round = on_round
        self._robots = range(len(problem.robots))
        self._linked = any(problem.prerequisites)
        self.round = 0
        self.restore(routes or [list(problem.beginning(i)) for i in self._robots], {}, closed, until)

    @property
    def routes(self) -> Routes:
        return self._bidders.routes

    def restore(self, routes: Routes, sales: Sales, closed: Collection[int] = (), until: Stop | None = None) -> None:
        """Go back to these routes and the sales that led to them; all other tasks but those `closed` are announced."""
        self.sales = dict(sales)
        self._bidders.set_routes(routes)
        self._look_at_team()
        sold = {j for route in routes for j in route}
        self.announce([j for j in range(len(self._problem.tasks)) if j not in sold and j not in closed], until)

    def announce(self, tasks: Sequence[int], until: Stop | None = None) -> None:
        """Offer tasks; those to which it comes before it is time to stop."""
        at_once = max(1, _PAIRS_AT_ONCE // len(self._robots))
        for first in range(0, len(tasks), at_once):
            if until is not None and until.due():
                break
            self._bidders.announce(list(tasks[first : first + at_once]))
        self._winner_rule.note(self._robots)

    def sell(self, stop: Stop) -> bool:
        """Select and assign until nobody bids any more; whether it came so far before it was time to stop."""
        while not stop.due():
            if (sale := self.select()) is None:
                return True
            self.assign(sale)
        return False

    def select(self) -> Sale | None:
        """The sale of the next round; None if nobody bids for anything."""
        return self._winner_rule.winner() if self._problem.tasks else None

    def assign(self, sale: Sale) -> None:
        """Put the task into the winner's route."""
        self.round += 1
        if self._on_round is not None:
            self._on_round(self, sale)
        self.sales[sale.task] = self.round, sale, self.bids_for(sale.task)
        greatest = self._greatest_usage
        self._bidders.award(sale.robot, sale.task)
        self._look_at_team()
        others_too = self._linked or (self._rule.of_team and self._greatest_usage != greatest)
        self._winner_rule.note(self._robots if others_too else (sale.robot,), sale.task)

    def trial(self) -> Auctioneer:
        """A copy in which awards can be tried, and which this auction does not see."""
        tried = copy(self)
        tried._bidders, tried._winner_rule = self._bidders.copy(), Lowest(tried)
        tried.sales, tried._on_round = {}, None
        return tried

    def relinquish(self, task: int) -> list[int]:
        """Take a task out of its route, and all in routes that waits for it; returns them, to be announced again."""
        returned = self._bidders.relinquish(task)
        self._look_at_team()
        return returned

    @property
    def shape(self) -> tuple[int, int]:
        return len(self._problem.robots), len(self._problem.tasks)

    def bids(self, robot: int) -> Floats:
        """(n,) what a robot bids for each task; inf where it makes no bid."""
        bids = self._rule.bid(self._bidders.offers(robot), self._standing(robot))
        return self._weighted(bids, robot, slice(None))

    def bids_for(self, task: int) -> Floats:
        """(m,) what each robot bids for a task; inf where it makes no bid."""
        bids = self._rule.bid(self._bidders.offers_for(task), self._standing(slice(None)))
        return self._weighted(bids, slice(None), task)

    def lowest_bids(self) -> tuple[Indices, Floats]:
        """(m,) the task that each robot bids least for, and that bid; inf for a robot without bids."""
        chosen, figures = self._bidders.lowest()
        tasks = np.array(chosen)
        return tasks, self._weighted(self._rule.bid(figures, self._standing(slice(None))), slice(None), tasks)

    def _look_at_team(self) -> None:
        self._usages = self._bidders.usages
        self._greatest_usage = float(self._usages.max())
        self._lengths = np.array(self._bidders.lengths, dtype=np.float64)

    def _standing(self, robots: int | slice) -> Standing:
        return Standing(self._usages[robots], self._lengths[robots], self._greatest_usage)

    def _weighted(self, bids: Floats, robots: int | slice, tasks: int | slice | Indices) -> Floats:
        return in_quanta(weighted(bids, self._penalties.of(self._usages[robots], robots, tasks)))
