"""A robot's limits of speed, acceleration and turning, for motion profiles and for controllers."""

from __future__ import annotations

import math
from dataclasses import dataclass, fields

from muster.mission.errors import ParameterError

BENDS_SHARE = math.sqrt(0.5)
"""Of the acceleration, what a bend may take; so as much is left along the way."""


@dataclass(frozen=True, kw_only=True)
class Limits:
    """The largest value of each rate; `inf` where there is no limit.

    Parameters
    ----------
    acceleration_mps2
        of the velocity as a vector: along the path and across it together.
    climb_mps
        up and down, for robots that fly; without it `speed_mps`.
    track_m
        distance between the wheels of a differential drive; above 0 no rim goes faster than `speed_mps`.

    Raises
    ------
    ParameterError
        if one is not above 0, or a speed or the track is not finite.
    """

    speed_mps: float = 1.0
    acceleration_mps2: float = math.inf
    yaw_rate_radps: float = math.inf
    yaw_acceleration_radps2: float = math.inf
    climb_mps: float | None = None
    track_m: float = 0.0

    def __post_init__(self) -> None:
        for f in fields(self):
            value = getattr(self, f.name)
            if value is None:
                continue
            if not (value > 0 or (f.name == "track_m" and value == 0)):
                raise ParameterError(f"{f.name}: {value}; expected a number above 0")
            if math.isinf(value) and f.name in ("speed_mps", "climb_mps", "track_m"):
                raise ParameterError(f"{f.name}: {value}; expected a finite number")

    @property
    def climb(self) -> float:
        return self.speed_mps if self.climb_mps is None else self.climb_mps

    def braking_m(self, speed_mps: float) -> float:
        """How far a robot of this speed goes until it stands."""
        return speed_mps**2 / (2 * self.acceleration_mps2)

    def turning_radius_m(self, *, faces_its_way: bool) -> float:
        """The least radius that is driven at full speed; 0 where nothing limits turns.

        A robot that faces its way turns at most at its yaw rate; others are limited by what a bend may take of their
        acceleration.
        """
        if faces_its_way:
            return self.speed_mps / self.yaw_rate_radps
        return self.speed_mps**2 / (BENDS_SHARE * self.acceleration_mps2)

    @property
    def spot_yaw_rate(self) -> float:
        """The most rad/s on the spot."""
        return min(self.yaw_rate_radps, 2 * self.speed_mps / self.track_m if self.track_m else math.inf)
