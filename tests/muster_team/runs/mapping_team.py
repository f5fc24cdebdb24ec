"""Robots without a map that decide for themselves, in virtual time: each sends pieces over a lossy network."""

from random import Random

import numpy as np
from tests.muster_team.runs.simulated_team import SimulatedTeam

from muster.execution.record import NoObserver
from muster.motion.map_world import World
from muster_team.network.map_link import MapLink
from muster_team.network.plain_values import MalformedError
from muster_team.runs.robot_control import RobotControl
from muster_team.runs.robot_ground import RobotGround
from muster_team.runs.scanned_ground import ScannedGround
from muster_team.runs.team_log import TeamLog


class MappingTeam(SimulatedTeam):
    """See `SimulatedTeam`; the robots have no map.

    Attributes
    ----------
    ground, grounds
        what lidars see, and the ground as each robot knows it.
    least
        the least distance of a robot from an obstacle, in its radii.
    garbles
        changes the messages of maps on their way; by default it does not.
    """

    def __init__(self, mission, *, seed=0, loss=0.0, delay_s=0.05, **more):
        self.ground, self.grounds, self.least = ScannedGround(mission), {}, np.inf
        self.garbles = lambda data: data
        self._truth, self._random, self._loss, self._delay_s = World.of(mission), Random(seed), loss, delay_s
        self._asked, self._true = self.ground.mission, mission
        self._began = False
        super().__init__(mission, seed=seed, loss=loss, delay_s=delay_s, **more)
        self.log = TeamLog(self.problem, NoObserver(), lambda event: None)
        self.ground.begin_in(self.world, self, self.log)

    def problem_of(self, mission):
        return super().problem_of(self._asked)

    @property
    def ports(self):
        return self.world.ports

    def start(self, robot, *, remembers=True):
        super().start(robot, remembers=remembers)
        life, beat_s = self.net.incarnations[robot], self.net.nodes[robot].timeouts.heartbeat_s
        link = MapLink(robot, life, self.robots, beat_s)
        ground = self.grounds[robot] = RobotGround(self.problem, self.ground.known, robot, link)
        ground.inform(self.net.nodes[robot])
        port, now = self.world.ports[robot], self.world.time_s
        negotiator = self.net.nodes[robot]
        self.controls[robot] = RobotControl(self.problem, port, negotiator, now, self._used[robot], ground=ground)
        self.ground.forget(robot)

    def crash(self, robot):
        super().crash(robot)
        del self.grounds[robot]

    def step(self, now):
        scans = self.ground.scans(self.controls, self.controls)
        for robot, scan in scans.items():
            self.ground.take(robot, self.net.incarnations[robot], self.grounds[robot].see(scan))
        for robot, ground in self.grounds.items():
            self._post(robot, ground.link.tick(now))
        super().step(now)
        self.ground.follow()
        for robot, place in zip(self._true.all_robots, self.world.positions, strict=True):
            clearance = self._truth.clearance(place[None, : self._truth.dimensions], robot.kind)[0]
            self.least = min(self.least, clearance / robot.radius_m)

    def _post(self, sender, out):
        for data, to in out:
            for other in self.robots if to is None else (to,):
                if other != sender and self.net._joined(sender, other) and self._random.random() >= self._loss:
                    self.net.at(self.net.now + self._delay_s, lambda other=other, data=data: self._deliver(other, data))

    def _deliver(self, robot, data):
        if robot in self.grounds:
            try:
                self._post(robot, self.grounds[robot].link.handle(self.garbles(data), self.net.now))
            except MalformedError:
                self.net.counts["malformed"] += 1

    def done(self):
        """The tasks that were done, each with its robots."""
        found = {}
        for _, robot, kind, data in self.told:
            if kind == "ends":
                found.setdefault(data["task"], []).append(robot)
        return found
