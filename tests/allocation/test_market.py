"""The market: what relinquishing and annealing keep, and what they gain."""

import itertools
import math

import pytest
from hypothesis import given
from hypothesis import strategies as st
from tests.random_missions import random_mission

import muster
from muster.allocation.market import Parameters
from muster.allocation.terms import BIDS, PLACEMENTS, WINNERS


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


@given(seed=st.integers(0, 10**6))
def test_the_book_holds_the_sales_of_the_plan(seed):
    mission = random_mission(seed, tasks=8)
    plan = muster.solve(mission, "market", iterations=12, seed=seed)
    won = {(row.round, row.task, row.robot): row.bid for row in plan.book.bids if row.winner == row.robot}
    for award in plan.book.awards:
        assert won[award.round, award.task, award.robot] == award.price
    routes = {task: route.robot for route in plan.routes for task in route.tasks}
    assert {award.task: award.robot for award in plan.book.awards} == routes
    assert plan.book.rounds >= max((award.round for award in plan.book.awards), default=0)


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


@pytest.mark.parametrize(("name", "value"), [("ro", -0.1), ("ro", 1.1), ("annealing_steps", -1)])
def test_parameters_out_of_range_are_refused(name, value):
    with pytest.raises(muster.ParameterError, match=name):
        Parameters(**{name: value})
