"""The sales of units of work in an epoch, as each robot computes them, where times, teams and relations bind tasks.

The rules of `allocation.coalitions`, for one robot. All robots keep all routes, so all know the earliest schedule that
follows from them, and a bid is what that schedule allows. For one robot's task a robot bids what it would take it for.
Of a team's task it bids for a place, with its usage so far, unless it has refused it. The members then compute the same
coalitions of those that bid, and what each would take it for ([shehory1998], [vig2006]); so a task is won only by
robots that each have bid for it.
"""

from __future__ import annotations

from collections.abc import Collection, Iterator, Sequence
from dataclasses import dataclass

from muster.allocation.allocator import Routes
from muster.allocation.auctions.auction_terms import Terms
from muster.allocation.auctions.coalitions import (
    CoalitionAuction,
    CoalitionBid,
    CoalitionSale,
    awards_of,
    bids_of_round,
    in_turn,
)
from muster.mission.auction_book import Award
from muster.mission.auction_book import Bid as BookedBid
from muster.model.problem import Problem
from muster_team.knowledge.messages import Bid, RoundBids, Sold


class UnitSales:
    """What was sold since these routes; units of which no task is in them or closed are for sale."""

    def __init__(self, problem: Problem, terms: Terms, routes: Routes, closed: Collection[int]) -> None:
        self._problem, self._terms, self._closed = problem, terms, closed
        self._auction = CoalitionAuction(problem, terms, routes)

    @property
    def routes(self) -> Routes:
        return self._auction.routes

    def spans(self) -> dict[str, tuple[float, float]]:
        """For each task sold when it begins and ends in the earliest schedule of all routes, seconds."""
        return {self._problem.tasks[task].id: span for task, span in self._auction.spans().items()}

    def bids(self, robot: int, refused: Collection[str]) -> tuple[Bid, ...]:
        """What a robot bids, as the winner rule needs it; none for units with tasks that it has refused."""
        units = [unit for unit in self._for_sale() if not any(task in refused for task in self._names(unit))]
        own = sorted(
            (bid for unit in units if self._auction.is_alone(unit) for bid in self._auction.bids(unit, [robot])),
            key=lambda bid: bid.key,
        )
        held = (bid for bid in own if self._auction.holds(bid))
        chosen = list(held) if self._terms.winner_rule == "least-contested" else [b for b in (next(held, None),) if b]
        prices = tuple((self._names(bid.unit)[0], bid.price) for bid in chosen)
        return (*prices, *self._places(robot, [unit for unit in units if not self._auction.is_alone(unit)]))

    def winner(self, bids: Sequence[RoundBids]) -> Sold | None:
        """The sale of a round with these bids of all members; None: there is none."""
        offers = {unit: self._offers(unit, bids) for unit in self._for_sale()}
        ranked = (self._sold(unit, best) for unit, best in in_turn(offers, self._terms))
        return next((sold for sold in ranked if sold is not None), None)

    def may_bid(self, robot: int, task: int) -> bool:
        """Whether a robot can win the task of a unit in this round, or may ask for a place in it."""
        unit = self._problem.model.unit[task]
        if self._auction.is_alone(unit):
            return self.can_win([(robot, task)])
        return unit in self._for_sale() and self._problem.may(robot, task)

    def can_win(self, pairs: Sequence[tuple[int, int]]) -> bool:
        """Whether robots can win the tasks of a unit in this round, each its own."""
        units = {self._problem.model.unit[task] for _, task in pairs}
        if len(units) != 1 or not units.issubset(self._for_sale()):
            return False
        bid = self._auction.best_bid(units.pop(), sorted({robot for robot, _ in pairs}))
        if bid is None or sorted((task, robot) for robot, task in pairs) != _members(bid):
            return False
        return self._auction.holds(bid)

    def award(self, sold: Sold) -> None:
        """Put a unit into the routes of its winners."""
        bid = self._bid_of(sold)
        if not self._auction.assign(bid):
            raise ValueError(f"{sold}; expected a unit that the schedule holds")

    def booked_bids(self, number: int, sold: Sold, members: Sequence[int]) -> Iterator[BookedBid]:
        """Every bid of the members in the round of this number, in which this is going to be sold."""
        unit = self._unit(sold)
        offers = [self._sale(number, other, members) for other in self._for_sale() if other != unit]
        offers.append(self._won(number, sold, members))
        ordered = sorted((offer for offer in offers if offer.bids), key=lambda offer: offer.won.unit)
        return bids_of_round(self._problem, ordered, unit)

    def awards(self, number: int, sold: Sold, members: Sequence[int]) -> Iterator[Award]:
        """How the unit that is going to be sold in the round of this number comes to its robots."""
        return awards_of(self._problem, self._won(number, sold, members))

    def _for_sale(self) -> list[int]:
        units = self._problem.model.units
        return [unit for unit in self._auction.ready() if not any(task in self._closed for task in units[unit])]

    def _names(self, unit: int) -> list[str]:
        return [self._problem.tasks[task].id for task in self._problem.model.units[unit]]

    def _unit(self, sold: Sold) -> int:
        return self._problem.model.unit[self._problem.task_index[sold.task]]

    def _places(self, robot: int, units: Sequence[int]) -> Iterator[Bid]:
        """The tasks of units for several robots that a robot may do, with its usage so far."""
        for unit in units:
            for task in self._problem.model.units[unit]:
                if self._problem.may(robot, task):
                    yield self._problem.tasks[task].id, self._auction.usage(robot)

    def _offers(self, unit: int, bids: Sequence[RoundBids]) -> list[_Winners]:
        """The bids for a unit, the best first."""
        heard = self._heard(unit, bids)
        if self._auction.is_alone(unit):
            alone = [_Winners((self._leaves_no_time(unit, robot), price), (robot,)) for robot, price in heard.items()]
            return sorted(alone, key=lambda bid: (bid.key, bid.robots))
        coalitions = self._auction.bids(unit, sorted(heard)) if heard else []
        return [_Winners(bid.key, tuple(bid.robots)) for bid in coalitions]

    def _leaves_no_time(self, unit: int, robot: int) -> bool:
        """Whether by the bid of this robot something not sold yet could not be in time any more, as all compute it."""
        bid = self._auction.best_bid(unit, [robot])
        return bid is None or bid.leaves_no_time

    def _heard(self, unit: int, bids: Sequence[RoundBids]) -> dict[int, float]:
        """For each robot that bids for a unit its bid."""
        names, number = set(self._names(unit)), self._problem.robot_index
        return {number[said.robot]: price for said in bids for task, price in said.bids if task in names}

    def _sold(self, unit: int, best: _Winners) -> Sold | None:
        """The sale of a unit by a bid; None: the schedule does not hold it."""
        if self._auction.is_alone(unit):
            return Sold(self._problem.robots[best.robots[0]].id, self._names(unit)[0], best.key[1])
        bid = self._auction.best_bid(unit, best.robots)
        if bid is None or not self._auction.holds(bid):
            return None
        (robot, task), *others = self._assignments(bid)
        return Sold(robot, task, bid.price, tuple(others))

    def _assignments(self, bid: CoalitionBid) -> list[tuple[str, str]]:
        """Robots and their tasks, in tie order."""
        return [(self._problem.robots[robot].id, self._problem.tasks[task].id) for task, robot in _members(bid)]

    def _bid_of(self, sold: Sold) -> CoalitionBid:
        robots = sorted({self._problem.robot_index[robot] for robot, _ in sold.assignments})
        bid = self._auction.best_bid(self._unit(sold), robots)
        if bid is None:
            raise ValueError(f"{sold}; expected a unit that these robots can do")
        return bid

    def _sale(self, number: int, unit: int, members: Sequence[int]) -> CoalitionSale:
        return CoalitionSale(number, self._auction.bids(unit, members))

    def _won(self, number: int, sold: Sold, members: Sequence[int]) -> CoalitionSale:
        """The sale with all bids for its unit, that of the winners first."""
        won = self._bid_of(sold)
        others = [bid for bid in self._auction.bids(won.unit, members) if bid.robots != won.robots]
        return CoalitionSale(number, [won, *others])


@dataclass(frozen=True)
class _Winners:
    """Robots that would do a unit, and what for: as `CoalitionBid.key`."""

    key: tuple[bool, float]
    robots: tuple[int, ...]


def _members(bid: CoalitionBid) -> list[tuple[int, int]]:
    """The tasks of a bid, each with a robot of it, ascending."""
    return sorted((task, robot) for task, robot, _ in bid.insertion.members)
