"""The pose of a robot by dead reckoning, and what corrects it: an extended Kalman filter for robots of all kinds.

[tcf-thesis], section 2.1.1: odometry and inertial unit are integrated, and landmarks at known places, motion capture
or satellites keep the result from drifting. What odometry counts is in axes of the robot, so that an error of the
heading leads the position astray; no heading is measured but by a gyro, as a rate, and by what corrects the pose.

The state is (6,): x, y, z in metres and heading in radians of the map frame, kept in [-pi, pi); bias of the gyro in
rad/s; slip, the share of the counted way and turn that is not travelled.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from muster.motion.frames import wrapped
from muster.perception.errors import ReckoningErrors
from muster.perception.kalman import (
    Correction,
    Estimate,
    Floats,
    corrected,
    extended_correction,
    extended_prediction,
    require_seconds,
)

X, Y, Z, HEADING, BIAS, SLIP = range(6)
_NUMBERS = 6
_POSE = [X, Y, Z, HEADING]
_LEAST_M, _LEAST_RAD = 1e-5, 1e-6
"""By which odometry may err in a step in which nothing moves: a covariance needs some variance."""


@dataclass(frozen=True)
class Odometry:
    """What odometry counted in a step.

    Parameters
    ----------
    seconds
        the duration of the step.
    way_m
        metres ahead, to the left and up, in level axes of the robot amid its turn.
    turned_rad
        the turn to the left.
    """

    seconds: float
    way_m: tuple[float, float, float]
    turned_rad: float


def standing_at(pose: npt.ArrayLike, deviations: npt.ArrayLike, errors: ReckoningErrors) -> Estimate:
    """A robot at rest at a pose (4,) of x, y, z and heading that is known within `deviations` (4,)."""
    spread = [*np.asarray(deviations, dtype=np.float64), errors.gyro_bias_radps, errors.slip]
    return Estimate(np.array([*np.asarray(pose, dtype=np.float64), 0.0, 0.0]), np.diag(np.square(spread)))


def moved(
    estimate: Estimate, counted: Odometry, errors: ReckoningErrors, turning_radps: float | None = None
) -> Estimate:
    """The estimate a step later, by what odometry counted and the mean yaw rate by a gyro, None without one.

    The turn by odometry and that by the gyro are weighed by their variances. Their difference, whose error is not
    correlated with that of the weighed mean, corrects bias and slip.

    Raises
    ------
    ParameterError
        if the step takes no time.
    """
    require_seconds(counted.seconds)
    way = math.hypot(*counted.way_m)
    turn_spread = math.hypot(errors.turn_share * counted.turned_rad, errors.turn_per_m * way, _LEAST_RAD)
    weight = 0.0
    if turning_radps is not None:
        gyro_spread = max(errors.gyro_radps * counted.seconds, _LEAST_RAD)
        estimate = _by_difference(estimate, counted, turning_radps, math.hypot(turn_spread, gyro_spread))
        weight = turn_spread**2 / (turn_spread**2 + gyro_spread**2)
        turn_spread *= gyro_spread / math.hypot(turn_spread, gyro_spread)
    step = _Step(counted, 0.0 if turning_radps is None else turning_radps, weight)
    spread = np.zeros((_NUMBERS, _NUMBERS))
    spread[[X, Y, Z], [X, Y, Z]] = (errors.way_share * way) ** 2 + _LEAST_M**2
    spread[HEADING, HEADING] = turn_spread**2
    spread[BIAS, BIAS] = errors.gyro_walk**2 * counted.seconds if turning_radps is not None else 0.0
    return extended_prediction(estimate, step.taken, spread).with_angle(HEADING)


@dataclass(frozen=True)
class _Step:
    """The motion of one step; `weight` is that of the turn by the gyro."""

    counted: Odometry
    turning_radps: float
    weight: float

    def taken(self, state: Floats) -> tuple[Floats, Floats]:
        """The state (6,) after the step, and its derivative (6, 6)."""
        kept, dt, by_wheels = 1 - state[SLIP], self.counted.seconds, (1 - self.weight) * self.counted.turned_rad
        turn = by_wheels * kept + self.weight * dt * (self.turning_radps - state[BIAS])
        c, s = math.cos(state[HEADING] + turn / 2), math.sin(state[HEADING] + turn / 2)
        ahead, left, up = self.counted.way_m
        way = np.array([c * ahead - s * left, s * ahead + c * left, up])
        across = kept * np.array([-way[1], way[0], 0.0])
        after, derivative = state.copy(), np.eye(_NUMBERS)
        after[:3] += kept * way
        after[HEADING] += turn
        derivative[:3, HEADING] = across
        derivative[HEADING, [BIAS, SLIP]] = -self.weight * dt, -by_wheels
        derivative[:3, BIAS] = across * derivative[HEADING, BIAS] / 2
        derivative[:3, SLIP] = across * derivative[HEADING, SLIP] / 2 - way
        return after, derivative


def _by_difference(estimate: Estimate, counted: Odometry, turning_radps: float, spread: float) -> Estimate:
    """Correct bias and slip by how much more the gyro says that the robot turned than its odometry."""
    sensor = np.zeros((1, _NUMBERS))
    sensor[0, [BIAS, SLIP]] = counted.seconds, counted.turned_rad
    more = counted.seconds * turning_radps - counted.turned_rad
    return corrected(estimate, sensor, [more], [[spread**2]]).estimate


def by_pose(estimate: Estimate, pose: npt.ArrayLike, deviations: npt.ArrayLike) -> Correction:
    """Correct by a measured pose (4,) of x, y, z and heading, within `deviations` (4,)."""
    measured = np.array(pose, dtype=np.float64)
    measured[3] = estimate.mean[HEADING] + wrapped(measured[3] - estimate.mean[HEADING])
    return _linear(estimate, _POSE, measured, deviations)


def by_position(estimate: Estimate, position: npt.ArrayLike, deviations: npt.ArrayLike) -> Correction:
    """Correct by a measured position (3,), within `deviations` (3,)."""
    return _linear(estimate, [X, Y, Z], position, deviations)


def by_landmark(estimate: Estimate, landmark: npt.ArrayLike, seen: npt.ArrayLike, covariance: Floats) -> Correction:
    """Correct by a landmark at a known place (2,) of the map: [tcf-thesis] (2.7), solved for the robot.

    Parameters
    ----------
    seen, covariance
        where the robot sees it, (2,) metres ahead and to the left in its level axes, and (2, 2) of that.
    """
    place = np.asarray(landmark, dtype=np.float64)

    def sensor(state: Floats) -> tuple[Floats, Floats]:
        c, s = math.cos(state[HEADING]), math.sin(state[HEADING])
        into = np.array([[c, s], [-s, c]])
        ahead, left = expected = into @ (place - state[:2])
        derivative = np.zeros((2, _NUMBERS))
        derivative[:, :2], derivative[:, HEADING] = -into, (left, -ahead)
        return expected, derivative

    return extended_correction(estimate, sensor, seen, covariance).with_angle(HEADING)


def by_range_and_bearing(
    estimate: Estimate,
    landmark: npt.ArrayLike,
    range_m: float,
    bearing_rad: float,
    deviations: tuple[float, float],
) -> Correction:
    """`by_landmark` of a range and a bearing to the left of straight ahead, within `deviations` (m, rad)."""
    c, s = math.cos(bearing_rad), math.sin(bearing_rad)
    axes = np.array([[c, -s], [s, c]]) * (deviations[0], range_m * deviations[1])
    return by_landmark(estimate, landmark, [range_m * c, range_m * s], axes @ axes.T)


def _linear(estimate: Estimate, numbers: list[int], measured: npt.ArrayLike, deviations: npt.ArrayLike) -> Correction:
    spread = np.diag(np.square(np.asarray(deviations, dtype=np.float64)))
    return corrected(estimate, np.eye(_NUMBERS)[numbers], measured, spread).with_angle(HEADING)
