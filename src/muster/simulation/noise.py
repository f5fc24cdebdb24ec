"""What a simulated robot does other than it means to, and what it says of itself other than it is."""

from __future__ import annotations

import math
from dataclasses import dataclass

from muster.mission.errors import ParameterError


@dataclass(frozen=True, kw_only=True)
class Noise:
    """Of all robots alike; all 0 by default. Drawn from the world's seed.

    Parameters
    ----------
    velocity
        standard deviation of the share of its velocity that a robot misses in a step. It never gets more than it
        wanted, so that noise alone brings no robot into contact.
    slip
        the most of its way, as a share, that a robot loses in a step though its odometry counts it; evenly from 0.
    odometry
        standard deviation of the share by which odometry errs in a step.
    position_m, heading_rad
        standard deviations of each coordinate and of the heading that telemetry gives.
    attitude_rad
        standard deviation of the roll and of the pitch that a robot takes itself to have.

    Raises
    ------
    ParameterError
        if one is negative or not finite, or `slip` is above 1.
    """

    velocity: float = 0.0
    slip: float = 0.0
    odometry: float = 0.0
    position_m: float = 0.0
    heading_rad: float = 0.0
    attitude_rad: float = 0.0

    def __post_init__(self) -> None:
        for name in ("velocity", "slip", "odometry", "position_m", "heading_rad", "attitude_rad"):
            value = getattr(self, name)
            if not 0 <= value < math.inf:
                raise ParameterError(f"{name}: {value}; expected a number of at least 0")
        if self.slip > 1:
            raise ParameterError(f"slip: {self.slip}; expected at most 1")


NO_NOISE = Noise()
