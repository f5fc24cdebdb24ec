"""Travelled distance of a robot by its reported positions: robot_usage of [tcf-thesis], Table 5.2."""

from __future__ import annotations

import math

from muster.motion.port import Place

MOVED_M = 0.01
"""Less than this is trembling of what measures, not travel."""


class Odometer:
    """Adds up metres.

    Parameters
    ----------
    flat
        whether height is of no account.
    """

    def __init__(self, *, flat: bool) -> None:
        self._flat = flat
        self._counted: Place | None = None
        self.metres = 0.0

    def hear(self, place: Place) -> None:
        """The robot is there now."""
        if self._counted is None:
            self._counted = place
        gone = distance(place, self._counted, flat=self._flat)
        if gone >= MOVED_M:
            self.metres += gone
            self._counted = place


def distance(one: Place, other: Place, *, flat: bool) -> float:
    """Metres, in the plane or in space."""
    return math.dist(one[:2], other[:2]) if flat else math.dist(one, other)
