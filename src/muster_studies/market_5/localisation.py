"""Sightings of cylinders that are no landmarks, from where each robot takes itself to be.

The paper's robots know their places by odometry; its landmarks (section 6 names their extraction) serve that too,
in a manner that it does not print. Here an extended Kalman filter takes both in, and robots steer by it.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from dataclasses import dataclass

import numpy as np

from muster.motion.grid import Floats
from muster.perception.estimates import NO_TAG, RawEstimates
from muster.perception.joint_estimate import HEADING, X, Y
from muster.perception.kalman import Estimate
from muster.perception.laser import points_of
from muster.perception.spikes import Landmark, landmarks
from muster.perception.targets import TargetSighting
from muster.running.localisation import ReckonedPose
from muster.running.simulation import Simulation
from muster.running.state_estimation import LocalisedPort
from muster.simulation import Laser
from muster_studies.market_5.arena import BEACONS, BEARING_RAD, CYLINDERS, RANGE_M, SCANNER, SEARCH

NEAR_M = 0.1
"""A cylinder so near to where a landmark should be is that one; so near to where another robot is, that robot."""
_POSE = np.array([X, Y, HEADING])


@dataclass(frozen=True, eq=False)
class CylinderSighting:
    """One sighting of a cylinder that is no landmark: its position (2,) with covariance, map frame."""

    robot: str
    time_s: float
    place: Estimate


class RobotLocalisation:
    """One robot: where it takes itself to be, and what its laser shows from there.

    Parameters
    ----------
    simulation, robot
        in which robots localise themselves by odometry at least.
    seed
        of the laser's errors: that of the simulation, so that this is the laser by which it localises itself.
    """

    def __init__(self, simulation: Simulation, robot: str, seed: int) -> None:
        self.robot = robot
        port = simulation.robots.ports[robot]
        assert isinstance(port, LocalisedPort)
        assert isinstance(port.estimate, ReckonedPose)
        self._reckoned, self._world = port.estimate, simulation.world
        self._laser = Laser(simulation.world, robot, SCANNER, seed=seed)
        self.hits: Floats = np.empty((0, 2))
        """What the last scan hit, (k, 2) in the map, from where the robot took itself to be."""

    @property
    def pose(self) -> Estimate:
        """Where it takes itself to be: x, y and heading."""
        estimate = self._reckoned.estimate
        return Estimate(estimate.mean[_POSE], estimate.pose_covariance[np.ix_(_POSE, _POSE)])

    def look(self, others: Iterable[Floats]) -> list[CylinderSighting]:
        """Scan; return sightings that are neither landmarks nor robots."""
        ranges = self._laser.scan(CYLINDERS)
        self.hits = self._in_map(points_of(ranges, self._laser.bearings))
        known = [*BEACONS, *(tuple(other) for other in others)]
        marks = landmarks(ranges, self._laser.bearings, SEARCH)
        return [self._seen(mark) for mark in marks if _nearest(self._place(mark), known) is None]

    def _seen(self, mark: Landmark) -> CylinderSighting:
        target = TargetSighting(self.pose, mark.range_m, mark.bearing_rad, RANGE_M, BEARING_RAD).target
        return CylinderSighting(self.robot, self._world.time_s, target)

    def _place(self, mark: Landmark) -> tuple[float, float]:
        x, y = self._in_map(np.array(mark.position))
        return float(x), float(y)

    def _in_map(self, points: Floats) -> Floats:
        """Points (..., 2) of the robot's frame in the map frame, by the estimated pose."""
        x, y, heading = self.pose.mean
        c, s = math.cos(heading), math.sin(heading)
        return np.asarray(points @ np.array([[c, s], [-s, c]]) + [x, y])


def raw_estimates(seen: Sequence[CylinderSighting]) -> RawEstimates:
    """The list of all robots' sightings, as those of cameras are."""
    return RawEstimates(
        np.array([one.place.mean for one in seen]).reshape(-1, 2),
        np.array([one.place.covariance for one in seen]).reshape(-1, 2, 2),
        np.full(len(seen), NO_TAG, dtype=np.int64),
        tuple(one.robot for one in seen),
        np.array([one.time_s for one in seen]),
    )


def _nearest(place: tuple[float, float], others: Sequence[tuple[float, ...]]) -> tuple[float, ...] | None:
    """Which of the others is nearest, if that is within `NEAR_M`."""
    nearest = min(others, key=lambda other: math.dist(place, other), default=None)
    return nearest if nearest is not None and math.dist(place, nearest) <= NEAR_M else None
