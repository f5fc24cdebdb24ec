"""What a world is: robots that move and can be told to, whatever moves them, and what is measured of them."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Protocol

from muster.mission.model import Robot
from muster.motion.grid import Floats
from muster.perception.laser import NO_DISCS, Scanner
from muster.simulation.noise import Noise
from muster.simulation.port import SimulatedPort

Observer = Callable[[float, Floats, Floats, Floats], None]
"""Called with time in seconds, positions (n, 3), headings (n,) and velocities (n, 3), robots in order of the ports."""


@dataclass(frozen=True)
class WaypointPassed:
    """A labelled way point was passed, hold included, or all of an order were.

    Parameters
    ----------
    time_s
        when.
    robot, order, passed
        whose, of which `send`, and how many of its way points are passed.
    label
        of the way point.
    idle
        whether it was the last, so that the robot has nothing to do.
    """

    time_s: float
    robot: str
    order: int
    passed: int
    label: str
    idle: bool


@dataclass(frozen=True)
class Contact:
    """Two robots touched: when first, and the least distance that their centres ever had."""

    time_s: float
    robots: tuple[str, str]
    least_distance_m: float


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
        """Of all robots."""
        ...

    @property
    def ports(self) -> Mapping[str, SimulatedPort]:
        """By the robots' ids, in order of the mission; those that joined come last."""
        ...

    def step(self) -> tuple[WaypointPassed, ...]:
        """Let one step go by."""
        ...

    def advance(self, until_s: float) -> tuple[WaypointPassed, ...]:
        """Let time go by until `until_s`, at most to the end of the first step in which something was passed."""
        ...

    def join(self, robot: Robot) -> SimulatedPort:
        """A robot comes into the world, where it says; returns its port."""
        ...

    def fail(self, robot: str, *, silent: bool = True) -> None:
        """It stops as soon as it can and takes no more way points; `silent`: it says nothing more either."""
        ...

    def recover(self, robot: str) -> None:
        """It works and speaks again; it stands until it is sent."""
        ...

    def silence(self, robot: str) -> None:
        """Its telemetry stays what it is; the robot goes on, and orders still reach it."""
        ...

    def unsilence(self, robot: str) -> None:
        """Its telemetry goes on."""
        ...

    def slow(self, robot: str, factor: float) -> None:
        """From now on its top speed is its own times `factor`, above 0 to 1."""
        ...

    def scan(self, robot: str, scanner: Scanner, cylinders: Floats = NO_DISCS, height_m: float | None = None) -> Floats:
        """What a laser on a robot would measure without error: (n,) metres, inf where a beam meets nothing in reach.

        It sees the walls that stop this robot, other robots, and cylinders. `lasers.Laser` errs too.

        Parameters
        ----------
        cylinders
            (m, 3) of x, y, radius in the map frame: what stands there, at least as high as the laser.
        height_m
            of the laser above the robot's place; None: amid its body.

        Raises
        ------
        ParameterError
            if the robot is not in the world, or a number is not finite.
        """
        ...

    @property
    def positions(self) -> Floats:
        """True ones: (n, 3), metres."""
        ...

    @property
    def headings(self) -> Floats:
        """True ones: (n,), radians."""
        ...

    @property
    def frames(self) -> Floats:
        """Where the bodies' frames truly are: (n, 3), metres, with the height of drones in the plane too."""
        ...

    @property
    def axes(self) -> Floats:
        """True axes of the bodies, ahead, left and up, as the columns of (n, 3, 3) in the map frame."""
        ...

    @property
    def ground_m(self) -> float:
        """How high the ground is."""
        ...

    @property
    def velocities(self) -> Floats:
        """Of the last step, true ones: (n, 3), m/s."""
        ...

    @property
    def distances_m(self) -> Mapping[str, float]:
        """What each robot has truly travelled, by id."""
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
        """Whether it has passed all its way points, or has none."""
        ...
