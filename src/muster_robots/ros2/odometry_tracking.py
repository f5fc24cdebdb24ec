"""A robot's position on the map by odometry, corrected by each pose on the map, as localisation does (REP-105)."""

from __future__ import annotations

import cmath
import math

from muster.motion.frames import wrapped
from muster.motion.port import Place

POSES_LAST_S = 1.0
"""Who gave a pose on the map so short a time ago does not go by odometry."""


class OdometryTracking:
    """Ties the frame of a robot's odometry to the map by the robot's poses. Metres, radians."""

    def __init__(self) -> None:
        self._turn, self._shift, self._lift = 1 + 0j, 0j, 0.0  # map = turn * odometry + shift, in the complex plane
        self._pose: tuple[Place, float] | None = None
        self._odometry: tuple[Place, float] | None = None
        self._posed_s = -math.inf

    @property
    def is_tied(self) -> bool:
        """Whether a pose has come."""
        return self._pose is not None

    def tie(self, now: float, place: Place, heading: float) -> None:
        """Tie the odometry frame to the map: the robot's last odometry is at this pose."""
        self._posed_s, self._pose = now, (place, heading)
        if self._odometry is not None:
            self._tie(*self._pose, *self._odometry)

    def reckon(self, now: float, place: Place, heading: float) -> tuple[Place, float] | None:
        """Place and heading on the map by those of the odometry; None while there are poses, or has been none yet."""
        if self._odometry is None and self._pose is not None:
            self._tie(*self._pose, place, heading)
        self._odometry = place, heading
        if self._pose is None or now - self._posed_s < POSES_LAST_S:
            return None
        there = self._turn * complex(*place[:2]) + self._shift
        return (there.real, there.imag, place[2] + self._lift), float(wrapped(heading + cmath.phase(self._turn)))

    def _tie(self, place: Place, heading: float, odometry: Place, headed: float) -> None:
        self._turn = cmath.rect(1.0, heading - headed)
        self._shift = complex(*place[:2]) - self._turn * complex(*odometry[:2])
        self._lift = place[2] - odometry[2]
