"""What a robot admits of others' bids and sales, it can also take over."""

from dataclasses import replace
from itertools import chain, combinations
from random import Random

import pytest
from tests.muster_team.test_teams_without_a_centre import lifting
from tests.muster_team.trials.random_missions import random_mission, with_times

from muster.allocation.auctions import consensus_bundle
from muster.allocation.auctions.auction import Parameters
from muster.model.problem import Problem
from muster_team.auctions.bundles import BundleValuer
from muster_team.auctions.valuation import AuctionValuer, Opening
from muster_team.knowledge.messages import Sold


def opened(problem, kind=AuctionValuer, parameters=None):
    valuer = kind(problem, parameters or Parameters(), problem.robots[0].id)
    valuer.begin(Opening())
    return valuer


def every_sale(mission):
    """Every set of up to three pairs of robot and task, as a sale."""
    pairs = [(robot.id, task.id) for robot in mission.robots for task in mission.tasks]
    some = chain.from_iterable(combinations(pairs, count) for count in (1, 2, 3))
    return [Sold(robot, task, 1.0, tuple(others)) for (robot, task), *others in some]


@pytest.mark.parametrize("seed", range(4))
def test_what_is_found_to_be_for_sale_can_be_awarded(seed):
    random = Random(seed)
    mission = lifting(3) if not seed else with_times(random_mission(random, robots=3, tasks=4, once=0.0), random)
    sales, problem, admitted = every_sale(mission), Problem.compile(mission).ready(), 0
    for sold in sales:
        valuer = opened(problem)
        if not valuer.sale_fault(sold):
            valuer.award(sold)
            admitted += 1
            assert all(task in valuer.route(robot) for robot, task in sold.assignments)
    assert 0 < admitted < len(sales)


def test_bundles_are_awarded_task_by_task():
    mission = lifting(2)
    problem = Problem.compile(
        replace(mission, tasks=tuple(replace(t, robots_needed=None) for t in mission.tasks))
    ).ready()
    admitted = []
    for sold in every_sale(problem.mission):
        valuer = opened(problem, BundleValuer, consensus_bundle.Parameters())
        if not valuer.sale_fault(sold):
            valuer.award(sold)
            admitted.append(sold.assignments)
            assert [valuer.route(robot) for robot, _ in sold.assignments] == [[task] for _, task in sold.assignments]
    assert len(admitted) == 4


def test_a_place_in_a_team_is_bid_for_by_one_robot_and_won_by_the_team():
    valuer = opened(Problem.compile(lifting(3)).ready())
    assert "lift" in [task for task, _ in valuer.bids()]
    assert valuer.sale_fault(Sold("r_0", "lift", 1.0)) == '"lift" for "r_0", which is not for sale'
    assert not valuer.sale_fault(Sold("r_0", "lift", 1.0, (("r_1", "lift"),)))
