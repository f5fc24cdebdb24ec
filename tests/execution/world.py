"""A tiny world: robots are points that go straight at their speed, exactly, and say exactly where they are."""

import math

from muster.execution.robots.task_motion import place
from muster.motion.port import Telemetry

FAILURES = ("robot_fails", "robot_removed", "robot_moved", "robot_silent", "robot_returns", "robot_joins")


class Point:
    """One robot and its port."""

    def __init__(self, robot, now=0.0):
        self.robot, self.speed = robot.id, robot.speed_mps
        self.position, self.odometry = place(robot.position), 0.0
        self.order = self.passed = 0
        self.waypoints, self.held = [], 0.0
        self.broken = self.mute = self.slow = False
        self.refuses = ()  # places to which it will not go
        self.waits_for = None  # whom it says to wait for; then it stands
        self.now, self.last, self.sent = now, None, 0

    def send(self, waypoints):
        self.sent += 1
        if not self.mute:  # a robot that is not reached goes on with what it had
            self.order, self.passed, self.waypoints, self.held = self.sent, 0, list(waypoints), 0.0
        return self.sent

    def cancel(self):
        return self.send([])

    def put(self, position):
        """Somebody puts it elsewhere: it stands there."""
        self.position, self.waypoints = place(position), []

    def telemetry(self):
        return self.last

    def step(self, dt):
        """Go on exactly: to the next way point, hold, and on to the one after it."""
        refused = self.passed < len(self.waypoints) and self.waypoints[self.passed].position in self.refuses
        left = 0.0 if self.broken or refused or self.waits_for else dt
        while left > 0 and self.passed < len(self.waypoints):
            goal = self.waypoints[self.passed]
            way = math.dist(self.position, goal.position)
            if way > left * self.speed:
                share = left * self.speed / way
                self.position = tuple(a + share * (b - a) for a, b in zip(self.position, goal.position, strict=True))
                self.odometry += left * self.speed
                break
            self.position, self.odometry = goal.position, self.odometry + way
            left -= way / self.speed
            stays = min(left, goal.hold_s - self.held)
            self.held, left = self.held + stays, left - stays
            if self.held < goal.hold_s - 1e-9:
                break
            self.passed, self.held = self.passed + 1, 0.0
        self.now += dt
        if not self.mute:
            counted = self.odometry, self.order, self.passed
            why = "no way, it says" if refused else ""
            still = (0.0, 0.0, 0.0)
            self.last = Telemetry(self.now, self.position, 0.0, still, *counted, refused=why, waits_for=self.waits_for)


class World:
    """The robots of a mission, and what its script does to their bodies."""

    def __init__(self, mission):
        self.now = 0.0
        self.ports = {robot.id: Point(robot) for robot in mission.robots}
        self._script = sorted((e for e in mission.events if any(getattr(e, k) for k in FAILURES)), key=lambda e: e.at_s)
        for point in self.ports.values():
            point.step(0.0)

    def position(self, robot):
        return self.ports[robot].position

    def step(self, dt):
        self.now += dt
        while self._script and self._script[0].at_s <= self.now:
            event = self._script.pop(0)
            if event.robot_joins is not None:
                self.ports[event.robot_joins.id] = Point(event.robot_joins, self.now - dt)
            if event.robot_moved is not None:
                self.ports[event.robot_moved.robot].put(event.robot_moved.position)
            down = event.robot_fails or event.robot_removed
            for name in filter(None, (down, event.robot_silent, event.robot_returns)):
                if name in self.ports:
                    self.ports[name].broken = down is not None
                    self.ports[name].mute = event.robot_silent is not None
        for point in self.ports.values():
            point.step(dt)


def carry_out(executor, world, *, step=0.1, until=10_000.0, each=None):
    """Until the mission is over, or a time."""
    executor.tick(world.now)
    while not executor.done and world.now < until:
        world.step(step)
        if each is not None:
            each(world, executor)
        executor.tick(world.now)
    return executor
