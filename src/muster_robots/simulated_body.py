"""The body of a simulated robot behind a bridge: it moves exactly by its kinematics, as it is commanded."""

from __future__ import annotations

import math

import numpy as np

from muster.mission.model import Robot
from muster.motion.frames import flu_to_enu, wrapped
from muster.motion.grid import Floats
from muster.motion.kinematics.registry import kinematics_named, limits_of
from muster.motion.port import Place, Waypoint
from muster_robots.follower import Follower
from muster_robots.steering import STILL, SteeredRobot, Steering, Velocity

_DEAF_S = 0.5
"""A robot that gets no velocity command for longer goes to its way point, or stands."""


class SimulatedBody:
    """One robot.

    Parameters
    ----------
    robot
        who it is, where it starts, and its limits.
    rate_hz
        of its steps.
    """

    def __init__(self, robot: Robot, rate_hz: float) -> None:
        self.robot = robot
        x, y, z = (*map(float, robot.position), 0.0)[:3]
        self._state: Floats = np.array([[x, y, z, math.radians(robot.heading_deg)]])
        self._kinematics, self._limits = kinematics_named(robot.kinematics), limits_of(robot)
        self._steering = Steering(interval_s=1 / rate_hz, space=True)
        self._follower = Follower(arrival_m=0.05, turned_rad=0.05, flat=robot.kind == "ground")
        self._told: Velocity = STILL
        self._told_s = -math.inf
        self._inputs: Floats | None = None

    @property
    def pose(self) -> tuple[Place, float]:
        """Where it is, metres, and its heading, radians."""
        x, y, z, heading = map(float, self._state[0])
        return (x, y, z), float(wrapped(heading))

    def drive(self, velocity: Velocity, now: float) -> None:
        """Take a velocity command; the way point is dropped."""
        if all(map(math.isfinite, velocity)):
            self._told, self._told_s = velocity, now
            self._follower.take(())

    def go_to(self, place: Place, heading: float) -> None:
        """Take a way point."""
        self._follower.take([Waypoint(place, heading)])

    def step(self, now: float, dt: float) -> Floats:
        """Move for so many seconds; returns its rates (x, y, z, heading), map frame, m/s and rad/s."""
        place, heading = self.pose
        velocity = self._told if now - self._told_s <= _DEAF_S else self._towards_goal(now, place, heading)
        inputs = self._kinematics.limited(self._as_inputs(velocity, heading), self._limits, self._inputs, dt)
        rates: Floats = self._kinematics.velocities(self._state, inputs)[0]
        self._state = self._kinematics.step(self._state, inputs, dt)
        self._inputs = inputs
        return rates

    def _towards_goal(self, now: float, place: Place, heading: float) -> Velocity:
        self._follower.hear(now, place, heading)
        aim = self._follower.aim
        arrived = aim is not None and self._follower.is_at(place, aim)
        steered = SteeredRobot(self.robot, place, heading, (0.0, 0.0, 0.0), aim, arrived)
        return self._steering.velocities([steered])[self.robot.id]

    def _as_inputs(self, velocity: Velocity, heading: float) -> Floats:
        ahead, left, up, turning = velocity
        if len(self._kinematics.input_names) == 2:
            return np.array([[ahead, turning]])
        if self._kinematics.input_names[0] == "ahead_mps":
            return np.array([[ahead, left, up, turning]])
        return np.array([[*flu_to_enu((ahead, left, up), heading), turning]])
