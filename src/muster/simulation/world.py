"""The interface of simulated worlds: robots that move, commands to them, and what is measured of them."""

from __future__ import annotations

import math
from collections.abc import Callable, Collection, Mapping
from dataclasses import dataclass, replace
from typing import Any, Protocol

from muster.mission.model import Robot
from muster.motion.grid import Floats
from muster.motion.noise import Noise
from muster.perception.laser import NO_DISCS, Scanner
from muster.perception.sphere_scanner import SphereScan, SphereScanner
from muster.simulation.port import SimulatedPort

Observer = Callable[[float, Floats, Floats, Floats], None]
"""Called with time in seconds, positions (n, 3), headings (n,) and velocities (n, 3), robots in order of the ports."""


@dataclass(frozen=True)
class WaypointPassed:
    """A labelled way point, or the last one of an order, was passed, its hold included.

    Parameters
    ----------
    time_s
        the time of passing.
    robot, order, passed
        the robot, the number that `send` returned, and how many way points of that order are passed.
    label
        the label of the way point.
    idle
        whether it was the last one, so that the robot stands.
    """

    time_s: float
    robot: str
    order: int
    passed: int
    label: str
    idle: bool


@dataclass(frozen=True)
class Contact:
    """Two robots touched: the time of first contact, and the least distance of their centres so far."""

    time_s: float
    robots: tuple[str, str]
    least_distance_m: float


def standing(robot: Robot, snapshot: Mapping[str, Any]) -> Robot:
    """Return a robot that starts where it stood, and heads as it did, in a snapshot of a world; its end stays."""
    *place, heading = snapshot["robots"][robot.id][:4]
    return replace(robot, position=tuple(place[: len(robot.position)]), heading_deg=math.degrees(heading))


class SimulatedWorld(Protocol):
    """Robots of a mission that move in steps of virtual time; the kinematic and the physics world alike."""

    @property
    def time_s(self) -> float:
        """Seconds since the beginning: a whole number of steps."""
        ...

    @property
    def dt_s(self) -> float:
        """Seconds a step."""
        ...

    @property
    def noise(self) -> Noise:
        """The noise of all robots."""
        ...

    @property
    def ports(self) -> Mapping[str, SimulatedPort]:
        """By the robots' ids, in order of the mission; those that joined come last."""
        ...

    def step(self) -> tuple[WaypointPassed, ...]:
        """Simulate one step."""
        ...

    def advance(self, until_s: float) -> tuple[WaypointPassed, ...]:
        """Simulate until `until_s`, at most to the end of the first step in which a way point was passed.

        Returns
        -------
        what was passed in the last step; nothing when `until_s` is reached. Call it again until it returns nothing.
        """
        ...

    def join(self, robot: Robot) -> SimulatedPort:
        """Add a robot at its position; returns its port.

        Raises
        ------
        ParameterError
            if its id is taken, or its position has not as many coordinates as the mission's.
        """
        ...

    def fail(self, robot: str, *, silent: bool = True) -> None:
        """Let a robot fail: it stops as soon as it can and accepts no way points; `silent`: telemetry freezes too."""
        ...

    def recover(self, robot: str) -> None:
        """Let a failed robot work again, telemetry included; it stands until it gets way points."""
        ...

    def remove(self, robot: str) -> None:
        """Take a robot away: it is nowhere, in nobody's way, and not heard, until it recovers where it was."""
        ...

    def place(self, robot: str, position: tuple[float, ...]) -> None:
        """Put a robot somewhere else: it stands there until it gets way points."""
        ...

    def silence(self, robot: str) -> None:
        """Freeze a robot's telemetry; the robot goes on, and still receives way points."""
        ...

    def unsilence(self, robot: str) -> None:
        """Let a silenced robot's telemetry change again."""
        ...

    def slow(self, robot: str, factor: float) -> None:
        """Multiply a robot's top speed by `factor`, above 0 to 1, from now on."""
        ...

    def close(self, doors: Collection[str]) -> None:
        """From now on these doors of the map are closed, and the others open; one closes when no robot is in it."""
        ...

    def leave_to_traffic(self, robot: str) -> None:
        """From now on who orders a robot says when its way is free: it goes straight, and only brakes for others."""
        ...

    def believe(self, robot: str, pose: Floats, spread_m: float) -> None:
        """Let a robot take itself to be at a pose (4,) of x, y, z and heading, as of now.

        Its way points lead it to where they are by that. What it senses around it, other robots and walls, it senses
        from where it truly is. `spread_m` is a standard deviation that the robot counts with: held up for a second
        on its way to a way point, it has arrived within three of them.
        """
        ...

    def scan(self, robot: str, scanner: Scanner, cylinders: Floats = NO_DISCS, height_m: float | None = None) -> Floats:
        """Ranges of a laser on a robot, without errors: (n,) metres, inf where a beam meets nothing within reach.

        It sees the walls that stop this robot, other robots, and cylinders. `lasers.Laser` adds errors.

        Parameters
        ----------
        cylinders
            (m, 3) of x, y, radius in the map frame; they are at least as high as the laser.
        height_m
            of the laser above the robot's position; None: the middle of its body.

        Raises
        ------
        ParameterError
            if the robot is not in the world, or a number is not finite.
        """
        ...

    def scan_space(self, robot: str, scanner: SphereScanner) -> SphereScan:
        """Return an exact scan all around from where a robot is, of a mission in space.

        It sees what stands in the air, other robots and the ground. What is closed by rule alone is not seen.
        """
        ...

    @property
    def positions(self) -> Floats:
        """True positions: (n, 3), metres."""
        ...

    @property
    def headings(self) -> Floats:
        """True headings: (n,), radians."""
        ...

    @property
    def frames(self) -> Floats:
        """True positions of the body frames: (n, 3), metres; drones of a mission in the plane have a height too."""
        ...

    @property
    def axes(self) -> Floats:
        """True axes of the bodies (ahead, left, up) as the columns of (n, 3, 3) in the map frame."""
        ...

    @property
    def ground_m(self) -> float:
        """The height of the ground: 0, or the lowest position of a mission in space."""
        ...

    @property
    def velocities(self) -> Floats:
        """True velocities in the last step: (n, 3), m/s."""
        ...

    @property
    def distances_m(self) -> Mapping[str, float]:
        """True distance that each robot has travelled, by id."""
        ...

    @property
    def min_distance_m(self) -> float | None:
        """Least distance so far of the centres of two robots of which one was under way; None if there was none."""
        ...

    @property
    def contacts(self) -> tuple[Contact, ...]:
        """Pairs whose centres were ever closer than the sum of their radii while one was under way."""
        ...

    def idle(self, robot: str) -> bool:
        """Whether a robot has passed all its way points, or has none."""
        ...
