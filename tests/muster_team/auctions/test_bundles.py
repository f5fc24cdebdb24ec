"""CBBA without a centre: on a network without faults it is CBBA in one process; with faults all agree all the same."""

from dataclasses import replace

import pytest

import muster
from muster import Mission, ParameterError, Robot, Task
from muster.allocation.auctions.consensus_bundle import CONSENSUS_BUNDLE, Parameters, layers
from muster.allocation.stop import Stop
from muster.model.problem import Problem
from muster_team.negotiators.methods import method_named
from muster_team.negotiators.participation import bundler_of, plan_of_bundles
from muster_team.negotiators.robot_view import view_of
from muster_team.network.memory_network import LinkConditions, MemoryNetwork

MISSIONS = ("31T-6R50", "auction-1", "24T-5R", "eil51-5", "market-rescue-20", "31T-2R65-4R25", "16T-3R", "floor")


def network_of(problem, seed=0, params=None, conditions=None, links=None):
    params = params or Parameters()

    def make(robot, incarnation):
        return bundler_of(problem, params, robot, incarnation=incarnation)

    return MemoryNetwork(make, [robot.id for robot in problem.robots], seed, conditions or LinkConditions(), links)


def agreed(network, within_s=60.0):
    return network.run(network.now + within_s, lambda: all(node.settled for node in network.nodes.values()))


@pytest.mark.long(keep=5)
@pytest.mark.parametrize("name", MISSIONS)
@pytest.mark.parametrize("bundle_size", [0, 1])
def test_without_faults_it_is_the_central_one(name, bundle_size):
    problem, params = Problem.compile(muster.load(name)).ready(), Parameters(bundle_size=bundle_size)
    central = CONSENSUS_BUNDLE.solve(problem, Stop(), params=params)
    network = network_of(problem, params=params)
    network.start()
    assert agreed(network)
    for node in network.nodes.values():
        plan = plan_of_bundles(problem, params, view_of(node))
        assert plan.routes == central.routes
        assert plan.book.awards == central.book.awards
        assert plan.book.bids == central.book.bids
        assert plan.book.rounds == central.book.rounds


@pytest.mark.long(keep=8)
@pytest.mark.parametrize("seed", range(30))
def test_with_faults_every_task_has_one_owner(seed):
    mission = muster.load("24T-5R")
    problem = Problem.compile(mission).ready()
    network = network_of(
        problem, seed, conditions=LinkConditions(loss=0.3, delay_s=0.02, jitter_s=0.1, duplication=0.1)
    )
    names = [robot.id for robot in problem.robots]
    network.start()
    network.at(0.1 + 0.05 * seed, lambda: network.crash(names[seed % 5]))
    if seed % 3 == 0:
        network.at(0.5, lambda: network.cut(names[:2], names[2:]))
    network.run(8.0)
    network.heal()
    alive = set(network.nodes)

    def all_agree():
        return all(node.settled and set(node.epoch.own.members) == alive for node in network.nodes.values())

    assert network.run(60.0, all_agree)
    owned = [claim.task for node in network.nodes.values() for claim in node.route]
    assert len(owned) == len(set(owned))
    plans = [plan_of_bundles(problem, Parameters(), view_of(node)) for node in network.nodes.values()]
    assert len({plan.routes for plan in plans}) == 1
    assert muster.verify(mission, replace(plans[0], unassigned=())).valid


def test_over_a_line_of_robots_words_are_passed_on():
    problem = Problem.compile(muster.load("24T-5R")).ready()
    order = [robot.id for robot in problem.robots]
    network = network_of(problem, links=lambda a, b: abs(order.index(a) - order.index(b)) == 1)
    network.start()
    assert agreed(network)
    central = CONSENSUS_BUNDLE.solve(problem, Stop())
    plan = plan_of_bundles(problem, Parameters(), view_of(next(iter(network.nodes.values()))))
    assert plan.routes == central.routes


def test_a_task_that_waits_for_a_cancelled_one_is_nobodys():
    first, second = (Task(id=name, position=(1.0, 0.0)) for name in "ab")
    robots = tuple(Robot(id=name, position=(0.0, 0.0)) for name in ("r_0", "r_1"))
    mission = Mission(robots=robots, tasks=(first, replace(second, prerequisites=("a",))))
    network = network_of(Problem.compile(mission).ready())
    network.start()
    assert agreed(network)
    assert sum(len(node.route) for node in network.nodes.values()) == 2
    network.nodes["r_0"].cancel("a")
    network.run(network.now + 1.0)
    assert agreed(network)
    assert [node.route for node in network.nodes.values()] == [(), ()]


def test_what_was_begun_before_its_turn_is_not_offered_again():
    first, second = (Task(id=name, position=(1.0, 0.0)) for name in "ab")
    mission = Mission(
        robots=(Robot(id="r", position=(0.0, 0.0)),), tasks=(first, replace(second, prerequisites=("a",)))
    )
    assert layers(Problem.compile(mission).ready(), {1}) == [[0]]


def test_the_method_has_its_own_parameters():
    assert method_named("consensus-bundle").allocator is CONSENSUS_BUNDLE
    with pytest.raises(ParameterError, match="did you mean 'consensus-bundle'"):
        method_named("consensus-bundel")
