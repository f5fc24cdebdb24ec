"""An auction in which units of work are sold to coalitions of robots, where times, teams and relations bind tasks.

Sequential single-item auction with bids of coalitions, as coalitions are formed task by task in [shehory1998] and
[vig2006]: in each round every coalition that is worth a look bids for every unit, and one unit is sold. A bid is what
the schedule allows: the unit is put where its times, those before it and what waits for it leave a place. Of a team's
task the coalition that costs least bids, and beside it, for each of its members, the one that costs least without it.

An auction never takes a task back. So bids that leave time for what is not sold yet come first: those by which a unit,
or one that was sold before, ends too late for the tasks that wait for it (`latest_ends`) win only where no others are.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Protocol, TypeVar

import numpy as np

from muster import core
from muster.allocation.auctions.auction_terms import Terms
from muster.allocation.auctions.bids import Penalties, in_quanta, weighted
from muster.allocation.auctions.latest_ends import LatestEnds
from muster.allocation.stop import Stop
from muster.allocation.working_roster import Routes, WorkingRoster
from muster.mission.auction_book import Award, Bid, Book, TakeBid
from muster.mission.errors import ParameterError
from muster.mission.plan import tie_order
from muster.model.problem import Problem


@dataclass(frozen=True)
class CoalitionBid:
    """What a coalition would take a unit for; whether by that something not sold yet could not be in time any more."""

    insertion: core.UnitInsertion
    price: float
    leaves_no_time: bool = False

    @property
    def key(self) -> tuple[bool, float]:
        """By this bids are ordered, the best first."""
        return self.leaves_no_time, self.price

    @property
    def unit(self) -> int:
        return self.insertion.unit

    @property
    def tasks(self) -> list[int]:
        """The tasks that are sold: those of the unit, and what is sold with it."""
        return sorted({task for task, _, _ in self.insertion.members})

    @property
    def robots(self) -> list[int]:
        return sorted({robot for _, robot, _ in self.insertion.members})

    def members(self, task: int) -> list[int]:
        """The robots that would do one of the unit's tasks."""
        return sorted(robot for j, robot, _ in self.insertion.members if j == task)


@dataclass(frozen=True)
class CoalitionSale:
    """A unit that was sold in a round, and all bids for it, the best first."""

    round: int
    bids: list[CoalitionBid]

    @property
    def won(self) -> CoalitionBid:
        return self.bids[0]


def bid_of(problem: Problem, terms: Terms) -> str:
    """The objective by which coalitions bid.

    Raises
    ------
    ParameterError
        if the bid rule of the terms is none.
    """
    bid = terms.bid or problem.objective
    if bid == "average-as-printed":
        raise ParameterError(f"bid: {bid}, with times, teams or relations; expected the name of an objective")
    return bid


OnBids = Callable[[int, list[CoalitionSale]], None]


class CoalitionAuction:
    """Sells units one by one: all that can follow are announced, coalitions bid, and one unit is assigned a round."""

    def __init__(self, problem: Problem, terms: Terms, start: Routes | None = None) -> None:
        bid = bid_of(problem, terms)
        self._problem = problem if bid == problem.objective else replace(problem, objective=bid)
        self._terms = terms
        self._latest_ends = LatestEnds(self._problem)
        unit = problem.model.unit
        self._deliver = {unit[j] for j, pickup in enumerate(problem.model.pickups) if pickup >= 0}
        self._go_on_from(start)
        self._penalties = Penalties(problem, terms)
        self.sales: list[CoalitionSale] = []

    @property
    def routes(self) -> Routes:
        return self._roster.routes

    def ready(self) -> list[int]:
        """The units that can be sold: in no route, and all that they wait for is in routes.

        What delivers is sold together with what takes on board.
        """
        return [unit for unit in self._roster.ready() if unit not in self._deliver]

    def sell(self, stop: Stop, on_bids: OnBids | None = None) -> bool:
        """Sell until nobody bids any more; whether it came so far before it was time to stop."""
        while (offers := self._offers(stop)) is not None:
            sale = self._sold(offers)
            if sale is None:
                return True
            if on_bids is not None:
                on_bids(len(self.sales), [sale if offer.won.unit == sale.won.unit else offer for offer in offers])
            self.sales.append(sale)
        return False

    def _offers(self, stop: Stop) -> list[CoalitionSale] | None:
        """All bids of a round, by unit; None if it is time to stop before all have bid."""
        offers: list[CoalitionSale] = []
        for unit in self.ready():
            if stop.due():
                return None
            if bids := self.bids(unit):
                offers.append(CoalitionSale(len(self.sales) + 1, bids))
        return offers

    def _sold(self, offers: Sequence[CoalitionSale]) -> CoalitionSale | None:
        """Assign the first unit that can be, by the winner rule's choice.

        A robot does not bid for what does not hold, and of what a coalition cannot hold the next one has it.
        """
        contested = self._terms.winner_rule == "least-contested"
        bids_for = {offer.won.unit: offer.bids for offer in offers}
        for unit, won in in_turn({u: self._held(b) if contested else b for u, b in bids_for.items()}, self._terms):
            if self.assign(won):
                others = [bid for bid in bids_for[unit] if bid is not won]
                return CoalitionSale(len(self.sales) + 1, [won, *others])
        return None

    def _held(self, bids: list[CoalitionBid]) -> list[CoalitionBid]:
        """The bids for one unit of which its gap to the second one follows: of single robots those that hold."""
        return [bid for bid in bids if self.holds(bid)] if self.is_alone(bids[0].unit) else bids

    def bids(self, unit: int, robots: Sequence[int] | None = None) -> list[CoalitionBid]:
        """All bids of these robots (of all by default) for a unit, the best first."""
        robots = range(len(self._problem.robots)) if robots is None else robots
        return sorted(
            self._of_robots(unit, robots) if self.is_alone(unit) else self._of_coalitions(unit, robots),
            key=lambda bid: bid.key,
        )

    def best_bid(self, unit: int, robots: Sequence[int]) -> CoalitionBid | None:
        """The best bid for a unit that these robots can make; None: none.

        It is the one that those who make it find if they alone are asked: so robots without a centre agree on it.
        """
        bid = self._best_of(unit, robots)
        while bid is not None and len(bid.robots) < len(robots):
            robots = bid.robots
            bid = self._best_of(unit, robots) or bid
        return bid

    def _best_of(self, unit: int, robots: Sequence[int]) -> CoalitionBid | None:
        for roster in self._rosters:
            found = roster.best(unit, robots, append_only=self._terms.placement == "append", quantised=True)
            if found is not None:
                return CoalitionBid(found, self._price(found), roster is not self._rosters[0])
        return None

    def usage(self, robot: int) -> float:
        """What a robot's route uses so far."""
        return self._roster.core.usage(robot)

    def spans(self) -> dict[int, tuple[float, float]]:
        """For each task sold when it begins and ends in the earliest schedule, seconds."""
        stops = core.Inspection(self._problem.core, self.routes).stops or []
        return {task: (begin, end) for route in stops for task, _, begin, end in route}

    def holds(self, bid: CoalitionBid) -> bool:
        """Whether the routes with what is bid for are admissible."""
        return self._roster.fits(bid.insertion)

    def assign(self, bid: CoalitionBid) -> bool:
        """Put a unit into the routes of those that bid; False, and nothing is changed, if it does not hold.

        The bids that follow depend on the routes alone, not on the bids that were looked at before.
        """
        holds = self._roster.put(bid.insertion)
        if holds:
            self._go_on_from(self.routes)
        return holds

    def _go_on_from(self, routes: Routes | None) -> None:
        self._roster = WorkingRoster(self._problem, routes)
        self._rosters = [self._roster]
        if self._latest_ends.any:
            self._rosters.insert(0, WorkingRoster(self._latest_ends.binding(self.routes), self.routes))

    def is_alone(self, unit: int) -> bool:
        """Whether a unit is one task for one robot, and so is what can only be done together with it."""
        rules = self._problem.model
        whole = [k for j in rules.units[unit] for k in self._problem.with_partner(j)]
        alone = all(len(rules.units[rules.unit[k]]) == 1 and not rules.is_for_team(k) for k in whole)
        return alone and len(whole) <= 2

    def _of_robots(self, unit: int, robots: Sequence[int]) -> Iterator[CoalitionBid]:
        (task,) = self._problem.model.units[unit]
        for robot in robots:
            if self._problem.may(robot, task) and (found := self.best_bid(unit, [robot])) is not None:
                yield found

    def _of_coalitions(self, unit: int, others: Sequence[int]) -> Iterator[CoalitionBid]:
        best = self.best_bid(unit, others)
        if best is None:
            return
        yield best
        known = {_team(best)}
        for without in best.robots:
            found = self.best_bid(unit, [robot for robot in others if robot != without])
            if found is not None and _team(found) not in known:
                known.add(_team(found))
                yield found

    def _price(self, insertion: core.UnitInsertion) -> float:
        """What the objective grows by, made worse by the mean penalty of the members."""
        penalties = [self._penalties.of(np.array(self.usage(i)), i, j) for j, i, _ in insertion.members]
        penalty = float(np.mean(penalties))
        return float(in_quanta(weighted(np.array(insertion.score), penalty)))


def _team(bid: CoalitionBid) -> frozenset[tuple[int, int]]:
    return frozenset((task, robot) for task, robot, _ in bid.insertion.members)


class Keyed(Protocol):
    """What is offered for a unit."""

    @property
    def key(self) -> tuple[bool, float]: ...


KeyedT = TypeVar("KeyedT", bound=Keyed)


def in_turn(bids: Mapping[int, Sequence[KeyedT]], terms: Terms) -> Iterator[tuple[int, KeyedT]]:
    """The bids for units, each unit's best first, in the order in which a winner rule chooses them.

    Whoever goes on has found that the last one does not hold: then the unit's next bid is its best.
    """
    left = {unit: list(offered) for unit, offered in bids.items() if offered}
    while left:
        unit = min(left, key=lambda u: (rank([bid.key for bid in left[u]], terms), u))
        yield unit, left[unit].pop(0)
        left = {u: offered for u, offered in left.items() if offered}


def rank(keys: Sequence[tuple[bool, float]], terms: Terms) -> tuple[bool, float]:
    """By what a winner rule ranks a unit with bids of these keys, the best first; the least wins.

    It is the best bid, or the gap to the second one, the widest first; nobody contests a single one. Units without
    a bid that leaves time for what is not sold yet come last.
    """
    leaves_no_time, best = keys[0]
    if terms.winner_rule != "least-contested":
        return leaves_no_time, best
    contesting = [price for late, price in keys[1:2] if late == leaves_no_time]
    return leaves_no_time, best - contesting[0] if contesting else -math.inf


def coalition_book(problem: Problem, sales: list[CoalitionSale], hold: Callable[[Stop, OnBids], None]) -> Book:
    """The book of the auction; to tell every bid it is held again."""

    def for_each_bid(take: TakeBid) -> None:
        stop = Stop()

        def tell(number: int, offers: list[CoalitionSale]) -> None:
            for bid in bids_of_round(problem, offers, sales[number].won.unit):
                take(bid)
            if number == len(sales) - 1:
                stop.interrupt()

        if sales:
            hold(stop, tell)

    awards = tuple(award for sale in sales for award in awards_of(problem, sale))
    return Book(rounds=len(sales), awards=awards, for_each_bid=for_each_bid)


def bids_of_round(problem: Problem, offers: Iterable[CoalitionSale], sold: int) -> Iterator[Bid]:
    """Every bid of a round in which this unit was sold."""
    for offer in offers:
        for bid in _entries(problem, offer):
            yield bid if offer.won.unit == sold else replace(bid, winner=None, price=None)


def coalition_name(problem: Problem, robots: list[int]) -> str:
    """The robots of a coalition, joined by a plus sign in the order that breaks ties."""
    names = [problem.robots[robot].id for robot in robots]
    return "+".join(names[k] for k in tie_order(names))


def awards_of(problem: Problem, sale: CoalitionSale) -> Iterator[Award]:
    """How the tasks of a unit came to their robots."""
    for task in sale.won.tasks:
        bids = _named(problem, sale, task)
        robot = coalition_name(problem, sale.won.members(task))
        yield Award.of(sale.round, problem.tasks[task].id, robot, sale.won.price, list(bids.items()))


def _entries(problem: Problem, sale: CoalitionSale) -> Iterator[Bid]:
    for task in sale.won.tasks:
        winner = coalition_name(problem, sale.won.members(task))
        for robot, price in _named(problem, sale, task).items():
            yield Bid(sale.round, problem.tasks[task].id, robot, price, winner, sale.won.price)


def _named(problem: Problem, sale: CoalitionSale, task: int) -> dict[str, float]:
    """The best bid of each coalition for one task of the unit."""
    bids: dict[str, float] = {}
    for bid in sale.bids:
        bids.setdefault(coalition_name(problem, bid.members(task)), bid.price)
    return bids
