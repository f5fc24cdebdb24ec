"""A simulated robot that knows the map: its laser scans correct its pose by Monte Carlo localisation."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from muster.motion.frames import wrapped
from muster.motion.grid import Floats
from muster.motion.map_world import Body, World
from muster.motion.maps.free_points import free
from muster.perception.errors import ReckoningErrors
from muster.perception.joint_estimate import HEADING, JointEstimate, X, Y, Z
from muster.perception.laser import Scanner
from muster.perception.likelihood_field import LikelihoodField
from muster.perception.monte_carlo import MonteCarlo, MonteCarloParameters
from muster.simulation.lasers import Laser
from muster.simulation.pose_sensors import Readings, SensorParameters
from muster.simulation.walls import faces_and_slabs
from muster.simulation.world import SimulatedWorld

_STREAM = 0x5CA2
_LEAST = np.array([0.005, 0.005, 0.0, 0.005])
"""Deviations with which a pose by the particles counts at least, in m and rad; its height does not count."""
MOST_PARTICLES = 4000
"""A robot that knows where it starts needs no more to stay found."""


@dataclass(frozen=True, kw_only=True)
class MapScanParameters(SensorParameters):
    """Scans compared with the walls of the mission's map.

    Parameters
    ----------
    rate_hz
        scans a second.
    reach_m
        as far as the laser sees.
    range_m
        standard deviation of each range.
    """

    rate_hz: float = 2.0
    reach_m: float = 8.0
    range_m: float = 0.02


@dataclass(frozen=True, eq=False)
class ScannedMap:
    """What a body's laser could see of a map, and where the body could be.

    Parameters
    ----------
    walls
        (k, 4) the x, y of both ends, metres.
    field
        of these walls.
    """

    world: World
    body: Body
    walls: Floats
    field: LikelihoodField

    @classmethod
    def of(cls, world: World, body: Body) -> ScannedMap:
        """The walls that stop the body."""
        walls = np.asarray(faces_and_slabs(world, body)[0][:, :4])
        return cls(world, body, walls, LikelihoodField.of_walls(walls))

    def anywhere(self, random: np.random.Generator, count: int) -> Floats:
        """Poses (count, 3) at which the body could be: x, y in metres, heading in radians."""
        space = self.world.free_space(self.body.radius_m, self.body.kind, three_d=False)
        ends = self.walls.reshape(-1, 2)
        places = np.empty((0, 2))
        while len(places) < count:
            drawn = random.uniform(ends.min(axis=0), ends.max(axis=0), (2 * count + 10, 2))
            places = np.concatenate([places, drawn[free(space, drawn)]])
        return np.column_stack([places[:count], random.uniform(-math.pi, math.pi, count)])


class MapScans:
    """See `MapScanParameters`. Particles move as the estimate does, and their pose takes its place: it holds all scans.

    `errors` are those of the robot's dead reckoning; particles spread by twice as much, so that they cover the truth.
    """

    def __init__(
        self,
        world: SimulatedWorld,
        robot: str,
        walls: ScannedMap,
        how: MapScanParameters,
        errors: ReckoningErrors,
        seed: int,
    ) -> None:
        number = list(world.ports).index(robot)
        key = np.random.SeedSequence((seed, number), spawn_key=(_STREAM,))
        scanner = Scanner(reach_m=how.reach_m, step_rad=math.radians(1), range_m=how.range_m)
        self._world, self._laser = world, Laser(world, robot, scanner, seed=seed)
        self._readings = Readings(how.rate_hz, 0.0, 1.0, np.random.default_rng(key))
        x, y, _ = map(float, world.positions[number])
        self._particles = MonteCarlo(
            walls.field,
            walls.anywhere,
            MonteCarloParameters(
                most=MOST_PARTICLES,
                way_share=max(0.1, 2 * errors.way_share),
                turn_share=max(0.1, 2 * errors.turn_share),
                turn_per_m=max(0.05, 2 * errors.turn_per_m * math.sqrt(world.dt_s * how.rate_hz)),
            ),
            seed=int(key.generate_state(1)[0]),
            start=(x, y, float(world.headings[number])),
            deviations=(0.01, 0.01, 0.01),
        )
        self._before: Floats | None = None

    def corrected(self, estimate: JointEstimate) -> JointEstimate:
        """See `PoseSensor`."""
        if not self._readings.due(self._world.time_s):
            return estimate
        now = estimate.mean[[X, Y, HEADING]]
        if self._before is not None:
            self._particles.move(*_move(self._before, now))
        self._particles.correct(self._laser.scan(), self._laser.bearings)
        found = self._particles.estimate
        x, y, heading = found.mean
        deviations = np.maximum(_LEAST, [*found.deviations[:2], estimate.deviations[Z], found.deviations[2]])
        estimate = estimate.with_pose([x, y, estimate.mean[Z], heading], deviations)
        self._before = estimate.mean[[X, Y, HEADING]]
        return estimate


def _move(before: Floats, now: Floats) -> tuple[float, float, float]:
    """From one pose (3,) to another, in the axes of the first: metres ahead and to the left, and radians."""
    east, north = map(float, now[:2] - before[:2])
    c, s = math.cos(before[2]), math.sin(before[2])
    return c * east + s * north, c * north - s * east, float(wrapped(now[2] - before[2]))
