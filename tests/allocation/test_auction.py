"""What holds for every sequential auction, and the bound of the literature."""

import itertools
import math
from functools import cache
from random import Random

import pytest
from hypothesis import given
from hypothesis import strategies as st
from tests.random_missions import random_mission

import muster
from muster.allocation.problem import Problem
from muster.allocation.registry import ALLOCATORS
from muster.allocation.stop import Stop
from muster.allocation.terms import BIDS, PLACEMENTS, WINNERS

every_terms = pytest.mark.parametrize(
    ("bid", "placement", "winner"), list(itertools.product((*BIDS, None), PLACEMENTS, WINNERS))
)


@every_terms
@given(seed=st.integers(0, 10**6), battery=st.sampled_from([0, 0, 2.0]), suitability=st.sampled_from([0, 0, 1.5]))
def test_plans_are_admissible_and_nobody_can_take_what_is_left(bid, placement, winner, seed, battery, suitability):
    mission = random_mission(seed, tasks=9)
    plan = muster.solve(
        mission,
        "auction",
        bid=bid,
        placement=placement,
        winner=winner,
        battery_weight=battery,
        suitability_weight=suitability,
    )
    assert muster.verify(mission, plan).violations == ()
    if placement == "insert" and not any(task.prerequisites for task in mission.tasks):
        assert all(reason.reason != "not-chosen" for item in plan.unassigned for reason in item.reasons)


@given(seed=st.integers(0, 10**6), bid=st.sampled_from(BIDS), placement=st.sampled_from(PLACEMENTS))
def test_each_round_goes_to_the_lowest_bid_in_the_book(seed, bid, placement):
    mission = random_mission(seed, tasks=8)
    plan = muster.solve(mission, "auction", bid=bid, placement=placement)
    rounds = {}
    for row in plan.book.bids:
        rounds.setdefault(row.round, []).append(row)
    assert sorted(rounds) == list(range(1, plan.book.rounds + 1))
    for award in plan.book.awards:
        rows = rounds[award.round]
        assert award.price == min(row.bid for row in rows)
        assert {row.task for row in rows if row.winner} == {award.task}
        assert {row.winner for row in rows if row.task == award.task} == {award.robot}
        assert dict(award.bids) == {row.robot: row.bid for row in rows if row.task == award.task}
    routes = {task: route.robot for route in plan.routes for task in route.tasks}
    assert {award.task: award.robot for award in plan.book.awards} == routes


def uniform(seed, tasks, robots):
    random = Random(seed)

    def place():
        return random.uniform(0, 10), random.uniform(0, 10)

    return muster.Mission(
        rules=muster.Rules(objective="total"),
        robots=tuple(muster.Robot(id=f"r_{k}", position=place()) for k in range(robots)),
        tasks=tuple(muster.Task(id=str(k), position=place()) for k in range(tasks)),
    )


def least_total(mission):
    """The optimum by exhaustive search: dynamic programming over sets of tasks, robot after robot."""
    points = [task.position for task in mission.tasks]

    @cache
    def path(start, left):
        """The shortest open path from a point through a set of tasks."""
        return min((math.dist(start, points[j]) + path(points[j], left - {j}) for j in left), default=0.0)

    @cache
    def team(robot, left):
        if robot == len(mission.robots):
            return 0.0 if not left else math.inf
        shares = itertools.chain.from_iterable(itertools.combinations(left, k) for k in range(len(left) + 1))
        start = mission.robots[robot].position
        return min(path(start, frozenset(share)) + team(robot + 1, left - set(share)) for share in shares)

    return team(0, frozenset(range(len(points))))


@given(seed=st.integers(0, 10**6), tasks=st.integers(1, 6), robots=st.integers(1, 3))
def test_minisum_is_at_most_twice_the_optimum(seed, tasks, robots):
    """Lagoudakis et al. (2005), Theorem 1: open routes, metric travel, no limits."""
    mission = uniform(seed, tasks, robots)
    total = muster.verify(mission, muster.solve(mission, "auction")).value("total")
    optimum = least_total(mission)
    assert optimum - 1e-9 <= total <= 2 * optimum + 1e-9


def test_ties_go_to_the_first_robot_by_code_points():
    mission = muster.Mission(
        robots=tuple(muster.Robot(id=name, position=(0, 0)) for name in ("firefly2", "firefly10", "firefly1")),
        tasks=(muster.Task(id="t", position=(1, 0)),),
    )
    plan = muster.solve(mission, "auction")
    assert plan.book.awards[0].robot == "firefly1"


def test_a_robot_with_little_battery_left_bids_more():
    def mission(capacity):
        return muster.Mission(
            rules=muster.Rules(objective="total"),
            robots=(
                muster.Robot(id="a", position=(0, 0), work_capacity=capacity),
                muster.Robot(id="b", position=(22, 0), work_capacity=100),
            ),
            tasks=(muster.Task(id="0", position=(8, 0)), muster.Task(id="1", position=(13, 0))),
        )

    def routes(capacity, weight):
        plan = muster.solve(mission(capacity), "auction", battery_weight=weight)
        return [route.tasks for route in plan.routes]

    assert routes(14, 0) == [("0", "1"), ()]
    assert routes(14, 2) == [("0",), ("1",)]


def test_the_better_suited_robot_can_win_from_farther_away():
    mission = muster.Mission(
        robots=(muster.Robot(id="a", type="x", position=(0, 0)), muster.Robot(id="b", type="y", position=(11, 0))),
        tasks=(muster.Task(id="0", type="D", position=(5, 0)),),
        suitability={"x": {"D": 0.7}, "y": {"D": 1.0}},
    )
    assert muster.solve(mission, "auction").routes[0].tasks == ("0",)
    assert muster.solve(mission, "auction", suitability_weight=1.0).routes[1].tasks == ("0",)


def test_an_auction_goes_on_from_a_start_plan():
    mission = muster.load("eil51-5")
    start = muster.Plan(routes=(muster.Route("r_3", ("2", "3", "4")),))
    plan = muster.solve(mission, "auction", start=start, placement="append")
    assert plan.routes[3].tasks[:3] == ("2", "3", "4")
    assert plan.complete
    assert {award.task for award in plan.book.awards} == {task.id for task in mission.tasks} - {"2", "3", "4"}


def test_an_interrupted_auction_has_the_book_of_its_rounds():
    problem = Problem.compile(muster.load("eil51-5")).ready()
    rounds = itertools.count()

    class Clocked(Stop):
        @property
        def interrupted(self):
            return next(rounds) >= 7

    plan = ALLOCATORS["auction"].solve(problem, Clocked())
    assert plan.book.rounds == plan.tasks_completed == 7
    assert max(row.round for row in plan.book.bids) == 7


def test_no_tasks_no_rounds():
    mission = muster.Mission(robots=(muster.Robot(id="r", position=(0, 0)),), tasks=())
    for winner in WINNERS:
        plan = muster.solve(mission, "auction", winner=winner)
        assert (plan.book.rounds, plan.book.awards, plan.book.bids) == (0, (), ())


def test_least_contested_serves_first_what_only_one_robot_can_do():
    mission = muster.Mission(
        robots=(
            muster.Robot(id="a", position=(0, 0), skills=("gripper",), work_capacity=10),
            muster.Robot(id="b", position=(3, 0)),
        ),
        tasks=(muster.Task(id="0", position=(1, 0)), muster.Task(id="1", position=(-9.5, 0), requires=("gripper",))),
    )
    assert not muster.solve(mission, "auction").complete
    assert muster.solve(mission, "auction", winner="least-contested").complete
