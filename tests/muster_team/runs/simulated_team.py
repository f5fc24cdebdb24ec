"""Robots that decide for themselves, all in one process and in virtual time: controls, bodies, a simulated network."""

from collections import Counter

from muster.allocation.auctions.auction import Parameters
from muster.model.problem import Problem
from muster.simulation import KinematicWorld
from muster_team.negotiators.participation import negotiator_of
from muster_team.network.memory_network import LinkConditions, MemoryNetwork
from muster_team.runs.robot_control import RobotControl

LOOK_S = 0.2


class SimulatedTeam:
    """The robots of a mission. Robots named in `later` join when they are started.

    Attributes
    ----------
    net, world, controls
        of all robots; `controls` by robot, of those that live.
    told, last_words
        (time, robot, kind, data) of what robots did; and of it what they did just before they crashed.
    """

    def __init__(self, mission, *, seed=0, links=None, later=(), **conditions):
        self.problem = self.problem_of(mission)
        self.world = KinematicWorld(mission, seed=seed)
        self.robots = [robot.id for robot in self.problem.robots]
        self.net = MemoryNetwork(self._negotiator, self.robots, seed, LinkConditions(**conditions), links)
        self.last_words = []
        self.controls, self.told, self._memories, self._later = {}, [], {}, frozenset(later)
        self._used = dict.fromkeys(self.robots, 0.0)
        for robot in self.robots:
            if robot not in later:
                self.start(robot)

    def problem_of(self, mission):
        """What robots know of the mission."""
        return Problem.compile(mission).ready()

    def _negotiator(self, robot, incarnation):
        remembered, forgot = self._memories.pop(robot, None), incarnation > 1
        return negotiator_of(
            self.problem,
            Parameters(),
            robot,
            incarnation=incarnation,
            remembered=remembered,
            forgot=forgot and remembered is None,
            absent=self._later,
        )

    def start(self, robot, *, remembers=True):
        if not remembers:
            self._memories.pop(robot, None)
        self.net.start([robot])
        now, port = self.world.time_s, self.world.ports[robot]
        self.controls[robot] = RobotControl(self.problem, port, self.net.nodes[robot], now, self._used[robot])

    def crash(self, robot):
        """Its body stops, and its process is gone."""
        self.world.fail(robot)
        self.last_words += [word for word in self.told if word[1] == robot and word[0] > self.world.time_s - 0.5]
        self._used[robot] = self.controls.pop(robot).used
        self._memories[robot] = self.net.crash(robot).memory

    def restart(self, robot, **more):
        self.world.recover(robot)
        self.start(robot, **more)

    def run(self, until_s, until=lambda: False):
        """Let time go by, at most up to then; whether `until` came true."""
        while self.world.time_s < until_s - 1e-9:
            if until():
                return True
            now = round(self.world.time_s + LOOK_S, 9)
            while self.world.advance(now):
                pass
            self.net.run(now)
            self.step(now)
        return until()

    def step(self, now):
        """Let robots control their bodies, and tell what they did."""
        for robot, control in self.controls.items():
            self.told += [(h.time_s, robot, h.kind, h.data) for h in control.tick(now)]

    @property
    def rests(self):
        """Whether all that live agree, know the same, and have nothing to do."""
        nodes = self.net.nodes.values()
        if len({node.known for node in nodes}) > 1:
            return False
        alone = all(set(node.epoch.own.members) == set(self.net.nodes) for node in nodes)
        return alone and all(node.settled for node in nodes) and all(control.idle for control in self.controls.values())

    def times(self, kind):
        """How often something was done to each task."""
        return Counter(data["task"] for _, _, said, data in self.told if said == kind)
