"""Figures of a step response: rise time, overshoot, settling time."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from muster_studies.rotors.reference import Floats

SETTLED = 0.02
"""The share of a step within which a response has settled."""


@dataclass(frozen=True)
class Response:
    """From 10 % to 90 % of the step, in seconds; over the step, in per cent of it; until it stays within 2 %."""

    rise_s: float
    overshoot: float
    settled_s: float

    @classmethod
    def of(cls, times: Floats, shares: Floats) -> Response:
        """Of a response as shares of its step: 0 at the begin, 1 at the end."""
        outside = np.flatnonzero(np.abs(shares - 1.0) > SETTLED)
        settled = float(np.interp(0.0, [0.0, 1.0], times[outside[-1] : outside[-1] + 2]))
        rise = _reached(times, shares, 0.9) - _reached(times, shares, 0.1)
        return cls(rise, max(0.0, 100.0 * (float(shares.max()) - 1.0)), settled)


def _reached(times: Floats, shares: Floats, level: float) -> float:
    """When a response first reached a level."""
    after = int(np.argmax(shares >= level))
    return float(np.interp(level, shares[after - 1 : after + 1], times[after - 1 : after + 1]))
