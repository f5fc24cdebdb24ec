"""The book of an auction without a centre, from one robot's view of it.

Robots publish only what the winner rule needs, but their bids follow from the routes that all know. So the auctions are
repeated, and every bid is recorded as in the book of the auction in one process. (A bid that a robot did not make
because it had given the task back is recorded too: others cannot know.)
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace

from muster.allocation.auctions.auction_terms import Terms
from muster.allocation.auctions.consensus import neighbours, score
from muster.allocation.auctions.consensus_bundle import Parameters
from muster.mission.auction_book import Award, Book, TakeBid
from muster.model.problem import Problem
from muster_team.auctions.bundles import BundleValuer
from muster_team.auctions.epoch import EpochAuction
from muster_team.auctions.task_sales import TaskSales
from muster_team.auctions.unit_sales import UnitSales
from muster_team.auctions.valuation import AuctionValuer
from muster_team.knowledge.messages import Claim, Sold
from muster_team.negotiators.robot_view import View

OnSale = Callable[[TaskSales | UnitSales, int, Sold, Sequence[int]], None]
"""Called before what was sold is assigned, with the sales so far, the round's number, and the robots that could bid."""


def book_of_view(problem: Problem, terms: Terms, view: View) -> Book:
    """The book: awards of all tasks that robots own in the view, and the bids of all rounds that the robot has seen.

    Of a task that was won where the robot could not see it, or before the epochs of the view, the book knows only the
    price. `messages` is None where the whole team took part throughout, so that every robot has bid for all that it
    could do; else it is the number that the robot sent.
    """
    auctions = view.auctions

    def for_each_bid(take: TakeBid) -> None:
        def tell(sales: TaskSales | UnitSales, number: int, sold: Sold, members: Sequence[int]) -> None:
            for bid in sales.booked_bids(number, sold, members):
                take(bid)

        _hold_again(problem, terms, auctions, tell)

    awards = tuple(_awards(problem, terms, auctions, view.claims))
    return Book(
        rounds=view.rounds,
        messages=None if view.together else view.sent,
        awards=awards,
        done_twice=view.twice,
        for_each_bid=for_each_bid,
    )


def _hold_again(problem: Problem, terms: Terms, auctions: Sequence[EpochAuction], on_sale: OnSale) -> None:
    """Repeat the auctions, and report each sale."""
    valuer = AuctionValuer(problem, terms, problem.robots[0].id)
    for held in auctions:
        valuer.begin(held.opening)
        members = [problem.robot_index[robot] for robot in held.members]
        for number, sold in enumerate(held.sales, held.rounds + 1):
            on_sale(valuer.sales, number, sold, members)
            valuer.award(sold)


def _awards(
    problem: Problem, terms: Terms, auctions: Sequence[EpochAuction], claims: Mapping[str, Sequence[Claim]]
) -> list[Award]:
    """How each task came to the robot that owns it, in the order of rounds."""
    seen: dict[tuple[str, str, int], Award] = {}

    def note(sales: TaskSales | UnitSales, number: int, sold: Sold, members: Sequence[int]) -> None:
        awards = {award.task: award for award in sales.awards(number, sold, members)}
        seen.update({(robot, task, number): awards[task] for robot, task in sold.assignments})

    _hold_again(problem, terms, auctions, note)
    awards = [
        seen.get((robot, c.task, c.round)) or Award.of(c.round, c.task, robot, c.price, [(robot, c.price)])
        for robot, owned in claims.items()
        for c in owned
    ]
    place = {id(award): k for k, award in enumerate(seen.values())}
    return sorted({id(award): award for award in awards}.values(), key=lambda a: (a.round, place.get(id(a), 0)))


def book_of_bundles(problem: Problem, params: Parameters, view: View) -> Book:
    """The book of CBBA: of the last epoch, repeated if the robot heard it completely, else only what was won."""
    held = view.auctions[-1]
    if not held.whole:
        owned = [(c.round, c.task, robot, score(c.price)) for robot, claims in view.claims.items() for c in claims]
        awards = tuple(Award.of(*won, [(won[2], won[3])]) for won in sorted(owned))
        return Book(rounds=view.rounds, messages=view.sent, awards=awards, done_twice=view.twice)
    watcher = BundleValuer(problem, params, held.members[0])
    watcher.begin(held.opening)
    for bids in held.published:
        watcher.bids()
        for sold in watcher.resolve(bids).sales:
            watcher.award(sold)
    routes = [[problem.task_index[task] for task in watcher.route(robot.id)] for robot in problem.robots]
    book = watcher.ledger.book(problem, routes, neighbours("complete", len(problem.robots)))
    return replace(book, done_twice=view.twice)
