"""What comes out of an auction without a centre is what comes out of one with an auctioneer."""

import itertools

import pytest
from tests.muster_team.networks import line_mission
from tests.random_missions import random_mission

from muster import load, verify
from muster.allocation.auctions.auction import AUCTION, Parameters
from muster.allocation.auctions.auction_terms import BIDS, PLACEMENTS, WINNERS
from muster.allocation.auctions.consensus_bundle import Parameters as BundleParameters
from muster.allocation.stop import Stop
from muster.mission.reading.plan_reader import read_plan
from muster.model.problem import Problem
from muster_team.negotiators.participation import (
    bundler_of,
    negotiator_of,
    plan_of,
    plan_of_bundles,
    plan_of_view,
    rules_of,
)
from muster_team.negotiators.robot_view import view_of
from muster_team.network.memory_network import LinkConditions, MemoryNetwork

ALL_TERMS = tuple(itertools.product(BIDS, PLACEMENTS, WINNERS))


def network(problem, terms, **conditions):
    def make(robot, incarnation):
        return negotiator_of(problem, terms, robot, incarnation=incarnation)

    return MemoryNetwork(make, [robot.id for robot in problem.robots], conditions=LinkConditions(**conditions))


def settle(network, until_s=100.0):
    assert network.run(until_s, lambda: all(node.settled for node in network.nodes.values()))


def without_times(plan):
    data = plan.as_dict()
    del data["elapsed_s"]
    return data | {"history": [value for _, value in data["history"]]}


def assert_as_in_one_process(problem, terms):
    central = AUCTION.solve(problem, Stop(), params=terms)
    held = network(problem, terms)
    held.start()
    settle(held)
    for node in held.nodes.values():
        plan = plan_of(problem, node)
        assert without_times(plan) == without_times(central)
        assert plan.book.bids == central.book.bids


@pytest.mark.long(keep=6)
@pytest.mark.parametrize(("bid", "placement", "winner"), ALL_TERMS)
def test_without_faults_plan_and_book_are_those_of_the_auction_in_one_process(bid, placement, winner):
    for name in ("auction-1", "24T-5R"):
        problem = Problem.compile(load(name)).ready()
        assert_as_in_one_process(problem, Parameters(bid=bid, placement=placement, winner=winner))


@pytest.mark.parametrize("seed", range(20))
def test_also_of_missions_with_every_rule(seed):
    bid, placement, winner = ALL_TERMS[seed % len(ALL_TERMS)]
    ignored = ("prerequisites",) if seed % 3 == 0 else ()
    problem = Problem.compile(random_mission(seed), ignored=ignored).ready()
    assert_as_in_one_process(problem, Parameters(bid=bid, placement=placement, winner=winner))


def test_after_a_crash_the_book_tells_who_could_bid():
    problem = Problem.compile(load("31T-6R50")).ready()
    held = network(problem, Parameters(), delay_s=0.05)
    held.start()
    assert held.run(100, lambda: held.nodes["r_0"].stage.round >= 5)
    held.crash("r_1")
    settle(held)
    plans = [plan_of(problem, node) for node in held.nodes.values()]
    assert len({str([route.tasks for route in plan.routes]) for plan in plans}) == 1
    plan = plans[0]
    assert verify(problem.mission, plan).valid
    assert plan.routes[1].tasks == ()
    assert {award.task for award in plan.book.awards} == {task for route in plan.routes for task in route.tasks}
    assert plan.book.messages > 0
    bidders = {}
    for bid in plan.book.bids:
        bidders.setdefault(bid.round, set()).add(bid.robot)
    last = max(award.round for award in plan.book.awards)
    assert any("r_1" in robots for robots in bidders.values())
    assert "r_1" not in bidders[last]
    for award in plan.book.awards:
        assert dict(award.bids)[award.robot] == award.price


def test_who_comes_late_knows_the_prices_of_what_was_sold_without_it():
    problem = Problem.compile(load("24T-5R")).ready()
    held = network(problem, Parameters())
    names = [robot.id for robot in problem.robots]
    held.start(names[:-1])
    settle(held)
    before = plan_of(problem, held.nodes[names[0]]).book
    held.start(names[-1:])
    held.run(held.now + 3)
    settle(held)
    late = plan_of(problem, held.nodes[names[-1]]).book
    sold = {(award.task, award.robot, award.price, award.round) for award in before.awards}
    assert sold
    assert sold <= {(award.task, award.robot, award.price, award.round) for award in late.awards}
    assert all(award.bidders == 1 for award in late.awards if award.round <= before.rounds)
    assert not any(bid.round <= before.rounds for bid in late.bids)


def test_before_anything_is_sold_all_tasks_are_left_out():
    problem = Problem.compile(load("auction-1")).ready()
    node = negotiator_of(problem, Parameters(), problem.robots[0].id, incarnation=1)
    node.start(0.0)
    plan = plan_of(problem, node)
    assert plan.tasks_completed == 0
    assert len(plan.unassigned) == len(problem.tasks)
    assert plan.book.rounds == 0


def test_a_plan_says_how_long_the_robots_took():
    problem = Problem.compile(load("auction-1")).ready()
    held = network(problem, Parameters())
    held.start()
    settle(held)
    view = view_of(next(iter(held.nodes.values())))
    plan = plan_of_view(problem, Parameters(), view, elapsed_s=2.5)
    assert plan.elapsed_s == 2.5
    assert plan.history == ((2.5, plan.objective_value),)


def test_rules_follow_the_problem():
    mission = load("31T-6R50")
    rules = rules_of(Problem.compile(mission))
    assert any(rules.prerequisites.values())
    assert list(rules.robots) == [f"r_{k}" for k in range(6)]
    assert rules.once == frozenset()
    assert not any(rules_of(Problem.compile(mission, ignored=("prerequisites",))).prerequisites.values())


@pytest.mark.parametrize(("make", "plan"), [(negotiator_of, plan_of_view), (bundler_of, plan_of_bundles)])
def test_a_plan_names_tasks_that_several_robots_have_begun(make, plan, tmp_path):
    problem, params = Problem.compile(line_mission(robots=2, tasks=3)).ready(), {bundler_of: BundleParameters}
    terms = params.get(make, Parameters)()
    held = MemoryNetwork(lambda r, n: make(problem, terms, r, incarnation=n), ["r_0", "r_1"])
    held.start()
    settle(held)
    assert "done_twice" not in plan(problem, terms, view_of(held.nodes["r_0"])).as_dict()
    held.cut(["r_0"], ["r_1"])
    assert held.run(60, lambda: all(len(node.route) == 3 and node.settled for node in held.nodes.values()))
    assert all(node.begin("2") for node in held.nodes.values())
    held.heal()
    assert held.run(90, lambda: all(len(node.epoch.own.members) == 2 and node.settled for node in held.nodes.values()))
    told = plan(problem, terms, view_of(held.nodes["r_0"]))
    assert {task: sorted(robots) for task, robots in told.as_dict()["done_twice"].items()} == {"2": ["r_0", "r_1"]}
    told.save(tmp_path / "plan.json")
    assert read_plan(tmp_path / "plan.json").book.done_twice == told.book.done_twice
