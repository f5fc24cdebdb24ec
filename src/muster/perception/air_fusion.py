"""Where a drone is, from odometry, inertial data and position fixes: a linear Kalman filter.

TCF thesis, section 2.1.1: odometry and inertial unit give a continuous estimate, fixes from outside one that does not
drift. The attitude is the autopilot's: what is measured comes here in axes of the map.

The state is (6,): position in metres and velocity in m/s, both in the map frame.
"""

from __future__ import annotations

import math

import numpy as np
import numpy.typing as npt

from muster.mission.errors import ParameterError
from muster.perception.errors import AirErrors
from muster.perception.kalman import Correction, Estimate, corrected, predicted

_POSITION = np.eye(6)[:3]
_VELOCITY = np.eye(6)[3:]


def hovering_at(position: npt.ArrayLike, deviation_m: float) -> Estimate:
    """A drone at rest at a position (3,), each coordinate of which is known within a standard deviation."""
    spread = np.array([deviation_m] * 3 + [0.0] * 3)
    return Estimate(np.array([*np.asarray(position, dtype=np.float64), 0.0, 0.0, 0.0]), np.diag(spread**2))


def moved(
    estimate: Estimate, dt: float, errors: AirErrors, acceleration_mps2: npt.ArrayLike = (0.0, 0.0, 0.0)
) -> Estimate:
    """The estimate `dt` seconds later, with the acceleration (3,) that was measured, gravity taken off.

    Raises
    ------
    ParameterError
        if `dt` is not above 0, or for another shape.
    """
    if not 0 < dt < math.inf:
        raise ParameterError(f"dt: {dt}; expected seconds above 0")
    transition = np.eye(6)
    transition[:3, 3:] = dt * np.eye(3)
    effect = np.vstack([dt * dt / 2 * np.eye(3), dt * np.eye(3)])
    process = errors.acceleration_mps2**2 * effect @ effect.T
    return predicted(estimate, transition, process, effect, acceleration_mps2)


def by_odometry(estimate: Estimate, velocity_mps: npt.ArrayLike, errors: AirErrors) -> Correction:
    """What odometry says: a velocity (3,)."""
    return corrected(estimate, _VELOCITY, velocity_mps, errors.velocity_mps**2 * np.eye(3))


def by_position(estimate: Estimate, position: npt.ArrayLike, errors: AirErrors) -> Correction:
    """A fix (3,) from outside."""
    return corrected(estimate, _POSITION, position, errors.position_m**2 * np.eye(3))
