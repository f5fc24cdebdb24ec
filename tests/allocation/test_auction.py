"""What holds for every sequential auction, of the market too, and the bound of the literature."""

import itertools
import math
import pickle
from dataclasses import replace
from functools import cache
from random import Random

import pytest
from hypothesis import given
from hypothesis import strategies as st
from tests.random_missions import random_mission, with_travel_tables

import muster
from muster.allocation.allocator import make_parameters
from muster.allocation.auctions.auction_terms import BIDS, PLACEMENTS, WINNERS, Terms
from muster.allocation.auctions.auctioneer import Auctioneer
from muster.allocation.registry import ALLOCATORS
from muster.allocation.stop import Stop
from muster.generation.uniform import uniform_mission
from muster.mission.system.clock import VirtualClock
from muster.model.problem import Problem

both_auctions = pytest.mark.parametrize("allocator", ["auction", "market"])
every_winner = pytest.mark.parametrize("winner", WINNERS)
seeds = st.integers(0, 10**6)
weights = {"battery_weight": st.sampled_from([0, 0, 2.0]), "suitability_weight": st.sampled_from([0, 0, 1.5])}
other_terms = st.fixed_dictionaries(
    {"bid": st.sampled_from((*BIDS, None)), "placement": st.sampled_from(PLACEMENTS), **weights}
)
ignored = st.sampled_from([(), ("prerequisites",)])


def mission_by(seed, tables, *, tasks):
    mission = random_mission(seed, tasks=tasks)
    return with_travel_tables(mission, seed) if tables else mission


@pytest.mark.long(keep=1)
@pytest.mark.parametrize("placement", PLACEMENTS)
@every_winner
@given(seed=seeds, tables=st.booleans(), bid=st.sampled_from((*BIDS, None)), weights=st.fixed_dictionaries(weights))
def test_plans_are_admissible_and_nobody_can_take_what_is_left(placement, winner, seed, tables, bid, weights):
    mission = mission_by(seed, tables, tasks=9)
    plan = muster.solve(mission, "auction", bid=bid, placement=placement, winner=winner, **weights)
    assert muster.verify(mission, plan).violations == ()
    if placement == "insert":
        assert all(reason.reason != "not-chosen" for item in plan.unassigned for reason in item.reasons)


def rounds_of(book):
    rounds = {}
    for row in book.bids:
        rounds.setdefault(row.round, []).append(row)
    assert sorted(rounds) == list(range(1, book.rounds + 1))
    return rounds


def sale(rows, winner):
    """Who gets which task in a round with these bids, and for how much: worked out from them alone."""
    bids = {}
    for row in rows:
        bids.setdefault(row.task, []).append((row.bid, row.robot))
    sales = []
    for task, offers in bids.items():
        (price, robot), *others = sorted(offers)
        gap = min(others)[0] - price if others else math.inf
        sales.append((price if winner == "lowest" else -gap, robot, task, price))
    return min(sales)[1:]


@pytest.mark.long(keep=1)
@both_auctions
@every_winner
@given(seed=seeds, tables=st.booleans(), terms=other_terms, ignore=ignored)
def test_each_round_goes_to_the_winner_by_the_bids_in_the_book(allocator, winner, seed, tables, terms, ignore):
    mission = mission_by(seed, tables, tasks=8)
    more = {"iterations": 8, "annealing_steps": 0} if allocator == "market" else {}
    plan = muster.solve(mission, allocator, seed=seed, ignore=ignore, winner=winner, **terms, **more)
    for rows in rounds_of(plan.book).values():
        assert {(row.winner, row.task, row.price) for row in rows if row.winner} == {sale(rows, winner)}


class Interrupted(Stop):
    """Is interrupted when it is looked at for the last of a number of times."""

    def __init__(self, looks):
        super().__init__()
        self._looks = looks

    def due(self):
        return self.interrupted or super().due()

    @property
    def interrupted(self):
        self._looks -= 1
        return self._looks < 0


STOPS = {
    "after iterations": lambda k: Stop(iterations=k // 2),
    "interrupted": Interrupted,
    "out of time": lambda k: Stop(time_limit=k, clock=VirtualClock(step_s=1.0)),
}


@pytest.mark.long(keep=2)
@both_auctions
@pytest.mark.parametrize("end", STOPS)
@given(seed=seeds, k=st.integers(0, 50), terms=other_terms, winner=st.sampled_from(WINNERS), begun=st.booleans())
def test_the_awards_agree_with_the_bids_and_the_routes_however_it_ends(allocator, end, seed, k, terms, winner, begun):
    mission = random_mission(seed, tasks=8)
    start = muster.solve(mission, "genetic", iterations=1, seed=seed) if begun else None
    params = make_parameters(ALLOCATORS[allocator], terms | {"winner": winner})
    plan = ALLOCATORS[allocator].solve(Problem.compile(mission), STOPS[end](k), seed=seed, params=params, start=start)
    assert muster.verify(mission, plan).violations == ()
    robots = {(task, route.robot) for route in plan.routes for task in route.tasks}
    sold = {(award.task, award.robot) for award in plan.book.awards}
    assert sold <= robots
    assert robots - sold <= {(task, route.robot) for route in (start.routes if begun else ()) for task in route.tasks}
    rounds = rounds_of(plan.book)
    for award in plan.book.awards:
        rows = [row for row in rounds[award.round] if row.task == award.task]
        assert {(row.winner, row.price) for row in rows} == {(award.robot, award.price)}
        assert dict(award.bids) == {row.robot: row.bid for row in rows}
        assert award.bids[0] == (award.robot, award.price)


@every_winner
@given(seed=seeds, tables=st.booleans(), terms=other_terms, ignore=ignored)
def test_bids_are_always_those_of_an_auction_begun_with_the_same_routes(winner, seed, tables, terms, ignore):
    problem, random = Problem.compile(mission_by(seed, tables, tasks=7), ignored=ignore), Random(seed)
    terms = Terms(winner=winner, **terms)
    auctioneer = Auctioneer(problem, terms)
    states = [auctioneer.routes]
    for _ in range(14):
        step = random.random()
        sold = [task for route in auctioneer.routes for task in route]
        if step < 0.1:
            auctioneer.restore(random.choice(states), {})
        elif step < 0.3 and sold:
            auctioneer.announce(auctioneer.relinquish(random.choice(sold)))
        elif next_sale := auctioneer.select():
            auctioneer.assign(next_sale)
        states.append(auctioneer.routes)
        fresh = Auctioneer(problem, terms, states[-1])
        assert auctioneer.select() == fresh.select()
        for i in range(len(problem.robots)):
            assert auctioneer.bids(i).tolist() == fresh.bids(i).tolist()


@pytest.mark.parametrize("allocator", [a.name for a in ALLOCATORS.values() if a.auctions])
def test_a_plan_with_a_book_can_be_pickled(allocator):
    plan = muster.solve(muster.load("6T-2R"), allocator, iterations=3)
    assert plan.book.awards
    assert pickle.loads(pickle.dumps(plan)) == plan


def uniform(seed, tasks, robots):
    mission = uniform_mission(Random(seed), robots=robots, tasks=tasks, side_m=10.0)
    return replace(mission, rules=muster.Rules(objective="total"))


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


@given(seed=seeds, tasks=st.integers(1, 6), robots=st.integers(1, 3))
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
    looks = itertools.count()  # the first one before the tasks are announced, then one a round

    class Clocked(Stop):
        @property
        def interrupted(self):
            return next(looks) >= 1 + 7

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
