"""Localisation of each robot by odometry and laser, and its sightings of cylinders that are no landmarks.

The paper's robots know their places by odometry; its landmarks (section 6 names their extraction) serve that too,
in a manner that it does not print. Here an extended Kalman filter takes both in.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from dataclasses import dataclass

import numpy as np

from muster.motion.grid import Floats
from muster.motion.port import Telemetry
from muster.perception import ground_fusion
from muster.perception.estimates import NO_TAG, RawEstimates
from muster.perception.kalman import Estimate, gated
from muster.perception.laser import points_of
from muster.perception.spikes import Landmark, landmarks
from muster.perception.targets import TargetSighting
from muster.simulation import Laser, SimulatedWorld
from muster_studies.market_5.arena import (
    BEACONS,
    BEARING_RAD,
    CYLINDERS,
    ERRORS,
    RANGE_M,
    SCANNER,
    SEARCH,
    START_M,
    START_RAD,
)

NEAR_M = 0.1
"""A cylinder so near to where a landmark should be is that one; so near to where another robot is, that robot."""


@dataclass(frozen=True, eq=False)
class CylinderSighting:
    """One sighting of a cylinder that is no landmark: its position (2,) with covariance, map frame."""

    robot: str
    time_s: float
    place: Estimate


class RobotLocalisation:
    """One robot: its odometry, its laser, and the filter that has both.

    Parameters
    ----------
    world, robot
        at the beginning.
    seed
        of the laser's errors.
    """

    def __init__(self, world: SimulatedWorld, robot: str, seed: int) -> None:
        self.robot = robot
        self._port = world.ports[robot]
        self._laser = Laser(world, robot, SCANNER, seed=seed)
        self._said = self._telemetry()
        index = list(world.ports).index(robot)
        pose = (*world.positions[index, :2], world.headings[index])
        self.odometry = ground_fusion.standing_at(pose, (START_M, START_M, START_RAD), ERRORS)
        self.fused = self.odometry
        self.hits: Floats = np.empty((0, 2))
        """What the last scan hit, (k, 2) in the map, from where the robot took itself to be."""

    def move(self) -> None:
        """Update the filters with odometry since the last call."""
        before, now = self._said, self._telemetry()
        if now.time_s <= before.time_s:
            return
        dt, metres = now.time_s - before.time_s, now.odometry_m - before.odometry_m
        self.odometry, self.fused = (
            ground_fusion.moved_as_counted(one, dt, metres, now.heading, ERRORS) for one in (self.odometry, self.fused)
        )
        self._said = now

    def look(self, others: Iterable[Floats]) -> list[CylinderSighting]:
        """Scan: update the filter with landmarks; return sightings that are neither landmarks nor robots."""
        ranges = self._laser.scan(CYLINDERS)
        self.hits = self._in_map(points_of(ranges, self._laser.bearings))
        marks = landmarks(ranges, self._laser.bearings, SEARCH)
        known = [(mark, beacon) for mark in marks if (beacon := _nearest(self._place(mark), BEACONS)) is not None]
        unknown = [mark for mark in marks if mark not in [mark for mark, _ in known]]
        for mark, beacon in known:
            seen = ground_fusion.by_landmark(self.fused, beacon, mark.range_m, mark.bearing_rad, ERRORS)
            self.fused = gated(self.fused, seen)
        team = [tuple(other) for other in others]
        return [self._seen(mark) for mark in unknown if _nearest(self._place(mark), team) is None]

    def _seen(self, mark: Landmark) -> CylinderSighting:
        pose = Estimate(self.fused.mean[:3], self.fused.covariance[:3, :3])
        target = TargetSighting(pose, mark.range_m, mark.bearing_rad, RANGE_M, BEARING_RAD).target
        return CylinderSighting(self.robot, self._said.time_s, target)

    def _place(self, mark: Landmark) -> tuple[float, float]:
        x, y = self._in_map(np.array(mark.position))
        return float(x), float(y)

    def _in_map(self, points: Floats) -> Floats:
        """Points (..., 2) of the robot's frame in the map frame, by the estimated pose."""
        x, y, heading = self.fused.mean[:3]
        c, s = math.cos(heading), math.sin(heading)
        return np.asarray(points @ np.array([[c, s], [-s, c]]) + [x, y])

    def _telemetry(self) -> Telemetry:
        said = self._port.telemetry()
        assert said is not None  # simulated ports always have some
        return said


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
