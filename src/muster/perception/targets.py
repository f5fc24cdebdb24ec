"""The position of a target that several robots see: their sightings in the map, weighed by their information.

[market-paper] (sections 4.2 and 5) measures the error of its rangeBot's targets and prints no rule for joining
sightings. Here sightings with range and bearing are averaged by their information, which is optimal for independent
errors; bearings alone are intersected.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from muster.mission.errors import ParameterError
from muster.perception.kalman import Estimate, Floats

_PARALLEL = 1e-9


@dataclass(frozen=True, eq=False)
class TargetSighting:
    """A target seen by one robot.

    Parameters
    ----------
    pose
        of the robot, (3,) with its covariance: x, y, heading, map frame.
    range_m, bearing_rad
        of the target from the robot; bearing from straight ahead, anticlockwise.
    range_deviation_m, bearing_deviation_rad
        standard deviations of both.

    Raises
    ------
    ParameterError
        if the pose is not of three numbers.
    """

    pose: Estimate
    range_m: float
    bearing_rad: float
    range_deviation_m: float
    bearing_deviation_rad: float

    def __post_init__(self) -> None:
        if len(self.pose.mean) != 3:
            raise ParameterError(f"pose: {len(self.pose.mean)} numbers; expected x, y, heading")

    @property
    def target(self) -> Estimate:
        """The target's position (2,), map frame; the covariance to first order."""
        x, y, heading = self.pose.mean
        direction = heading + self.bearing_rad
        c, s = math.cos(direction), math.sin(direction)
        ahead, left = np.array([c, s]), np.array([-s, c])
        by_pose = np.column_stack([np.eye(2), self.range_m * left])
        by_sight = np.column_stack([ahead, self.range_m * left])
        of_sight = np.diag([self.range_deviation_m**2, self.bearing_deviation_rad**2])
        spread = by_pose @ self.pose.covariance @ by_pose.T + by_sight @ of_sight @ by_sight.T
        return Estimate(np.array([x, y]) + self.range_m * ahead, spread)


def averaged(estimates: Sequence[Estimate]) -> Estimate:
    """One estimate (n,) from several independent ones of the same thing, each weighed by its information P^-1.

    Raises
    ------
    ParameterError
        if there is none, or one is exact in some direction.
    """
    if not estimates:
        raise ParameterError("estimates: none; expected at least one")
    try:
        information = [np.linalg.inv(estimate.covariance) for estimate in estimates]
    except np.linalg.LinAlgError:
        raise ParameterError("estimates: one without variance in some direction; expected variance in all") from None
    covariance = np.linalg.inv(np.sum(information, axis=0))
    weighed = np.sum([i @ estimate.mean for i, estimate in zip(information, estimates, strict=True)], axis=0)
    return Estimate(covariance @ weighed, covariance)


def crossing(places: Floats, directions: Floats) -> tuple[float, float] | None:
    """The point that is nearest, in least squares, to lines from places (n, 2) in directions (n,) radians of the map.

    None where the lines are parallel, or there is one only.

    Raises
    ------
    ParameterError
        for other shapes.
    """
    if places.ndim != 2 or places.shape[1] != 2 or directions.shape != (len(places),):
        raise ParameterError(f"places, directions: shapes {places.shape}, {directions.shape}; expected (n, 2), (n,)")
    normals = np.column_stack([-np.sin(directions), np.cos(directions)])
    square = normals.T @ normals
    if np.linalg.eigvalsh(square)[0] <= _PARALLEL * len(places):
        return None
    x, y = np.linalg.solve(square, normals.T @ (normals * places).sum(axis=1))
    return float(x), float(y)
