"""Robots whose processors round otherwise: the places of one differ from those of the others, as its results would."""

import math
from dataclasses import replace
from random import Random

import pytest
from tests.muster_team.networks import agree, owners
from tests.muster_team.trials.random_missions import random_mission, with_times

from muster.allocation.auctions.auction import Parameters
from muster.model.problem import Problem
from muster_team.negotiators.participation import negotiator_of
from muster_team.network.memory_network import LinkConditions, MemoryNetwork


def everywhere(mission, move):
    def moved(item):
        return replace(item, position=tuple(map(move, item.position)))

    return replace(mission, robots=tuple(map(moved, mission.robots)), tasks=tuple(map(moved, mission.tasks)))


def by_an_ulp(random):
    return lambda x: math.nextafter(x, random.choice((-1, 1)) * math.inf)


def on_a_grid(x):
    """Where many ways are as long: to the nearest ten metres."""
    return float(round(x / 10) * 10)


def team(mission, other, seed):
    """A team that has agreed, of which r_1 has the other mission."""
    here, there = (Problem.compile(m).ready() for m in (mission, other))

    def negotiator(robot, incarnation):
        return negotiator_of(there if robot == "r_1" else here, Parameters(), robot, incarnation=incarnation)

    net = MemoryNetwork(negotiator, [robot.id for robot in mission.robots], seed, LinkConditions(delay_s=0.02))
    net.start()
    agree(net, 60)
    return net


def routes(net):
    """What each robot takes for the routes of all."""
    return [{robot: node.valuer.route(robot) for robot in net.nodes} for node in net.nodes.values()]


def differing(net):
    return [notice for node in net.nodes.values() for notice in node.notices if notice.kind == "differs"]


@pytest.mark.parametrize("times", [False, True], ids=["plain", "timed"])
@pytest.mark.parametrize("grid", [False, True], ids=["anywhere", "grid"])
@pytest.mark.parametrize("seed", range(5))
def test_they_compare_the_same_prices_and_so_see_the_same_routes(seed, grid, times):
    random = Random(seed)
    mission = random_mission(random, robots=4, tasks=10, once=0.0)
    mission = with_times(mission, random) if times else mission
    mission = everywhere(mission, on_a_grid) if grid else mission
    other = everywhere(mission, by_an_ulp(Random(seed)))
    assert mission.tasks != other.tasks
    net = team(mission, other, seed)
    first, *others = routes(net)
    assert all(seen == first for seen in others)
    assert not differing(net)


def test_those_whose_results_differ_by_more_find_out_and_state_their_own_routes():
    found = 0
    for seed in range(12):
        mission = everywhere(random_mission(Random(seed), robots=4, tasks=10, once=0.0), on_a_grid)
        shift = Random(seed)
        net = team(mission, everywhere(mission, lambda x, shift=shift: x + shift.uniform(-1e-3, 1e-3)), seed)
        first, *others = routes(net)
        assert all(seen == first for seen in others), seed
        assert all(len(robots) == 1 for robots in owners(net).values())
        found += bool(differing(net))
    assert found >= 2
