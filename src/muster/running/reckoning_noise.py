"""What dead reckoning counts with in a simulated world: the world's own noise, as of one who knows his data sheets.

In a world that moves robots exactly as commanded, what `core/crowd/crowd_world.cpp` draws is all that odometry errs
by: `slip_apart` for the turns, `disturb` for the way. Bodies with masses and wheels err besides, by what `LEAST` says.
"""

from __future__ import annotations

import math

from muster.mission.model import Robot
from muster.perception.errors import ReckoningErrors
from muster.running.worlds import has_ability
from muster.simulation import Noise, SimulatedWorld
from muster.simulation.declaration import EXACT

LEAST = ReckoningErrors(
    way_share=0.01,
    aside_share=0.01,
    turn_share=0.12,
    turn_per_m=0.05,
    slip=0.02,
    skid=0.05,
    gyro_radps=0.001,
    gyro_bias_radps=0.001,
)
"""By how much odometry and gyro err at least where bodies skid and wheels are not as large as they should be.

The small robots of study market-5 turn by 3 % to 5 % less than their wheels count, and in a step by 12 % more or less.
"""
_TINY = 1e-6
"""The same in an exact world: no covariance is singular."""
_MOST_SLIP = 0.99
"""A wheel that slips by all of its way counts infinitely much for it."""
_TRACK_RADII, _NOMINAL_M = 0.287 / 0.3, 0.3
"""As in `core/crowd/crowd_robot.hpp`: between the wheels, in radii; and the radius in place of one of 0."""


def reckoning_errors(robot: Robot, world: SimulatedWorld) -> ReckoningErrors:
    """Return what dead reckoning of a robot counts with in a world."""
    noise, is_exact = world.noise, has_ability(type(world), EXACT)
    least = ReckoningErrors(**dict.fromkeys(_SPREADS, _TINY)) if is_exact else LEAST
    way_kept, way_share = _kept(noise)
    more, of_wheel = _more_of_wheel(noise)
    half_track = _TRACK_RADII / 2 * (robot.radius_m or _NOMINAL_M)
    turn_share = of_wheel / (math.sqrt(2) * (1 + more))
    return ReckoningErrors(
        way_kept=way_kept,
        turn_kept=(1 + turn_share**2) / (1 + more),
        way_share=max(least.way_share, way_share),
        aside_share=least.aside_share,
        turn_share=max(least.turn_share, turn_share),
        turn_per_m=max(least.turn_per_m, way_kept * turn_share / half_track),
        slip=least.slip,
        skid=least.skid,
        gyro_radps=max(least.gyro_radps, noise.gyro_radps),
        gyro_bias_radps=max(least.gyro_bias_radps, noise.gyro_bias_radps),
    )


_SPREADS = ("way_share", "aside_share", "turn_share", "turn_per_m", "slip", "skid", "gyro_radps", "gyro_bias_radps")


def _kept(noise: Noise) -> tuple[float, float]:
    """The mean share of the counted way that is travelled, and its standard deviation.

    It is (1 - slip u) / (1 + odometry n), with u even in 0 to 1 and n normal; to the second order of `odometry`.
    """
    kept, of_slip = 1 - noise.slip / 2, noise.slip / math.sqrt(12)
    return kept * (1 + noise.odometry**2), math.hypot(of_slip, kept * noise.odometry)


def _more_of_wheel(noise: Noise) -> tuple[float, float]:
    """The mean share that a wheel counts too much, and its standard deviation: of 1 / (1 - slip u) - 1 + odometry n."""
    slip = min(noise.slip, _MOST_SLIP)
    if slip < _TINY:
        return 0.0, noise.odometry
    mean = -math.log1p(-slip) / slip
    return mean - 1, math.sqrt(max(0.0, 1 / (1 - slip) - mean**2) + noise.odometry**2)
