"""Operators on both sides of cuts give orders at the same time: all robots take the same ones, and each is answered.

Some revoke the key of a robot besides: all others go on without it, and it falls silent.
"""

from dataclasses import replace
from functools import partial
from random import Random

from tests.muster_team.byzantine.trial import keys_of, secret
from tests.muster_team.networks import line_mission
from tests.muster_team.trials.random_missions import random_mission, with_times
from tests.trials import Report

from muster import Task
from muster.allocation.auctions.auction import Parameters
from muster.mission.errors import MissionError, ParameterError
from muster.model.problem import Problem
from muster_team.knowledge.messages import AUTHORITY
from muster_team.knowledge.orders import orders_among
from muster_team.negotiators.participation import negotiator_of
from muster_team.network.memory_network import LinkConditions, MemoryNetwork
from muster_team.network.robot_keys import revocation


def orders_trial(seed):
    """The report of one run."""
    random, report = Random(seed), Report(seed)
    mission = line_mission(robots=5, tasks=12)
    if random.random() < 0.6:
        mission = random_mission(random, robots=5, tasks=9, once=0.1)
    if random.random() < 0.5:
        mission = with_times(mission, random)
    problem = Problem.compile(mission).ready()
    robots = [robot.id for robot in problem.robots]
    keys = keys_of(robots)
    make = partial(negotiator_of, problem, Parameters())
    net = MemoryNetwork(
        lambda robot, number: make(robot, incarnation=number, signatures=keys[robot]),
        robots,
        seed,
        LinkConditions(delay_s=0.02, loss=random.choice((0.0, 0.1))),
    )
    with report.trying():
        net.start()
        net.run(3.0)
        given = _give_orders(net, robots, random, report)
        out = _revoke(net, random) if random.random() < 0.3 else ""
        net.heal()
        nodes = [node for robot, node in net.nodes.items() if robot != out]
        agreed = net.run(net.now + 90.0, lambda: _agree(nodes))
        report.check(agreed, "the robots do not agree")
        report.check(all(node.revoked == ({out} if out else set()) for node in nodes), "another key was revoked")
        silent = not out or net.run(net.now + 10.0, lambda: net.nodes[out].superseded)
        report.check(silent, f"{out}, whose key was revoked, goes on")
        report.counts["revoked"] += bool(out)
        _look(nodes, {fact: robot for fact, robot in given.items() if robot != out}, report)
    return report


def _give_orders(net, robots, random, report):
    """Orders of two to six operators, of which some are given apart; the facts that state them."""
    if random.random() < 0.7:
        split = random.randrange(1, len(robots))
        net.cut(robots[:split], robots[split:])
        net.run(net.now + random.choice((0.0, 3.0, 8.0)))
    given = {}
    for k in range(random.randint(2, 6)):
        robot = random.choice(robots)
        node = net.nodes[robot]
        before = {fact for fact in node.facts if fact.kind in ("added", "moved")}
        try:
            _order(node, k, random)
        except (MissionError, ParameterError):
            report.counts["refused at once"] += 1
        for fact in node.facts - before:
            if fact.kind in ("added", "moved"):
                given[fact] = robot
        if random.random() < 0.5:
            net.run(net.now + random.choice((0.005, 0.03, 1.0)))
    return given


def _revoke(net, random):
    """An operator revokes the key of a robot, at another one; the robot whose key it was."""
    out, told = random.sample(list(net.nodes), 2)
    net.nodes[told].revoke(revocation(out, secret(AUTHORITY), b"a mission"))
    net.run(net.now + random.choice((0.0, 0.03, 1.0, 6.0)))
    return out


def _order(node, k, random):
    tasks = [*node.rules.tasks, *(fact.task for fact in node.orders.taken if fact.kind == "added")]
    place = (random.uniform(0, 100), random.uniform(0, 10))
    if random.random() < 0.25:
        name = random.choice(list(node.rules.tasks))
        problem = node.valuer.problem
        task = next((task for task in problem.tasks if task.id == name), None)
        if task is not None:
            node.move(replace(task, position=place))
        return
    name = f"new {random.randrange(2)}" if random.random() < 0.4 else f"new {k} of {node.robot}"
    kind = random.randrange(6)
    others = random.sample(tasks[:3] + tasks[len(node.rules.tasks) :], 2)  # few, so that orders contradict each other
    keys = [
        {},
        {"prerequisites": tuple(others)},
        {"prerequisites": tuple(others[:1]), "starts_with": tuple(others[1:])},
        {"starts_with": tuple(others[:1])},
        {"same_robot_as": tuple(others[:1]), "other_robot_than": tuple(others[1:])},
        {"other_robot_than": tuple(others[:1])},
    ][kind]
    node.announce(Task(id=name, position=place, **keys))


def _look(nodes, given, report):
    verdicts = [node.orders.verdicts for node in nodes]
    report.check(all(found == verdicts[0] for found in verdicts), "robots see orders differently")
    for fact in given:
        report.counts[type(verdicts[0][fact]).__name__] += 1
        report.check(all(node.is_final(fact) for node in nodes), f"{fact.task} is not answered")
    taken = orders_among(nodes[0].facts, nodes[0].rules).taken
    there = {*nodes[0].rules.tasks, *(fact.task for fact in taken)}
    for node in nodes:
        report.check({claim.task for claim in node.route} <= there, f"{node.robot} owns what there is not")
    routes = [{robot: node.valuer.route(robot) for robot in node.rules.robots} for node in nodes]
    report.check(all(other == routes[0] for other in routes), "views differ")


def _agree(nodes):
    robots = {node.robot for node in nodes}
    together = all(node.settled and set(node.epoch.own.members) == robots for node in nodes)
    return together and len({node.stage for node in nodes}) == 1 and len({node.known for node in nodes}) == 1
