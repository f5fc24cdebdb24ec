"""Without faults robots come to the plan, the sales and the prices of the auction in one process."""

from dataclasses import replace
from itertools import product

import pytest
from tests.muster_team.networks import agree, line_mission, network

import muster
from muster.allocation.auctions.auction import AUCTION, Parameters
from muster.allocation.auctions.auction_terms import BIDS, PLACEMENTS, WINNERS
from muster.allocation.stop import Stop
from muster.library import mission_names, mission_path
from muster.mission.errors import MissingExtraError, ParameterError
from muster.model.problem import Problem
from muster_team.auctions.capabilities import AGREED
from muster_team.negotiators.participation import plan_of

OTHERS = tuple(product(WINNERS, PLACEMENTS))


def cut_down(mission, tasks=32, robots=8):
    """The mission with its first robots and tasks alone, if it has many; none of these tasks asks for another then."""
    if len(mission.tasks) <= tasks and len(mission.robots) <= 12:
        return mission
    few = tuple(replace(task, prerequisites=(), same_robot_as=()) for task in mission.tasks[:tasks])
    return replace(mission, tasks=few, robots=mission.robots[:robots], events=())


def assert_like_central(problem, terms):
    central = AUCTION.solve(problem, Stop(), params=terms)
    net = network(problem, terms)
    net.start()
    agree(net)
    for node in net.nodes.values():
        if problem.core.is_timed:  # where a sale may be that of several tasks
            assert plan_of(problem, node).book.awards == central.book.awards
            continue
        assert [(s.task, s.robot, s.price) for s in node.epoch.sales] == [
            (award.task, award.robot, award.price) for award in central.book.awards
        ]
    assert {r.robot: r.tasks for r in central.routes} == {
        name: tuple(claim.task for claim in node.route) for name, node in net.nodes.items()
    }


@pytest.mark.long
@pytest.mark.parametrize(("number", "name"), list(enumerate(mission_names())))
def test_on_every_shipped_mission(number, name):
    more = {"salesmen": 3} if mission_path(name).suffix == ".tsp" else {}
    try:
        problem = Problem.compile(cut_down(muster.load(name, **more))).ready()
    except MissingExtraError as error:
        pytest.skip(str(error))
    if not problem.asked.keys() <= AGREED:
        with pytest.raises(ParameterError, match="robots without a centre cannot agree on"):
            network(problem, Parameters()).start()
        return
    bids = [bid for bid in BIDS if bid != "average-as-printed"] if problem.core.is_timed else BIDS
    for k, bid in enumerate(bids):
        winner, placement = OTHERS[(number + k) % len(OTHERS)]  # over all missions every three meet
        assert_like_central(problem, Parameters(bid=bid, winner=winner, placement=placement))


@pytest.mark.long(keep=6)
@pytest.mark.parametrize(("bid", "winner", "placement"), list(product(BIDS, WINNERS, PLACEMENTS)))
def test_under_all_terms(bid, winner, placement):
    problem = Problem.compile(muster.load("24T-5R")).ready()
    assert_like_central(problem, Parameters(bid=bid, winner=winner, placement=placement))


def test_with_weights():
    problem = Problem.compile(muster.load("31T-6R50")).ready()
    assert_like_central(problem, Parameters(battery_weight=2.0, suitability_weight=1.0))


def test_with_the_quality_of_skills():
    mission = muster.load("depot")
    robots = tuple(
        replace(robot, skill_quality=dict.fromkeys(robot.skills, 0.2 + 0.1 * k) or None)
        for k, robot in enumerate(mission.robots)
    )
    problem = Problem.compile(replace(mission, robots=robots)).ready()
    assert_like_central(problem, Parameters(quality_weight=3.0))


@pytest.mark.parametrize("delay_s", [0.001, 0.05, 0.07])
def test_one_bid_a_robot_a_round_and_no_repairs(delay_s):
    net = network(line_mission(robots=5, tasks=12), delay_s=delay_s)
    net.start()
    agree(net)
    for node in net.nodes.values():
        assert len(node.epoch.sales) == 12
        assert node.counts.news == 1 + 12 + 1  # a declaration, a bid a round, and in the last that it bids nothing
        assert node.counts.repairs == 0
