"""Teams without limits in a simulated network, for measurements."""

from __future__ import annotations

from collections.abc import Callable
from random import Random

from muster.allocation.auctions.auction import Parameters
from muster.generation.uniform import uniform_mission
from muster.model.problem import Problem
from muster_team.negotiators.negotiator import Negotiator
from muster_team.negotiators.participation import negotiator_of
from muster_team.network.memory_network import LinkConditions, MemoryNetwork

DELAY_S = 0.05
END_S = 600.0


def team(robots: int, tasks: int, seed: int, conditions: LinkConditions) -> tuple[Problem, MemoryNetwork]:
    """Robots and tasks without limits in a square, and a network of them."""
    problem = Problem.compile(uniform_mission(Random(seed), robots=robots, tasks=tasks)).ready()
    terms = Parameters()

    def make(robot: str, incarnation: int) -> Negotiator:
        return negotiator_of(problem, terms, robot, incarnation=incarnation)

    return problem, MemoryNetwork(make, [robot.id for robot in problem.robots], seed, conditions)


def settled_team(robots: int, tasks: int, loss: float, seed: int) -> MemoryNetwork:
    """A team that has ended its first auction."""
    _, network = team(robots, tasks, seed, LinkConditions(loss=loss, delay_s=DELAY_S))
    network.start()
    time_until(network, lambda: all(node.settled for node in network.nodes.values()))
    return network


def time_until(network: MemoryNetwork, what: Callable[[], bool]) -> float:
    begin = network.now
    if not network.run(begin + END_S, what):
        raise RuntimeError(f"not within {END_S:g} s of virtual time")
    return network.now - begin


def all_agree(network: MemoryNetwork) -> bool:
    nodes = list(network.nodes.values())
    whole = len(nodes[0].epoch.own.members) == len(nodes)
    return whole and all(node.settled and node.stage == nodes[0].stage for node in nodes)
