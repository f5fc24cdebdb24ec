"""The market: what relinquishing and annealing keep, and what they gain. Its books: in test_auction.py."""

import itertools
import math

import pytest
from hypothesis import given
from hypothesis import strategies as st
from tests.random_missions import random_mission

import muster
from muster.allocation.auctions import market
from muster.allocation.auctions.auction_terms import BIDS, PLACEMENTS, WINNERS
from muster.allocation.auctions.auctioneer import Auctioneer
from muster.allocation.auctions.market import Parameters
from muster.allocation.stop import Stop
from muster.mission.model import OBJECTIVES
from muster.model.problem import Problem


@given(
    seed=st.integers(0, 10**6),
    bid=st.sampled_from((*BIDS, None)),
    placement=st.sampled_from(PLACEMENTS),
    winner=st.sampled_from(WINNERS),
    ro=st.sampled_from([0.0, 0.5, 1.0]),
)
def test_plans_are_admissible_and_no_worse_than_the_first_auction(seed, bid, placement, winner, ro):
    mission = random_mission(seed, tasks=9)
    terms = {"bid": bid, "placement": placement, "winner": winner}
    plan = muster.solve(mission, "market", iterations=15, seed=seed, ro=ro, annealing_steps=200, **terms)
    first = muster.solve(mission, "auction", **terms)
    assert muster.verify(mission, plan).violations == ()
    assert (-plan.weight_completed, plan.objective_value) <= (-first.weight_completed, first.objective_value)


@pytest.mark.parametrize(("ro", "least", "most"), [(0.0, 0.0, 0.0), (0.3, 0.15, 0.45), (1.0, 1.0, 1.0)])
def test_a_worse_allocation_stands_as_often_as_ro_says(monkeypatch, ro, least, most):
    """Spies on the routes from which each iteration begins, and on those to which its auction leads."""
    problem = Problem.compile(muster.load("eil51-5")).ready()
    begun, sold = [], []
    relinquish, sell = market.relinquish, Auctioneer.sell

    def spied_relinquish(auctioneer, *args):
        begun.append(auctioneer.routes)
        relinquish(auctioneer, *args)

    def spied_sell(auctioneer, stop):
        sell(auctioneer, stop)
        sold.append(auctioneer.routes)

    monkeypatch.setattr(market, "relinquish", spied_relinquish)
    monkeypatch.setattr(Auctioneer, "sell", spied_sell)
    market.MARKET.solve(problem, Stop(iterations=200), params=Parameters(ro=ro, placement="append", annealing_steps=0))
    assert begun[0] == sold[0]
    worse_stands = []
    for current, new, after in zip(begun, sold[1:], begun[1:], strict=False):
        if problem.value(new)[1] > problem.value(current)[1]:
            worse_stands.append(after == new)
            assert after in (current, new)
        else:
            assert after == new
    assert len(worse_stands) > 50
    assert least <= sum(worse_stands) / len(worse_stands) <= most


def test_the_cost_is_the_papers_a_plus_b_within_the_battery():
    mission = muster.load("market-rescue")
    plan = muster.solve(mission, "market", iterations=20)
    verdict = muster.verify(mission, plan)
    for robot, route in zip(mission.robots, verdict.routes, strict=True):
        tasks = [task for name in route.tasks for task in mission.tasks if task.id == name]
        places = [robot.position, *(task.position for task in tasks)]
        travel = sum(math.dist(a, b) for a, b in itertools.pairwise(places)) / robot.speed_mps
        work = sum(task.duration_s for task in tasks) / robot.efficiency
        assert route.usage == pytest.approx(travel + work)
        assert route.usage <= robot.work_capacity
    assert plan.objective_value == max(route.usage for route in plan.routes)


def test_it_improves_on_its_first_auction():
    mission = muster.load("eil51-5")
    none, many = (muster.solve(mission, "market", iterations=n, annealing_steps=0) for n in (0, 300))
    assert none.objective_value == muster.solve(mission, "auction").objective_value
    assert many.objective_value < 0.9 * none.objective_value


def test_annealing_comes_after_the_trade():
    mission = muster.load("eil51-3")
    terms = {"iterations": 0, "placement": "append"}
    plain, annealed = (muster.solve(mission, "market", annealing_steps=steps, **terms) for steps in (0, 20_000))
    assert annealed.objective_value < 0.95 * plain.objective_value
    assert [sorted(r.tasks) for r in annealed.routes] == [sorted(r.tasks) for r in plain.routes]


@pytest.mark.parametrize("objective", [name for name in OBJECTIVES if name != "lateness"])
def test_annealing_improves_every_route(objective):
    robots = tuple(muster.Robot(id=name, position=(0, y)) for y, name in enumerate("abc"))
    tasks = tuple(muster.Task(id=f"{r.id}{x}", position=(x, y)) for y, r in enumerate(robots) for x in range(1, 8))
    mission = muster.Mission(rules=muster.Rules(objective=objective), robots=robots, tasks=tasks)
    start = muster.Plan(
        routes=tuple(muster.Route(r.id, tuple(f"{r.id}{x}" for x in (4, 7, 1, 6, 3, 5, 2))) for r in robots)
    )
    plan = muster.solve(mission, "market", start=start, iterations=0)
    assert [route.tasks for route in plan.routes] == [tuple(f"{r.id}{x}" for x in range(1, 8)) for r in robots]


@pytest.mark.parametrize(("name", "value"), [("ro", -0.1), ("ro", 1.1), ("annealing_steps", -1)])
def test_parameters_out_of_range_are_refused(name, value):
    with pytest.raises(muster.ParameterError, match=name):
        Parameters(**{name: value})
