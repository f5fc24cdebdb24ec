"""The Kalman filter and the extended one ([tcf-thesis], section 2.1, (2.1)-(2.5)).

The thesis calls the process covariance V, the gain R and the residual v, and names neither the covariance of what is
measured (W here) nor the gain's formula, R = P H^T S^-1 with S = H P H^T + W. Its (2.4) holds for this gain alone and
loses symmetry by rounding; Joseph's form, which is the same for this gain and never loses it, is used.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np
import numpy.typing as npt

from muster.mission.errors import ParameterError
from muster.motion.frames import wrapped

Floats = npt.NDArray[np.float64]

Motion = Callable[[Floats], tuple[Floats, Floats]]
"""A state (n,) to the one that follows, (n,), and the derivative of that by the state, (n, n)."""

Sensor = Callable[[Floats], tuple[Floats, Floats]]
"""A state (n,) to what would be measured in it, (m,), and the derivative of that by the state, (m, n)."""

GATES = {1: 10.828, 2: 13.816, 3: 16.266}
"""By degrees of freedom, what chi-square exceeds in one of a thousand draws."""

_SAME = 1e-9
"""By how much, relative to its largest entry, a covariance may miss symmetry and an eigenvalue 0."""


@dataclass(frozen=True, eq=False)
class Estimate:
    """A state that is not known exactly: X and P of the thesis. Both arrays are copied and cannot be written.

    Parameters
    ----------
    mean
        (n,).
    covariance
        (n, n), symmetric, no eigenvalue below 0.

    Raises
    ------
    ParameterError
        for other shapes, numbers that are not finite, or what is no covariance.
    """

    mean: Floats
    covariance: Floats

    def __post_init__(self) -> None:
        mean = _array("mean", self.mean, (None,))
        covariance = require_covariance("covariance", self.covariance, len(mean))
        for name, array in (("mean", mean), ("covariance", covariance)):
            array.setflags(write=False)
            object.__setattr__(self, name, array)

    @property
    def deviations(self) -> Floats:
        """Standard deviations (n,)."""
        return np.sqrt(np.maximum(np.diagonal(self.covariance), 0.0))

    def around(self, mean: npt.ArrayLike) -> Estimate:
        """The same covariance around another mean (n,)."""
        return _made(_array("mean", mean, (len(self.mean),)), self.covariance)

    def with_angle(self, k: int) -> Estimate:
        """Return the estimate with number `k` of the state, an angle in radians, in [-pi, pi)."""
        mean = self.mean.copy()
        mean[k] = wrapped(mean[k])
        return self.around(mean)


@dataclass(frozen=True, eq=False)
class Correction:
    """What a measurement changed.

    Parameters
    ----------
    estimate
        the state, the measurement taken in.
    innovation
        (m,): v of (2.5), measured less expected.
    innovation_covariance
        (m, m): S.
    gain
        (n, m): R of (2.3).
    """

    estimate: Estimate
    innovation: Floats
    innovation_covariance: Floats
    gain: Floats

    def with_angle(self, k: int) -> Correction:
        """Return the correction with the estimate's `with_angle`."""
        return replace(self, estimate=self.estimate.with_angle(k))

    @property
    def nis(self) -> float:
        """The normalised innovation squared, v^T S^-1 v: chi-square of m degrees for a consistent filter."""
        return float(self.innovation @ np.linalg.solve(self.innovation_covariance, self.innovation))


def predicted(
    estimate: Estimate,
    transition: npt.ArrayLike,
    process: npt.ArrayLike,
    effect: npt.ArrayLike | None = None,
    control: npt.ArrayLike | None = None,
) -> Estimate:
    """(2.1), (2.2): the state one step later.

    Parameters
    ----------
    transition, process
        F and V, (n, n).
    effect, control
        G (n, k) and u (k,); both or none.

    Raises
    ------
    ParameterError
        for other shapes, or a process that is no covariance.
    """
    n = len(estimate.mean)
    f = _array("transition", transition, (n, n))
    if (effect is None) != (control is None):
        raise ParameterError("effect, control: one without the other; expected both or none")
    push = np.zeros(n)
    if effect is not None and control is not None:
        u = _array("control", control, (None,))
        push = _array("effect", effect, (n, len(u))) @ u
    return _spread(estimate, f @ estimate.mean + push, f, process)


def corrected(
    estimate: Estimate, sensor: npt.ArrayLike, measured: npt.ArrayLike, uncertainty: npt.ArrayLike
) -> Correction:
    """(2.3)-(2.5): the state after a measurement.

    Parameters
    ----------
    sensor
        H, (m, n).
    measured
        y, (m,).
    uncertainty
        W, (m, m).

    Raises
    ------
    ParameterError
        for other shapes, an uncertainty that is no covariance, or one that leaves an innovation without variance.
    """
    h = _array("sensor", sensor, (None, len(estimate.mean)))
    y = _array("measured", measured, (len(h),))
    return _taken_in(estimate, h, y - h @ estimate.mean, uncertainty)


def extended_prediction(estimate: Estimate, motion: Motion, process: npt.ArrayLike) -> Estimate:
    """`predicted` where the motion is not linear: (2.1) by the motion itself, (2.2) by its derivative at the mean.

    Raises
    ------
    ParameterError
        as `predicted`.
    """
    n = len(estimate.mean)
    mean, derivative = motion(estimate.mean)
    return _spread(estimate, _array("motion", mean, (n,)), _array("motion's derivative", derivative, (n, n)), process)


def extended_correction(
    estimate: Estimate,
    sensor: Sensor,
    measured: npt.ArrayLike,
    uncertainty: npt.ArrayLike,
    difference: Callable[[Floats, Floats], Floats] = np.subtract,
) -> Correction:
    """`corrected` where the sensor is not linear.

    Parameters
    ----------
    difference
        of two measurements (m,); another than the subtraction where one is an angle.

    Raises
    ------
    ParameterError
        as `corrected`.
    """
    expected, derivative = sensor(estimate.mean)
    h = _array("sensor's derivative", derivative, (None, len(estimate.mean)))
    y = _array("measured", measured, (len(h),))
    return _taken_in(estimate, h, difference(y, _array("sensor", expected, (len(h),))), uncertainty)


def gated(estimate: Estimate, correction: Correction) -> Estimate:
    """The corrected estimate; the estimate as it was where the innovation is larger than chance makes it (`GATES`)."""
    return correction.estimate if is_expected(correction.nis, len(correction.innovation)) else estimate


def is_expected(nis: float, freedom: int) -> bool:
    """Whether chance explains a normalised innovation squared of so many degrees of freedom (`GATES`)."""
    return nis <= GATES[freedom]


def require_seconds(dt: float) -> None:
    """Raise ParameterError unless a step takes a finite time above 0."""
    if not 0 < dt < math.inf:
        raise ParameterError(f"dt: {dt}; expected seconds above 0")


def require_covariance(name: str, value: npt.ArrayLike, size: int) -> Floats:
    """A copy of a covariance (size, size), exactly symmetric.

    Raises
    ------
    ParameterError
        if it is none.
    """
    matrix = _array(name, value, (size, size))
    scale = float(np.abs(matrix).max(initial=0.0))
    if np.abs(matrix - matrix.T).max(initial=0.0) > _SAME * scale:
        raise ParameterError(f"{name}: {matrix.tolist()}; expected a symmetric matrix")
    symmetric: Floats = (matrix + matrix.T) / 2
    lowest = _lowest_eigenvalue(symmetric) if size else 0.0
    if lowest < -_SAME * scale:
        raise ParameterError(f"{name}: eigenvalue {lowest:g}; expected none below 0")
    return symmetric


def _lowest_eigenvalue(symmetric: Floats) -> float:
    """The lowest eigenvalue; of a diagonal matrix, the usual case, its lowest entry."""
    diagonal = symmetric.diagonal()
    if np.count_nonzero(symmetric) == np.count_nonzero(diagonal):
        return float(diagonal.min())
    return float(np.linalg.eigvalsh(symmetric)[0])


def _spread(estimate: Estimate, mean: Floats, f: Floats, process: npt.ArrayLike) -> Estimate:
    v = require_covariance("process", process, len(mean))
    return _made(mean, _symmetric(f @ estimate.covariance @ f.T + v))


def _taken_in(estimate: Estimate, h: Floats, innovation: Floats, uncertainty: npt.ArrayLike) -> Correction:
    w = require_covariance("uncertainty", uncertainty, len(h))
    p = estimate.covariance
    s = _symmetric(h @ p @ h.T + w)
    gain = gain_of(h @ p, s, w)
    left = np.eye(len(p)) - gain @ h
    covariance = _symmetric(left @ p @ left.T + gain @ w @ gain.T)
    return Correction(_made(estimate.mean + gain @ innovation, covariance), innovation, s, gain)


def gain_of(seen: Floats, spread: Floats, uncertainty: Floats) -> Floats:
    """(n, m) the Kalman gain.

    Parameters
    ----------
    seen, spread
        (m, n) the covariance of what is measured with the state, and (m, m) that of the innovation.
    uncertainty
        (m, m) of the measurement itself, for the error.

    Raises
    ------
    ParameterError
        if the measurement has no variance where the state leaves none.
    """
    try:
        np.linalg.cholesky(spread)
    except np.linalg.LinAlgError:
        expected = "variance where the state itself leaves none to the measurement"
        raise ParameterError(f"uncertainty: {uncertainty.tolist()}; expected {expected}") from None
    return np.asarray(np.linalg.solve(spread, seen).T, dtype=np.float64)


def _made(mean: Floats, covariance: Floats) -> Estimate:
    """An estimate whose covariance is one by the way it was made: to look at its eigenvalues would cost the most."""
    if not (np.isfinite(mean).all() and np.isfinite(covariance).all()):
        raise ParameterError(f"mean: {mean.tolist()}; expected a finite estimate")
    estimate = object.__new__(Estimate)
    for name, array in (("mean", mean), ("covariance", covariance)):
        array.setflags(write=False)
        object.__setattr__(estimate, name, array)
    return estimate


def _symmetric(matrix: Floats) -> Floats:
    half: Floats = (matrix + matrix.T) / 2
    return half


def _array(name: str, value: npt.ArrayLike, shape: tuple[int | None, ...]) -> Floats:
    """A copy as numbers, of this shape; None stands for any length."""
    try:
        array = np.array(value, dtype=np.float64)
    except (TypeError, ValueError):
        raise ParameterError(f"{name}: {value!r}; expected an array of numbers") from None
    fits = array.ndim == len(shape) and all(w is None or w == g for w, g in zip(shape, array.shape, strict=True))
    if not fits:
        wanted = ", ".join("any" if length is None else str(length) for length in shape)
        raise ParameterError(f"{name}: shape {array.shape}; expected ({wanted}{',' if len(shape) == 1 else ''})")
    if not np.isfinite(array).all():
        raise ParameterError(f"{name}: {array.tolist()}; expected finite numbers")
    return array
