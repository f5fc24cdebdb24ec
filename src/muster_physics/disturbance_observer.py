"""What forces and moments that no model tells, as wind's, do to bodies: by acceleration, as in [tomic2014]."""

from __future__ import annotations

import math

import numpy as np

from muster.motion.grid import Floats

OBSERVER_S = 0.3
"""Time constant in which a disturbance is found out."""
MOST = np.array([4.0, 4.0, 4.0, 5.0, 5.0, 5.0])
"""The greatest accelerations that are taken for disturbances, m/s^2 and rad/s^2: rotors can hold against these."""


class DisturbanceObserver:
    """Low-passes the difference of measured and expected accelerations.

    Accelerations are (n, 6): of the frame in the map frame, m/s^2, and about the body's axes, rad/s^2.
    """

    def __init__(self, step_s: float) -> None:
        self._step_s, self._share = step_s, -math.expm1(-step_s / OBSERVER_S)
        self._before: tuple[Floats, Floats] | None = None

    def observed(self, estimate: Floats, velocities: Floats, expected: Floats) -> Floats:
        """The next estimate, (n, 6).

        Parameters
        ----------
        estimate
            the last one.
        velocities
            (n, 6) now: of the frame, and about the body's axes.
        expected
            accelerations from now on by all that is known.
        """
        before, self._before = self._before, (velocities, expected)
        if before is None:
            return estimate
        measured = (velocities - before[0]) / self._step_s
        return np.clip(estimate + self._share * (measured - before[1] - estimate), -MOST, MOST)
