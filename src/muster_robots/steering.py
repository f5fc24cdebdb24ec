"""Steers robots to their way points by velocities, around each other: the thesis' RVO_planner and velocity_publisher.

[tcf-thesis], Table 5.2. A method of `motion/avoidance` chooses the velocity, ORCA by default or the thesis' RVO, and
the robot's kinematics turn it into what it can do within its limits. Robots on the ground give way to each other in the
plane; those in the air too, in space where the mission is in space; nobody to those of the other kind.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from muster.mission.model import Robot
from muster.motion.avoidance import Agents, Avo, Hrvo, Method, Orca, Rvo
from muster.motion.avoidance.orca import Parameters
from muster.motion.avoidance_names import AUTO
from muster.motion.frames import enu_to_flu
from muster.motion.grid import Floats
from muster.motion.kinematics.kinematics import approach
from muster.motion.kinematics.registry import kinematics_named, limits_of
from muster.motion.port import Place, Waypoint

_TO_THE_RIGHT = math.radians(1.0)
"""By which everybody aims aside: two that meet head on then pass each other on one side."""
SETTLES_S = 0.4
"""How fast robots come to their way points at the end: several times the delay from a pose to what is done about it."""
_STANDS = 1e9
"""Priority of a robot that stands: the others go around it."""

_ORCA = Orca(Parameters(horizon_s=2.0, wall_horizon_s=2.0))
_METHODS: Mapping[str, Method | None] = {
    AUTO: _ORCA,  # what keeps real robots apart by itself: no right of way is over them
    "orca": _ORCA,
    "rvo": Rvo(),
    "hrvo": Hrvo(),
    "avo": Avo(),
    "none": None,
}

Velocity = tuple[float, float, float, float]
"""Ahead, left, up in m/s, and yaw rate in rad/s: of a body."""
STILL: Velocity = (0.0, 0.0, 0.0, 0.0)


@dataclass(frozen=True)
class SteeredRobot:
    """A robot, where it is, and where it is to go.

    Parameters
    ----------
    position, heading, velocity
        map frame: metres, radians, m/s.
    aim
        None: it stands.
    arrived
        whether it is at the aim: then it turns to its heading.
    waits
        whether it has done what it was told, and may be moved aside.
    """

    robot: Robot
    position: Place
    heading: float
    velocity: Place
    aim: Waypoint | None
    arrived: bool
    waits: bool = False

    @property
    def goes(self) -> bool:
        return self.aim is not None and not self.arrived

    @property
    def top_speed_mps(self) -> float:
        """The greatest on its way to the aim."""
        return self.robot.speed_mps if self.aim is None else min(self.robot.speed_mps, self.aim.speed_mps)


class Steering:
    """Keeps the last inputs of each robot, which limit the next ones.

    Parameters
    ----------
    interval_s
        between two calls.
    space
        whether those that fly have heights.
    margin_m
        by which robots are taken for larger.
    avoidance
        how they pass each other: orca (which `auto` is, too), rvo or hrvo (in the plane), or none.
    """

    def __init__(self, *, interval_s: float, space: bool, margin_m: float = 0.05, avoidance: str = "orca") -> None:
        self._interval_s = interval_s
        self._space = space
        self._margin_m = margin_m
        self._method = _METHODS[avoidance]
        self._before: dict[str, Floats] = {}

    def velocities(self, team: Sequence[SteeredRobot]) -> dict[str, Velocity]:
        """What each robot is to do in the next interval, by its id."""
        told: dict[str, Velocity] = {}
        for kind in ("ground", "air"):
            crowd = [steered for steered in team if steered.robot.kind == kind]
            if crowd:
                chosen = self._chosen(crowd, 3 if kind == "air" and self._space else 2)
                told |= {one.robot.id: self._told(one, velocity) for one, velocity in zip(crowd, chosen, strict=True)}
        return told

    def forget(self, robot: str) -> None:
        """It stands: it begins from rest."""
        self._before.pop(robot, None)

    def _chosen(self, crowd: Sequence[SteeredRobot], size: int) -> Floats:
        """Velocities (n, 3) on which nobody meets anybody, as far as the method goes.

        ORCA starts from what robots would do, not from what they do ([berg2011], section 5.2): the latter
        lags behind, and where a robot alone must give way it would forbid it to brake beside one that is far away.
        """
        preferred = np.array([self._preferred(steered, size) for steered in crowd])
        agents = Agents(
            positions=np.array([steered.position[:size] for steered in crowd]),
            velocities=np.where(
                [[steered.goes] for steered in crowd],
                preferred,
                np.array([steered.velocity[:size] for steered in crowd]),
            ),
            preferred=preferred,
            radii=np.array([self._radius(steered.robot) for steered in crowd]),
            max_speeds=np.array([steered.top_speed_mps for steered in crowd]),
            priorities=np.array([steered.robot.avoidance_priority if steered.goes else _STANDS for steered in crowd]),
        )
        chosen = np.zeros((len(crowd), 3))
        if self._method is None:
            chosen[:, :size] = preferred
        else:
            chosen[:, :size] = self._method.velocities(agents, dt=self._interval_s)
        chosen[[not steered.goes for steered in crowd]] = 0.0
        return chosen

    def _radius(self, robot: Robot) -> float:
        return robot.radius_m + self._margin_m if robot.radius_m > 0 else 0.0

    def _preferred(self, steered: SteeredRobot, size: int) -> Floats:
        """Straight to the aim, so slow that it can stop there."""
        if steered.aim is None or steered.arrived:
            return np.zeros(size)
        limits = limits_of(steered.robot)
        offset = np.subtract(steered.aim.position[:size], steered.position[:size])
        far = float(np.linalg.norm(offset))
        if far == 0:
            return np.zeros(size)
        brakes = math.sqrt(2 * limits.acceleration_mps2 * far)
        wanted = approach(offset[None], min(limits.speed_mps, steered.aim.speed_mps, brakes), SETTLES_S)[0]
        c, s = math.cos(_TO_THE_RIGHT), math.sin(_TO_THE_RIGHT)
        wanted[:2] = (c * wanted[0] + s * wanted[1], c * wanted[1] - s * wanted[0])
        return np.asarray(wanted)

    def _told(self, steered: SteeredRobot, velocity: Floats) -> Velocity:
        if steered.aim is None:
            self.forget(steered.robot.id)
            return STILL
        kinematics, limits = kinematics_named(steered.robot.kinematics), limits_of(steered.robot)
        states = np.array([[*steered.position, steered.heading]])
        heading = None if steered.aim.heading is None else np.array([steered.aim.heading])
        wanted = kinematics.inputs(states, velocity[None], heading, limits)
        before = self._before.get(steered.robot.id, np.zeros_like(wanted))
        inputs = kinematics.limited(wanted, limits, before, self._interval_s)
        self._before[steered.robot.id] = inputs
        rates = kinematics.velocities(states, inputs)[0]
        ahead, left, up = map(float, enu_to_flu(rates[:3], steered.heading))
        return ahead, left, up, float(rates[3])
