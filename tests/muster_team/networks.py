"""Teams in a simulated network, for tests."""

from muster import Mission, Robot, Task
from muster.allocation.auctions.auction import Parameters
from muster.model.problem import Problem
from muster_team.auctions.valuation import AuctionValuer
from muster_team.negotiators.negotiator import Negotiator
from muster_team.negotiators.participation import rules_of
from muster_team.network.memory_network import LinkConditions, MemoryNetwork


def line_mission(robots=3, tasks=6, once=(), **more):
    """Robots at 0, 100 ... and tasks at 10, 20 ... metres along a line; those named in `once` are at-most-once."""
    return Mission(
        robots=tuple(Robot(id=f"r_{k}", position=(100.0 * k, 0.0), **more) for k in range(robots)),
        tasks=tuple(
            Task(
                id=str(k),
                position=(10.0 * k + 10.0, 0.0),
                across_partition="at-most-once" if str(k) in once else "at-least-once",
            )
            for k in range(tasks)
        ),
    )


def network(mission, terms=None, *, seed=0, links=None, make=Negotiator, absent=(), **conditions):
    """The team of a mission or a problem, not started; what robots remember is in `memories`, by robot."""
    problem = mission if isinstance(mission, Problem) else Problem.compile(mission)
    rules, terms, memories = rules_of(problem.ready()), terms or Parameters(), {}

    def negotiator(robot, incarnation):
        valuer, memory = AuctionValuer(problem, terms, robot), memories.pop(robot, None)
        forgot = memory is None and incarnation > 1
        return make(robot, rules, valuer, incarnation=incarnation, remembered=memory, forgot=forgot, absent=absent)

    net = MemoryNetwork(negotiator, [robot.id for robot in problem.robots], seed, LinkConditions(**conditions), links)
    net.memories = memories
    return net


def agree(net, within_s=30.0):
    """Lets time go by until all that live agree with each other and know the same; fails if they do not."""
    assert net.run(net.now + within_s, lambda: all_agree(net)), {n: x.stage for n, x in net.nodes.items()}


def all_agree(net):
    nodes = list(net.nodes.values())
    return (
        all(node.settled and set(node.epoch.own.members) == set(net.nodes) for node in nodes)
        and len({node.stage for node in nodes}) == 1
        and len({node.known for node in nodes}) == 1
    )


def settled_team(mission, **more):
    """A team of which all robots have started, and agree."""
    net = network(mission, **more)
    net.start()
    agree(net)
    return net


def owners(net):
    """By task those that own it."""
    by_task = {}
    for name, node in net.nodes.items():
        for claim in node.route:
            by_task.setdefault(claim.task, []).append(name)
    return by_task
