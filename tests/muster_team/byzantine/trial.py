"""A team of five of which one sends mutated messages for a while, and then falls silent: what becomes of the others."""

from collections import Counter
from dataclasses import replace
from functools import cache, partial
from hashlib import blake2b
from random import Random

from tests.muster_team.byzantine.mutations import codec_of, mutated
from tests.muster_team.networks import line_mission
from tests.muster_team.trials.random_missions import random_mission, with_times
from tests.trials import Report

from muster import Task
from muster.allocation.auctions.auction import Parameters
from muster.allocation.auctions.consensus_bundle import Parameters as BundleParameters
from muster.mission.errors import MissionError, ParameterError
from muster.model.problem import Problem
from muster_team.knowledge.effects import Outgoing
from muster_team.knowledge.messages import AUTHORITY
from muster_team.negotiators.participation import bundler_of, negotiator_of
from muster_team.network.memory_network import LinkConditions, MemoryNetwork
from muster_team.network.robot_keys import RobotKeys, public_key

LIAR = "r_4"
LIES_UNTIL_S = 6.0
QUIET_S = 60.0


@cache
def secret(robot):
    return blake2b(robot.encode(), digest_size=32).digest()


def keys_of(robots):
    """Keys of robots, the same each time."""
    roster = {robot: public_key(secret(robot)) for robot in (*robots, AUTHORITY)}
    return {robot: RobotKeys(secret(robot), roster, b"a mission") for robot in robots}


def problem_of(random):
    kind = random.choice(("line", "once", "random", "timed"))
    if kind in ("line", "once"):
        once = ("3", "8") if kind == "once" else ()
        return kind, Problem.compile(line_mission(robots=5, tasks=15, once=once)).ready()
    mission = random_mission(random, robots=5, tasks=10, once=0.2)
    return kind, Problem.compile(with_times(mission, random) if kind == "timed" else mission).ready()


class LyingNetwork(MemoryNetwork):
    """A network in which one robot's messages are mutated, about every second one, until it is told to stop."""

    def lie_with(self, codec, keys, random):
        self.codec, self.keys, self.random, self.lies, self.mutations = codec, keys, random, True, 0

    def _send(self, robot, out):
        super()._send(robot, [self._said(sent) for sent in out] if robot == LIAR and self.lies else out)

    def _said(self, outgoing):
        if self.random.random() < 0.5:
            return outgoing
        message = mutated(outgoing.message, self.codec, self.random)
        if message is None or message.sender != LIAR:  # under another's name it is no message: see `Node`
            return outgoing
        message = signed(message, self.keys)
        self.mutations += 1
        return Outgoing(message, outgoing.to)


def signed(message, keys):
    """The message with proofs of all that the liar states in it, but not of what it says that others have stated."""

    def own(statement, context=b""):
        return keys.sign(statement, context) if statement.robot == LIAR else statement

    declared = [replace(said, facts=tuple(map(own, said.facts))) for said in message.declarations]
    return replace(
        message,
        declarations=tuple(map(own, declared)),
        bids=tuple(own(bids, message.stage.base) for bids in message.bids),
        facts=tuple(map(own, message.facts)),
        births=tuple(map(own, message.births)),
    )


def byzantine_trial(seed):
    """The report of one run."""
    random = Random(seed)
    report = Report(seed)
    kind, problem = problem_of(random)
    make, terms = random.choice(((negotiator_of, Parameters()), (bundler_of, BundleParameters())))
    if kind == "timed":
        make, terms = negotiator_of, Parameters()
    begun, keys = Counter(), keys_of([robot.id for robot in problem.robots])
    net = LyingNetwork(
        lambda robot, number: make(problem, terms, robot, incarnation=number, signatures=keys[robot]),
        [robot.id for robot in problem.robots],
        seed,
        LinkConditions(delay_s=0.02, loss=random.choice((0.0, 0.1))),
        watch=partial(work, lambda: net, begun, random),
    )
    net.lie_with(codec_of(problem), keys[LIAR], random)
    with report.trying():
        net.start()
        net.run(1.5)
        give_orders(net, random)
        net.run(LIES_UNTIL_S)
        net.lies = False
        look_at_the_others(net, begun, report)
    report.counts["mutated"] += net.mutations
    return report


def look_at_the_others(net, begun, report):
    """The liar falls silent: what became of the others, once they agree; `begun`: how often tasks were for good."""
    net.crash(LIAR)
    report.check(net.run(net.now + QUIET_S, lambda: _agree(net)), "the others do not agree")
    for robot, node in net.nodes.items():
        report.check(not node.superseded, f"{robot} was silenced")
        report.counts["refused"] += node.counts.refused.total()
        report.counts["found to state two things"] += len(node.convicted)
    owned = Counter(claim.task for node in net.nodes.values() for claim in node.route)
    teams = next(iter(net.nodes.values())).rules.teams
    report.failures += [f"{task} has {k} owners" for task, k in owned.items() if k > 1 and task not in teams]
    report.failures += [f"{task} was begun {k} times" for task, k in begun.items() if k > 1]


def work(net, begun, random, robot):
    """Honest robots begin their at-most-once tasks now and then."""
    node = net().nodes.get(robot)
    if node is None or robot == LIAR or random.random() > 0.02:
        return
    for claim in node.route:
        if claim.task in node.once and not claim.begun and node.begin(claim.task):
            begun[claim.task] += 1
            return


def give_orders(net, random):
    for robot, name, before in (("r_0", "x1", ()), ("r_1", "x2", ("x1",)), (LIAR, "x3", ())):
        if robot in net.nodes and random.random() < 0.7:
            place = tuple(random.uniform(0, 10) for _ in range(2))
            try:
                net.nodes[robot].announce(Task(id=name, position=place, prerequisites=before))
            except (MissionError, ParameterError):
                continue  # it does not fit into this mission


def _agree(net):
    nodes = list(net.nodes.values())
    together = all(node.settled and set(node.epoch.own.members) == set(net.nodes) for node in nodes)
    return together and len({node.stage for node in nodes}) == 1
