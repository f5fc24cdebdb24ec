"""The pose of a robot in the plane from odometry, inertial data and fixes: an extended Kalman filter.

[tcf-thesis], section 2.1.1: a filter that fuses odometry and inertial unit, and the result with external fixes:
positions, as of GPS or motion capture, and artificial landmarks (tags, cylinders) at known places.

The state is (7,): x, y in metres and heading in radians of the map frame; speed ahead in m/s, as
wheels count it; yaw rate in rad/s; bias of the gyro in rad/s; slip, the share of the counted way that is not
travelled. Its heading is kept in [-pi, pi). Speed is counted, not true, so that odometry is linear in the state: as a
product of both it would teach the filter a slip out of noise alone.
"""

from __future__ import annotations

import math
from collections.abc import Callable

import numpy as np
import numpy.typing as npt

from muster.mission.errors import ParameterError
from muster.motion.frames import wrapped
from muster.perception.errors import GroundErrors
from muster.perception.kalman import (
    Correction,
    Estimate,
    Floats,
    corrected,
    extended_correction,
    extended_prediction,
    predicted,
    require_seconds,
)

X, Y, HEADING, SPEED, YAW_RATE, BIAS, SLIP = range(7)
_NUMBERS = 7
_STRAIGHT = 1e-4
"""Half a turn in a step, in radians, below which a series stands for sin(h) / h and its derivative."""


def standing_at(pose: npt.ArrayLike, deviations: npt.ArrayLike, errors: GroundErrors) -> Estimate:
    """A robot at rest at a pose (3,) that is known within `deviations` (3,)."""
    spread = [*np.asarray(deviations, dtype=np.float64), 0.0, 0.0, errors.gyro_bias_radps, errors.odometry_slip]
    return Estimate(np.array([*np.asarray(pose, dtype=np.float64), *[0.0] * 4]), np.diag(np.square(spread)))


def moved(estimate: Estimate, dt: float, errors: GroundErrors, acceleration_mps2: float = 0.0) -> Estimate:
    """The estimate `dt` seconds later: an arc at even speed and yaw rate, and the measured acceleration ahead.

    Raises
    ------
    ParameterError
        if `dt` is not above 0.
    """
    require_seconds(dt)
    heading = estimate.mean[HEADING]
    pushes = np.zeros((_NUMBERS, 2))  # of an acceleration ahead, of one of the turn
    pushes[[X, Y, SPEED], 0] = dt * dt / 2 * math.cos(heading), dt * dt / 2 * math.sin(heading), dt
    pushes[[HEADING, YAW_RATE], 1] = dt * dt / 2, dt
    spread = pushes @ np.diag([errors.acceleration_mps2**2, errors.yaw_acceleration_radps2**2]) @ pushes.T
    spread[BIAS, BIAS] = errors.gyro_walk**2 * dt

    def motion(state: Floats) -> tuple[Floats, Floats]:
        after, derivative = arc(state, dt)
        return after + pushes[:, 0] * acceleration_mps2, derivative

    return extended_prediction(estimate, motion, spread).with_angle(HEADING)


def moved_as_counted(
    estimate: Estimate,
    dt: float,
    metres: float,
    heading_rad: float,
    errors: GroundErrors,
    turning_radps: float | None = None,
) -> Estimate:
    """The estimate `dt` seconds later, by the odometer's count in between and the measured heading at the end.

    For rare reports: odometry makes the prediction itself, as in the thesis. Speed and yaw rate of the state are then
    means of the interval. A robot that turned before or after it drove is off that arc by up to half the way times the
    turn; half of this is taken for a standard deviation. `turning_radps` is the mean yaw rate by the gyro; None where
    there is none.

    Raises
    ------
    ParameterError
        if `dt` is not above 0.
    """
    require_seconds(dt)
    change = np.zeros((_NUMBERS, _NUMBERS))
    change[SPEED, SPEED] = (errors.acceleration_mps2 * dt) ** 2
    change[YAW_RATE, YAW_RATE] = (errors.yaw_acceleration_radps2 * dt) ** 2
    change[BIAS, BIAS] = errors.gyro_walk**2 * dt
    before = predicted(estimate, np.eye(_NUMBERS), change)
    spread = math.hypot(errors.odometry_share * metres, errors.odometry_mps * dt) / dt
    near = float(before.mean[HEADING] + dt * before.mean[YAW_RATE])
    if turning_radps is not None:
        near = float(before.mean[HEADING] + dt * (turning_radps - before.mean[BIAS]))
    facing = near + float(wrapped(heading_rad - near))
    sensor = np.zeros((2 if turning_radps is None else 3, _NUMBERS))
    sensor[0, SPEED], sensor[1, [HEADING, YAW_RATE]] = 1.0, (1.0, dt)
    measured, deviations = [metres / dt, facing], [spread, errors.heading_rad]
    if turning_radps is not None:
        sensor[2, [YAW_RATE, BIAS]] = 1.0
        measured, deviations = [*measured, turning_radps], [*deviations, errors.gyro_radps]
    before = _linear(before, sensor, measured, deviations).estimate
    bulge = metres * abs(before.mean[YAW_RATE]) * dt / 4
    slack = np.diag([bulge**2, bulge**2] + [0.0] * (_NUMBERS - 2))
    return extended_prediction(before, lambda state: arc(state, dt), slack).with_angle(HEADING)


def arc(state: Floats, dt: float) -> tuple[Floats, Floats]:
    """The state (7,) `dt` seconds later at even speed and yaw rate, and its derivative (7, 7)."""
    heading, half, kept = state[HEADING], state[YAW_RATE] * dt / 2, 1 - state[SLIP]
    way = dt * state[SPEED] * kept
    chord, slope = _sinc(half)
    ahead = np.array([math.cos(heading + half), math.sin(heading + half)])
    left = np.array([-ahead[1], ahead[0]])
    after = state.copy()
    after[:2] += way * chord * ahead
    after[HEADING] += 2 * half
    derivative = np.eye(_NUMBERS)
    derivative[:2, HEADING] = way * chord * left
    derivative[:2, SPEED] = dt * kept * chord * ahead
    derivative[:2, SLIP] = -dt * state[SPEED] * chord * ahead
    derivative[:2, YAW_RATE] = way * (slope * ahead + chord * left) * dt / 2
    derivative[HEADING, YAW_RATE] = dt
    return after, derivative


def by_odometry(estimate: Estimate, speed_mps: float, yaw_rate_radps: float, errors: GroundErrors) -> Correction:
    """Correct by wheel odometry: speed ahead and yaw rate."""
    spread = [math.hypot(errors.odometry_share * speed_mps, errors.odometry_mps), errors.odometry_radps]
    return _linear(estimate, np.eye(_NUMBERS)[[SPEED, YAW_RATE]], [speed_mps, yaw_rate_radps], spread)


def by_gyro(estimate: Estimate, yaw_rate_radps: float, errors: GroundErrors) -> Correction:
    """Correct by the gyro, which measures the sum of yaw rate and bias."""
    sensor = np.zeros((1, _NUMBERS))
    sensor[0, [YAW_RATE, BIAS]] = 1.0
    return _linear(estimate, sensor, [yaw_rate_radps], [errors.gyro_radps])


def by_position(estimate: Estimate, position: npt.ArrayLike, errors: GroundErrors) -> Correction:
    """Correct by an external position fix (2,) in the map frame."""
    return _linear(estimate, np.eye(_NUMBERS)[[X, Y]], position, [errors.position_m] * 2)


def by_heading(estimate: Estimate, heading_rad: float, errors: GroundErrors) -> Correction:
    """Correct by an external heading, in radians from east."""
    near = estimate.mean[HEADING] + wrapped(heading_rad - estimate.mean[HEADING])
    return _linear(estimate, np.eye(_NUMBERS)[[HEADING]], [near], [errors.heading_rad])


def by_landmark(
    estimate: Estimate, landmark: npt.ArrayLike, range_m: float, bearing_rad: float, errors: GroundErrors
) -> Correction:
    """Correct by a landmark at a known place (2,) of the map: range, and bearing from straight ahead to the left.

    Raises
    ------
    ParameterError
        if the estimated position is that of the landmark: it has no bearing then.
    """
    sensor = range_and_bearing_to(
        np.asarray(landmark, dtype=np.float64), "landmark: {}; expected one that is not where the robot is"
    )
    uncertainty = np.diag([errors.range_m**2, errors.bearing_rad**2])
    seen = [range_m, bearing_rad]
    return extended_correction(estimate, sensor, seen, uncertainty, range_and_bearing_off).with_angle(HEADING)


def range_and_bearing_to(place: Floats, refusal: str) -> Callable[[Floats], tuple[Floats, Floats]]:
    """Return the sensor of range and bearing to a place: of a state, the measurement expected and its derivative.

    The sensor raises ParameterError with the refusal, filled with the place, where the robot is at the place itself.
    """

    def sensor(state: Floats) -> tuple[Floats, Floats]:
        east, north = place - state[:2]
        away = math.hypot(east, north)
        if away == 0:
            raise ParameterError(refusal.format(place.tolist()))
        derivative = np.zeros((2, len(state)))
        derivative[0, :2] = -east / away, -north / away
        derivative[1, :2] = north / away**2, -east / away**2
        derivative[1, HEADING] = -1.0
        return np.array([away, math.atan2(north, east) - state[HEADING]]), derivative

    return sensor


def range_and_bearing_off(seen: Floats, expected: Floats) -> Floats:
    """Return by how much a range and a bearing differ from those expected."""
    return np.array([seen[0] - expected[0], wrapped(seen[1] - expected[1])])


def _sinc(half: float) -> tuple[float, float]:
    """Sin(h) / h, and its derivative."""
    if abs(half) < _STRAIGHT:
        return 1 - half * half / 6, -half / 3
    chord = math.sin(half) / half
    return chord, (math.cos(half) - chord) / half


def _linear(estimate: Estimate, sensor: Floats, measured: npt.ArrayLike, deviations: list[float]) -> Correction:
    return corrected(estimate, sensor, measured, np.diag(np.square(deviations))).with_angle(HEADING)
