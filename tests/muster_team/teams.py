"""Teams of nodes in threads of one test, over transports that are given."""

import threading
from random import Random

import muster
from muster.allocation.auctions.auction import AUCTION, Parameters
from muster.allocation.stop import Stop
from muster.model.problem import Problem
from muster_team.membership.members import Timeouts
from muster_team.negotiators.participation import negotiator_of
from muster_team.network.codec import Codec
from muster_team.network.encryption import Seal, mission_digest
from muster_team.processes.node import Node

KEY = bytes(32)
GUARD_S = 120.0
QUICK = Timeouts(retry_s=0.03, heartbeat_s=0.06)
"""For lossy transports of one machine."""


class Team:
    """A shipped mission, and what its robots' processes are made of."""

    def __init__(self, mission, timeouts=None, **terms):
        self._timeouts = timeouts or Timeouts()
        self.problem = Problem.compile(muster.load(mission)).ready()
        self.terms = Parameters(**terms)
        self.robots = [robot.id for robot in self.problem.robots]
        self.codec = Codec(self.robots, [task.id for task in self.problem.tasks])
        self._digest = mission_digest(self.problem, self.terms)

    def negotiator(self, robot):
        return negotiator_of(self.problem, self.terms, robot, incarnation=1, timeouts=self._timeouts)

    def node(self, robot, transport, key=KEY):
        return Node(self.negotiator(robot), transport, self.codec, Seal(key, self._digest, robot, 1))

    def central_routes(self):
        routes = AUCTION.solve(self.problem, Stop(), params=self.terms).routes
        return {route.robot: list(route.tasks) for route in routes}


def agree(nodes):
    """Run nodes in threads until each of them knows that all agree; their routes."""
    waiting = {node.negotiator.robot for node in nodes}
    settled = threading.Event()

    def run(node):
        with node:
            if node.run(lambda node: node.negotiator.settled, GUARD_S):
                waiting.discard(node.negotiator.robot)
            if not waiting:
                settled.set()
            node.run(lambda _: settled.is_set(), GUARD_S)

    threads = [threading.Thread(target=run, args=(node,)) for node in nodes]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert not waiting
    return {node.negotiator.robot: [claim.task for claim in node.negotiator.route] for node in nodes}


class Lossy:
    """A transport that loses some of what it is to send, and sends some twice."""

    def __init__(self, transport, seed, loss, twice=0.0):
        self._transport, self._random, self._loss, self._twice = transport, Random(seed), loss, twice

    def __getattr__(self, name):
        return getattr(self._transport, name)

    def send(self, data, to=None):
        for _ in range(1 + (self._random.random() < self._twice)):
            if self._random.random() >= self._loss:
                self._transport.send(data, to)
