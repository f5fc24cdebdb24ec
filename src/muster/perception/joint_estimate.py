"""One estimate of a robot's pose and of the marks that it has seen, with the covariance of all of them together.

Marks that are seen from a pose share its error: without the covariance between pose and marks, sightings of one mark
would count as independent of each other, and the estimate would become surer than it is.

The errors of heading and places are right-invariant ([barrau2017]): the truth is the estimate turned about the map's
origin by the error of the heading, and shifted. In these coordinates the distribution of a robot that has driven with
an uncertain heading is nearly Gaussian, although its places lie along an arc; and what no sensor observes, a turn or
a shift of pose and marks together, stays unobserved, whatever the estimate is. An extended Kalman filter of
coordinates of the map loses both, and becomes too sure.

The state is (9 + 2 n,): x, y, z in metres and heading in radians of the map frame, the heading in [-pi, pi); bias of
the gyro in rad/s; slip and skid, the shares of the counted way, and of the counted turn, that are not travelled; by how
much roll and pitch are measured too large in the last picture, which all that is seen in it shares; x and y of each of
n marks.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from muster.motion.frames import wrapped
from muster.perception.kalman import Floats, gain_of, is_expected

X, Y, Z, HEADING, BIAS, SLIP, SKID, ROLL, PITCH = range(9)
OWN = 9
"""How many numbers of the state come before those of the marks."""
_POSE = [X, Y, Z, HEADING]
_STRAIGHT = 1e-4
"""Radians below which a series stands for sin(a) / a."""


@dataclass(frozen=True, eq=False)
class JointEstimate:
    """A robot's pose and the marks that it has seen.

    Parameters
    ----------
    mean
        (9 + 2 n,) the state.
    errors
        (9 + 2 n, 9 + 2 n) covariance of the errors, right-invariant where they are of places and heading.
    """

    mean: Floats
    errors: Floats

    @property
    def marks(self) -> Floats:
        """Places of the marks, (n, 2) metres."""
        return self.mean[OWN:].reshape(-1, 2)

    @property
    def covariance(self) -> Floats:
        """Covariance of the state itself, to first order, (9 + 2 n, 9 + 2 n)."""
        by_error = np.eye(len(self.mean))
        by_error[:, HEADING] += turned_places(self.mean)
        return np.asarray(by_error @ self.errors @ by_error.T)

    @property
    def pose_covariance(self) -> Floats:
        """Covariance of x, y, z and heading, to first order, (4, 4)."""
        by_error = np.eye(4)
        by_error[:2, 3] = -self.mean[Y], self.mean[X]
        return np.asarray(by_error @ self.errors[:4, :4] @ by_error.T)

    @property
    def deviations(self) -> Floats:
        """Standard deviations of x, y, z and heading, (4,)."""
        return np.sqrt(np.maximum(np.diagonal(self.pose_covariance), 0.0))

    def place_covariance(self, number: int | None = None) -> Floats:
        """Return the mean square error of a mark's place, of the robot's place for None: (2, 2) m^2 of the map.

        By sigma points, so that it holds for places that lie along an arc.
        """
        first = X if number is None else OWN + 2 * number
        at = [HEADING, first, first + 1]
        spread = np.linalg.cholesky(self.errors[np.ix_(at, at)] + 1e-18 * np.eye(3))
        place = self.mean[first : first + 2]
        off = []
        for shift in math.sqrt(3) * np.concatenate([spread.T, -spread.T]):
            turn, stretch = _exponential(shift[0])
            off.append(turn @ place + stretch @ shift[1:] - place)
        return np.asarray(np.array(off).T @ np.array(off) / 6)

    def seen_covariance(self, number: int) -> Floats:
        """Return the covariance (2, 2), m^2, of a mark's place from the robot: without what pose and mark share."""
        first = OWN + 2 * number
        mark, own = slice(first, first + 2), slice(X, Y + 1)
        across = self.errors[mark, own]
        return self.errors[mark, mark] - across - across.T + self.errors[own, own]

    def error_of(self, pose: npt.ArrayLike) -> tuple[Floats, Floats]:
        """Return the right-invariant error (3,) of heading, x, y against the true x, y, heading; its covariance."""
        x, y, heading = np.asarray(pose, dtype=np.float64)
        turned = float(wrapped(heading - self.mean[HEADING]))
        turn, stretch = _exponential(turned)
        shift = np.linalg.solve(stretch, np.array([x, y]) - turn @ self.mean[:2])
        at = [HEADING, X, Y]
        return np.array([turned, *shift]), self.errors[np.ix_(at, at)]

    def shifted(self, errors: Floats) -> Floats:
        """Return the state (9 + 2 n,) that differs from the mean by errors (9 + 2 n,)."""
        turn, stretch = _exponential(float(errors[HEADING]))
        state = self.mean + errors
        state[:2] = turn @ self.mean[:2] + stretch @ errors[:2]
        state[HEADING] = wrapped(state[HEADING])
        state[OWN:] = (self.marks @ turn.T + errors[OWN:].reshape(-1, 2) @ stretch.T).ravel()
        return state

    def with_new_picture(self, tilt_rad: float) -> JointEstimate:
        """Return the estimate with errors of roll and pitch that are new: within `tilt_rad`, independent of all."""
        mean, errors, tilt = self.mean.copy(), self.errors.copy(), [ROLL, PITCH]
        mean[tilt] = 0.0
        errors[tilt, :] = errors[:, tilt] = 0.0
        errors[tilt, tilt] = tilt_rad**2
        return JointEstimate(mean, errors)

    def with_pose(self, pose: npt.ArrayLike, deviations: npt.ArrayLike) -> JointEstimate:
        """Return the estimate with a pose (4,) that was measured apart from everything, within deviations (4,)."""
        covariance, mean = self.covariance, self.mean.copy()
        covariance[_POSE, :] = covariance[:, _POSE] = 0.0
        covariance[_POSE, _POSE] = np.square(np.asarray(deviations, dtype=np.float64))
        mean[_POSE] = pose
        by_state = np.eye(len(mean))
        by_state[:, HEADING] -= turned_places(mean)
        return JointEstimate(mean, by_state @ covariance @ by_state.T)


@dataclass(frozen=True, eq=False)
class Fix:
    """What a measurement changed.

    Parameters
    ----------
    estimate
        with the measurement.
    innovation, innovation_covariance
        (m,) measured less expected, and (m, m) of that.
    """

    estimate: JointEstimate
    innovation: Floats
    innovation_covariance: Floats

    @property
    def nis(self) -> float:
        """The normalised innovation squared: chi-square of m degrees for a consistent filter."""
        return float(self.innovation @ np.linalg.solve(self.innovation_covariance, self.innovation))

    def gated(self, before: JointEstimate) -> JointEstimate:
        """Return the new estimate; the one before where the innovation is larger than chance makes it."""
        return self.estimate if is_expected(self.nis, len(self.innovation)) else before


def fixed(estimate: JointEstimate, sensor: Floats, innovation: Floats, uncertainty: Floats) -> Fix:
    """Correct an estimate by a measurement.

    Parameters
    ----------
    sensor
        (m, 9 + 2 n) derivative of what would be measured by the errors.
    innovation, uncertainty
        (m,) measured less expected, and (m, m) the covariance of the measurement.

    Raises
    ------
    ParameterError
        if the measurement has no variance where the state leaves none.
    """
    across = estimate.errors @ sensor.T
    spread = sensor @ across + uncertainty
    gain = gain_of(across.T, spread, uncertainty)
    half = gain @ across.T
    spread_after = estimate.errors - half - half.T + gain @ spread @ gain.T  # Joseph's form, multiplied out
    spread_after = (spread_after + spread_after.T) / 2  # or rounding grows from one correction to the next
    return Fix(JointEstimate(estimate.shifted(gain @ innovation), spread_after), innovation, spread)


def turned_places(state: Floats) -> Floats:
    """Return by how much a turn about the map's origin, a radian of it, moves the state: (9 + 2 n,)."""
    moved = np.zeros(len(state))
    moved[[X, Y]] = -state[Y], state[X]
    moved[OWN::2], moved[OWN + 1 :: 2] = -state[OWN + 1 :: 2], state[OWN::2]
    return moved


def _exponential(angle: float) -> tuple[Floats, Floats]:
    """The turn (2, 2) by an angle, and the matrix (2, 2) of the shift in the exponential map of the plane."""
    c, s = math.cos(angle), math.sin(angle)
    along, across = (s / angle, (1 - c) / angle) if abs(angle) > _STRAIGHT else (1 - angle**2 / 6, angle / 2)
    return np.array([[c, -s], [s, c]]), np.array([[along, -across], [across, along]])
