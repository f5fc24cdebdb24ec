"""The heading of a robot that moves in any direction, from gyro and reported headings: a linear Kalman filter.

The state is (2,): heading in radians of the map frame, kept in [-pi, pi), and bias of the gyro in rad/s. The state of
`ground_fusion`, for robots that face their way, has both among others.
"""

from __future__ import annotations

import numpy as np

from muster.motion.frames import wrapped
from muster.perception.errors import AirErrors
from muster.perception.kalman import Correction, Estimate, corrected, predicted, require_seconds

HEADING, BIAS = range(2)


def turned_to(heading_rad: float, deviation_rad: float, errors: AirErrors) -> Estimate:
    """A robot whose heading is known within a standard deviation."""
    covariance = np.diag([deviation_rad**2, errors.gyro_bias_radps**2])
    return Estimate(np.array([heading_rad, 0.0]), covariance).with_angle(HEADING)


def turned(estimate: Estimate, dt: float, yaw_rate_radps: float, errors: AirErrors) -> Estimate:
    """The estimate `dt` seconds later, in which the gyro gave a mean yaw rate.

    Raises
    ------
    ParameterError
        if `dt` is not above 0.
    """
    require_seconds(dt)
    transition = np.array([[1.0, -dt], [0.0, 1.0]])
    process = np.diag([(errors.gyro_radps * dt) ** 2, errors.gyro_walk**2 * dt])
    return predicted(estimate, transition, process, [[dt], [0.0]], [yaw_rate_radps]).with_angle(HEADING)


def by_heading(estimate: Estimate, heading_rad: float, errors: AirErrors) -> Correction:
    """Correct by an external heading, in radians from east."""
    near = estimate.mean[HEADING] + wrapped(heading_rad - estimate.mean[HEADING])
    found = corrected(estimate, np.eye(2)[[HEADING]], [near], [[errors.heading_rad**2]])
    return found.with_angle(HEADING)
