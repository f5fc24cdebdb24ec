"""Robots whose processors round otherwise: the places of one differ from those of the others in the last place."""

import math
from dataclasses import replace
from random import Random

import pytest
from tests.muster_team.networks import agree, owners

from muster.allocation.auctions.auction import Parameters
from muster.generation.uniform import uniform_mission
from muster.model.problem import Problem
from muster_team.negotiators.participation import negotiator_of
from muster_team.network.memory_network import LinkConditions, MemoryNetwork


def rounded_otherwise(mission, random):
    def moved(item):
        return replace(
            item, position=tuple(math.nextafter(x, random.choice((-1, 1)) * math.inf) for x in item.position)
        )

    return replace(mission, robots=tuple(map(moved, mission.robots)), tasks=tuple(map(moved, mission.tasks)))


@pytest.mark.parametrize("seed", range(5))
def test_without_limits_they_agree_and_each_task_has_one_owner(seed):
    mission = uniform_mission(Random(seed), robots=4, tasks=10)
    problem, other = (Problem.compile(m).ready() for m in (mission, rounded_otherwise(mission, Random(seed))))
    assert problem.mission.tasks != other.mission.tasks

    def negotiator(robot, incarnation):
        return negotiator_of(other if robot == "r_1" else problem, Parameters(), robot, incarnation=incarnation)

    net = MemoryNetwork(negotiator, [robot.id for robot in mission.robots], seed, LinkConditions(delay_s=0.02))
    net.start()
    agree(net, 40)
    assert {task: len(robots) for task, robots in owners(net).items()} == {task.id: 1 for task in mission.tasks}
