"""The pose of a robot by dead reckoning, and what corrects it: an invariant Kalman filter for robots of all kinds.

[tcf-thesis], section 2.1.1: odometry and inertial unit are integrated, and landmarks at known places, motion capture
or satellites keep the result from drifting. What odometry counts is in axes of the robot, so that an error of the
heading leads the position astray; no heading is measured but by a gyro, as a rate, and by what corrects the pose.
Marks at unknown places become part of the estimate (`joint_estimate`), and correct the pose when they are seen again.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, field

import numpy as np
import numpy.typing as npt

from muster.motion.frames import wrapped
from muster.perception.errors import ReckoningErrors
from muster.perception.joint_estimate import (
    BIAS,
    HEADING,
    OWN,
    PITCH,
    ROLL,
    SKID,
    SLIP,
    Fix,
    JointEstimate,
    X,
    Y,
    Z,
    fixed,
    turned_places,
)
from muster.perception.kalman import Floats, require_seconds

_LEAST_M, _LEAST_RAD = 1e-5, 1e-6
"""By which odometry may err in a step in which nothing moves: a covariance needs some variance."""
_QUARTER = np.array([[0.0, -1.0], [1.0, 0.0]])


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


def standing_at(pose: npt.ArrayLike, deviations: npt.ArrayLike, errors: ReckoningErrors) -> JointEstimate:
    """A robot at rest at a pose (4,) of x, y, z and heading that is known within `deviations` (4,)."""
    spread = [*np.asarray(deviations, dtype=np.float64), errors.gyro_bias_radps, errors.slip, errors.skid, 0.0, 0.0]
    nowhere = JointEstimate(np.zeros(OWN), np.diag(np.square(spread)))
    return nowhere.with_pose(pose, deviations)


def moved(
    estimate: JointEstimate, counted: Odometry, errors: ReckoningErrors, turning_radps: float | None = None
) -> JointEstimate:
    """The estimate a step later, by what odometry counted and the mean yaw rate by a gyro, None without one.

    The turn by odometry and that by the gyro are weighed by their variances. Their difference, whose error is not
    correlated with that of the weighed mean, corrects bias and skid.

    Raises
    ------
    ParameterError
        if the step takes no time.
    """
    require_seconds(counted.seconds)
    way = math.hypot(*counted.way_m)
    by_wheels = errors.turn_kept * counted.turned_rad
    turn_spread = math.hypot(errors.turn_share * counted.turned_rad, errors.turn_per_m * way, _LEAST_RAD)
    weight, by_gyro = 0.0, 0.0
    if turning_radps is not None:
        gyro_spread = max(errors.gyro_radps * counted.seconds, _LEAST_RAD)
        by_gyro = counted.seconds * turning_radps
        estimate = _by_difference(estimate, counted.seconds, by_wheels, by_gyro, math.hypot(turn_spread, gyro_spread))
        weight = turn_spread**2 / (turn_spread**2 + gyro_spread**2)
        turn_spread *= gyro_spread / math.hypot(turn_spread, gyro_spread)
    kept = 1 - estimate.mean[SLIP]
    by_wheels *= 1 - weight
    turn = by_wheels * (1 - estimate.mean[SKID]) + weight * (by_gyro - counted.seconds * estimate.mean[BIAS])
    whole = errors.way_kept * _in_map(counted.way_m, float(estimate.mean[HEADING] + turn / 2))
    mean = estimate.mean.copy()
    mean[:3] += kept * whole
    mean[HEADING] = wrapped(mean[HEADING] + turn)
    by_turn = _by_turn(estimate.mean, kept * whole)
    along = np.zeros(len(mean))
    along[:3] = whole
    # The derivative of the errors after the step by those of bias, slip and skid.
    by_drift = np.column_stack([-weight * counted.seconds * by_turn, -along, -by_wheels * by_turn])
    spread = _carried(estimate.errors, by_drift)
    spread += np.outer(turn_spread * by_turn, turn_spread * by_turn)
    spread += errors.way_share**2 * np.outer(along, along)
    spread[[X, Y, Z], [X, Y, Z]] += (errors.aside_share * way) ** 2 + _LEAST_M**2
    if turning_radps is not None:
        spread[BIAS, BIAS] += errors.gyro_walk**2 * counted.seconds
    return JointEstimate(mean, spread)


def _in_map(way_m: tuple[float, float, float], heading: float) -> Floats:
    c, s = math.cos(heading), math.sin(heading)
    ahead, left, up = way_m
    return np.array([c * ahead - s * left, s * ahead + c * left, up])


def _by_turn(state: Floats, way: Floats) -> Floats:
    """The derivative of the errors after a step by the error of its turn: what is in the map stays where it is."""
    amid = state.copy()
    amid[:2] += way[:2] / 2
    by_turn = -turned_places(amid)
    by_turn[HEADING] = 1.0
    return by_turn


def _carried(errors: Floats, by_drift: Floats) -> Floats:
    """F P F^T, where F is 1 but for the columns of bias, slip and skid."""
    drift = [BIAS, SLIP, SKID]
    across = errors[:, drift] @ by_drift.T
    return np.asarray(errors + across + across.T + by_drift @ errors[np.ix_(drift, drift)] @ by_drift.T)


def _by_difference(
    estimate: JointEstimate, seconds: float, by_wheels: float, by_gyro: float, spread: float
) -> JointEstimate:
    """Correct bias and skid by how much more the gyro says that the robot turned than its odometry."""
    sensor = np.zeros((1, len(estimate.mean)))
    sensor[0, [BIAS, SKID]] = seconds, -by_wheels
    more = by_gyro - by_wheels - sensor @ estimate.mean
    return fixed(estimate, sensor, more, np.array([[spread**2]])).estimate


def by_pose(estimate: JointEstimate, pose: npt.ArrayLike, deviations: npt.ArrayLike) -> Fix:
    """Correct by a measured pose (4,) of x, y, z and heading, within `deviations` (4,)."""
    apart = np.asarray(pose, dtype=np.float64) - estimate.mean[:4]
    apart[HEADING] = wrapped(apart[HEADING])
    return _by_coordinates(estimate, apart, deviations)


def by_position(estimate: JointEstimate, position: npt.ArrayLike, deviations: npt.ArrayLike) -> Fix:
    """Correct by a measured position (3,), within `deviations` (3,)."""
    return _by_coordinates(estimate, np.asarray(position, dtype=np.float64) - estimate.mean[:3], deviations)


def _by_coordinates(estimate: JointEstimate, apart: Floats, deviations: npt.ArrayLike) -> Fix:
    sensor = np.eye(len(estimate.mean))[: len(apart)]
    sensor[:2, HEADING] = -estimate.mean[Y], estimate.mean[X]
    return fixed(estimate, sensor, apart, np.diag(np.square(np.asarray(deviations, dtype=np.float64))))


@dataclass(frozen=True, eq=False)
class Seen:
    """Where a robot sees something on the ground.

    Parameters
    ----------
    place, covariance
        (2,) metres ahead and to the left in its level axes, and (2, 2) of that.
    by_height
        (2,) by how much that place lies farther for each metre by which the robot is higher than it takes itself to be.
    by_tilt
        (2, 2) by how much that place moves for each radian of roll and of pitch that is measured too much.
    """

    place: Floats
    covariance: Floats
    by_height: Floats = field(default_factory=lambda: np.zeros(2))
    by_tilt: Floats = field(default_factory=lambda: np.zeros((2, 2)))


def by_landmark(estimate: JointEstimate, landmark: npt.ArrayLike, seen: Seen) -> Fix:
    """Correct by a landmark at a known place (2,) of the map: [tcf-thesis] (2.7), solved for the robot."""
    place = np.asarray(landmark, dtype=np.float64)
    sensor, innovation = _sensor(estimate, place, seen)
    sensor[:, HEADING] = -_into(estimate) @ _QUARTER @ place
    return fixed(estimate, sensor, innovation, seen.covariance)


def by_mark(estimate: JointEstimate, number: int, seen: Seen) -> Fix:
    """Correct pose and marks by seeing a mark of the estimate again.

    Where a mark is from the robot is linear in the errors but for the product of the heading's error and the shift
    between both; mean and covariance of that count as those of a Gaussian. (To take the derivative again at the
    corrected state would give information about the heading that nobody has.)
    """
    mark, into = slice(OWN + 2 * number, OWN + 2 * number + 2), _into(estimate)
    sensor, innovation = _sensor(estimate, estimate.marks[number], seen)
    sensor[:, mark] = into
    turned = into @ _QUARTER / 2
    along = turned @ (estimate.errors[mark, HEADING] - estimate.errors[:2, HEADING])
    variance, apart = estimate.errors[HEADING, HEADING], estimate.seen_covariance(number)
    product = variance * turned @ apart @ turned.T + np.outer(along, along)
    return fixed(estimate, sensor, innovation + along, seen.covariance + product)


def with_mark(estimate: JointEstimate, seen: Seen) -> JointEstimate:
    """The estimate with one more mark, which is where it is seen from the estimated pose."""
    out, size = _into(estimate).T, len(estimate.mean)
    by_errors = np.vstack([np.eye(size), np.zeros((2, size))])
    by_errors[size:, [X, Y]] = np.eye(2)
    by_errors[size:, Z] = out @ seen.by_height
    by_errors[size:, [ROLL, PITCH]] = -out @ seen.by_tilt
    errors = by_errors @ estimate.errors @ by_errors.T
    errors[size:, size:] += out @ seen.covariance @ out.T
    place = estimate.mean[:2] + out @ (seen.place - seen.by_tilt @ estimate.mean[[ROLL, PITCH]])
    return JointEstimate(np.concatenate([estimate.mean, place]), errors)


def by_range_and_bearing(
    estimate: JointEstimate,
    landmark: npt.ArrayLike,
    range_m: float,
    bearing_rad: float,
    deviations: tuple[float, float],
) -> Fix:
    """`by_landmark` of a range and a bearing to the left of straight ahead, within `deviations` (m, rad)."""
    c, s = math.cos(bearing_rad), math.sin(bearing_rad)
    axes = np.array([[c, -s], [s, c]]) * (deviations[0], range_m * deviations[1])
    return by_landmark(estimate, landmark, Seen(np.array([range_m * c, range_m * s]), axes @ axes.T))


def _sensor(estimate: JointEstimate, place: Floats, seen: Seen) -> tuple[Floats, Floats]:
    """The derivative (2, 9 + 2 n) by the errors of the robot's own state, and the innovation (2,)."""
    into = _into(estimate)
    sensor = np.zeros((2, len(estimate.mean)))
    sensor[:, [X, Y]], sensor[:, Z], sensor[:, [ROLL, PITCH]] = -into, -seen.by_height, seen.by_tilt
    expected = into @ (place - estimate.mean[:2]) + seen.by_tilt @ estimate.mean[[ROLL, PITCH]]
    return sensor, seen.place - expected


def _into(estimate: JointEstimate) -> Floats:
    """The turn (2, 2) from the map's axes into the robot's."""
    c, s = math.cos(estimate.mean[HEADING]), math.sin(estimate.mean[HEADING])
    return np.array([[c, s], [-s, c]])
