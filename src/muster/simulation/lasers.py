"""Lasers on the robots of a world: their mounting, other robots as discs and balls, and measurement errors.

`perception.laser` has the scanner; `SimulatedWorld.scan` measures from a robot's true pose, without errors.
"""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np

from muster.mission.errors import ParameterError
from muster.mission.model import Robot
from muster.mission.values.ranges import require_counts
from muster.motion.grid import Floats
from muster.perception.laser import NO_DISCS, Scanner
from muster.simulation.world import SimulatedWorld

HEIGHT_RADII = 0.47
"""How high ground robots are built, in their radii: those of the physics world, 141 mm at 0.3 m."""
MOUNT_RADII = 0.25
"""How high lasers are mounted on them: above the wheels, below the top, so that robots of one size see each other."""
NOMINAL_RADIUS_M = 0.3
"""In place of a radius of 0."""
_STREAM = (0x1A5E,)
"""Of the errors of lasers, so that they are not those of anything else with the same seed."""


class Laser:
    """A robot's laser in a world. Errors are drawn by seed, robot and step: a second scan in a step is the same.

    Parameters
    ----------
    world, robot
        the robot may not be in the world yet.
    scanner
        by default [market-paper]'s, without error.
    seed
        of its errors.
    height_m
        at which it is mounted; see `SimulatedWorld.scan`.

    Raises
    ------
    ParameterError
        if the seed is below 0.
    """

    def __init__(
        self,
        world: SimulatedWorld,
        robot: str,
        scanner: Scanner | None = None,
        *,
        seed: int = 0,
        height_m: float | None = None,
    ) -> None:
        require_counts(0, seed=seed)
        self.scanner = scanner or Scanner()
        self._world = world
        self._robot = robot
        self._seed = seed
        self._height_m = height_m

    @property
    def bearings(self) -> Floats:
        """Bearings of the beams, (n,) radians from straight ahead, rising."""
        return self.scanner.bearings

    def scan(self, cylinders: Floats = NO_DISCS) -> Floats:
        """What it measures now: (n,) metres, inf where a beam meets nothing within reach.

        Parameters
        ----------
        cylinders
            (m, 3) of x, y, radius: what stands there beside walls and robots.

        Raises
        ------
        ParameterError
            as `SimulatedWorld.scan`.
        """
        exact = self._world.scan(self._robot, self.scanner, cylinders, self._height_m)
        number, step = list(self._world.ports).index(self._robot), round(self._world.time_s / self._world.dt_s)
        errors = np.random.SeedSequence((self._seed, number, step), spawn_key=_STREAM)
        return self.scanner.measured(exact, np.random.default_rng(errors))


def laser_height_m(robot: Robot, height_m: float | None) -> float:
    """The height of a laser above the robot's position: as given, else the middle of its body.

    Raises
    ------
    ParameterError
        if the height is not finite.
    """
    if height_m is None:
        return 0.0 if robot.kind == "air" else MOUNT_RADII * (robot.radius_m or NOMINAL_RADIUS_M)
    if not math.isfinite(height_m):
        raise ParameterError(f"height_m: {height_m}; expected a finite number of metres")
    return height_m


def discs_seen_at(robots: Sequence[Robot], places: Floats, who: int, height_m: float) -> Floats:
    """The other robots as discs at the laser's height in the map frame: (k, 3) of x, y, radius.

    Ground robots are upright cylinders, drones balls. In a mission in the plane drones fly above the others.

    Parameters
    ----------
    places
        (n, 3) metres.
    who
        the number of the one that looks.
    """
    seen = []
    for number, (robot, (x, y, z)) in enumerate(zip(robots, places, strict=True)):
        in_plane = len(robot.position) == 2
        if number == who or robot.radius_m == 0 or (in_plane and robot.kind != robots[who].kind):
            continue
        above = height_m - z
        if robot.kind == "air" and abs(above) < robot.radius_m:
            seen.append((x, y, math.sqrt(robot.radius_m**2 - above**2)))
        elif robot.kind != "air" and 0 <= above <= HEIGHT_RADII * robot.radius_m:
            seen.append((x, y, robot.radius_m))
    return np.array(seen, dtype=np.float64).reshape(-1, 3)
