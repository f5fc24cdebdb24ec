"""The position of a drone from odometry, inertial data and position fixes: an extended Kalman filter.

[tcf-thesis], section 2.1.1: odometry and inertial unit give a continuous estimate, external fixes one that does not
drift. The attitude is the autopilot's: measurements are given in axes of the map.

The state is (7,): position in metres and velocity in m/s, both in the map frame; slip, the share of the counted
odometry that is not flown. As in `ground_fusion` the velocity is the one that odometry counts.
"""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from muster.perception.errors import AirErrors
from muster.perception.kalman import (
    Correction,
    Estimate,
    Floats,
    corrected,
    extended_prediction,
    predicted,
    require_seconds,
)

_NUMBERS = 7
POSITION, VELOCITY, SLIP = slice(0, 3), slice(3, 6), 6
_POSITION, _VELOCITY = np.eye(_NUMBERS)[POSITION], np.eye(_NUMBERS)[VELOCITY]


def hovering_at(position: npt.ArrayLike, deviation_m: float, errors: AirErrors) -> Estimate:
    """A drone at rest at a position (3,), each coordinate of which is known within a standard deviation."""
    spread = np.array([deviation_m] * 3 + [0.0] * 3 + [errors.odometry_slip])
    return Estimate(np.array([*np.asarray(position, dtype=np.float64), *[0.0] * 4]), np.diag(spread**2))


def moved(
    estimate: Estimate, dt: float, errors: AirErrors, acceleration_mps2: npt.ArrayLike = (0.0, 0.0, 0.0)
) -> Estimate:
    """The estimate `dt` seconds later, with the acceleration (3,) that was measured, gravity taken off.

    Raises
    ------
    ParameterError
        if `dt` is not above 0, or for another shape.
    """
    require_seconds(dt)
    effect = np.vstack([dt * dt / 2 * np.eye(3), dt * np.eye(3), np.zeros((1, 3))])
    process = errors.acceleration_mps2**2 * effect @ effect.T
    push = effect @ np.asarray(acceleration_mps2, dtype=np.float64)

    def motion(state: Floats) -> tuple[Floats, Floats]:
        after, derivative = _flown(state, dt)
        return after + push, derivative

    return extended_prediction(estimate, motion, process)


def moved_as_counted(
    estimate: Estimate,
    dt: float,
    velocity_mps: npt.ArrayLike,
    errors: AirErrors,
    acceleration_mps2: npt.ArrayLike = (0.0, 0.0, 0.0),
) -> Estimate:
    """The estimate `dt` seconds later, in which odometry counted a velocity (3,): the mean of that time.

    Parameters
    ----------
    acceleration_mps2
        (3,) the measured acceleration: the change of this mean from that of the interval before, a second.

    Raises
    ------
    ParameterError
        if `dt` is not above 0, or for another shape.
    """
    require_seconds(dt)
    change = np.diag([0.0] * 3 + [(errors.acceleration_mps2 * dt) ** 2] * 3 + [0.0])
    before = predicted(estimate, np.eye(_NUMBERS), change, dt * _VELOCITY.T, acceleration_mps2)
    before = by_odometry(before, velocity_mps, errors).estimate
    return extended_prediction(before, lambda state: _flown(state, dt), np.zeros((_NUMBERS, _NUMBERS)))


def by_odometry(estimate: Estimate, velocity_mps: npt.ArrayLike, errors: AirErrors) -> Correction:
    """Correct by odometry: a velocity (3,)."""
    return corrected(estimate, _VELOCITY, velocity_mps, errors.velocity_mps**2 * np.eye(3))


def by_position(estimate: Estimate, position: npt.ArrayLike, errors: AirErrors) -> Correction:
    """Correct by an external position fix (3,)."""
    return corrected(estimate, _POSITION, position, errors.position_m**2 * np.eye(3))


def _flown(state: Floats, dt: float) -> tuple[Floats, Floats]:
    """The state (7,) `dt` seconds later at even velocity, and its derivative (7, 7)."""
    kept, after, derivative = 1 - state[SLIP], state.copy(), np.eye(_NUMBERS)
    after[POSITION] += dt * kept * state[VELOCITY]
    derivative[POSITION, VELOCITY] = dt * kept * np.eye(3)
    derivative[POSITION, SLIP] = -dt * state[VELOCITY]
    return after, derivative
