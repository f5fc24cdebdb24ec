"""Wind: a steady velocity of the air, and gusts by the Dryden model at low altitude [milf1980].

The turbulence is a frozen field that a drone flies through, so that gusts change with airspeed and scale length. Along
the wind they have a first-order spectrum, across it and upright a second-order one. Each drone has gusts of its own.
"""

from __future__ import annotations

import math

import numpy as np

from muster.motion.grid import Floats
from muster.motion.noise import Wind

_FOOT_M = 0.3048
_LOWEST_FT, _HIGHEST_FT = 10.0, 1000.0
"""The heights between which the model at low altitude holds; others are taken for the nearer of these."""
_SLOWEST_MPS = 0.5
"""The least airspeed by which gusts change: a drone in still air meets them, too."""


def turbulence(height_m: Floats, gusts_mps: float) -> tuple[Floats, Floats]:
    """Standard deviations in m/s and scale lengths in m, each (n, 3): along the wind, across it, upright."""
    feet = np.clip(np.asarray(height_m) / _FOOT_M, _LOWEST_FT, _HIGHEST_FT)
    base = 0.177 + 0.000823 * feet
    upright = np.full_like(feet, 0.1 * gusts_mps)
    level = upright / base**0.4
    length = feet / base**1.2
    return np.column_stack([level, level, upright]), _FOOT_M * np.column_stack([length, length, feet])


class Gusts:
    """The gusts that one drone meets, drawn from a seed; each call is a step.

    With white noise n the filters are z1 = n / (1 + T s), z2 = z1 / (1 + T s), T the scale length over the airspeed.
    Along the wind gusts are z1, else sqrt(3) z1 + (1 - sqrt(3)) z2, which is the form of [milf1980]. Steps are exact.
    """

    _STATIONARY = np.array([[1.0, 0.5], [0.5, 0.5]])
    """The covariance of z1 and z2 for a variance of z1 of 1."""

    def __init__(self, seed: tuple[int, ...]) -> None:
        self._random = np.random.default_rng(np.random.SeedSequence(seed, spawn_key=(4,)))
        self._states = self._random.normal(size=(3, 2)) @ np.linalg.cholesky(self._STATIONARY).T

    def step(self, airspeed_mps: float, deviations: Floats, lengths: Floats, seconds: float) -> Floats:
        """(3,) m/s along the wind, across it and upright, after a step at an airspeed."""
        decays = seconds * max(airspeed_mps, _SLOWEST_MPS) / lengths
        moved = np.tile(np.eye(2), (3, 1, 1))
        moved[:, 1, 0] = decays
        moved *= np.exp(-decays)[:, None, None]
        drawn = self._STATIONARY - moved @ self._STATIONARY @ moved.transpose(0, 2, 1)
        roots = np.linalg.cholesky(drawn + 1e-15 * np.eye(2))
        noise = self._random.normal(size=(3, 2, 1))
        self._states = (moved @ self._states[:, :, None] + roots @ noise)[:, :, 0]
        first, second = self._states.T
        shaped = (math.sqrt(3) * first + (1 - math.sqrt(3)) * second) / math.sqrt(2)
        return np.asarray(deviations * [first[0], shaped[1], shaped[2]])


class WindField:
    """The wind around the robots of a world, which may join one after the other."""

    def __init__(self, wind: Wind, seed: int) -> None:
        self.wind, self._seed = wind, seed
        self._gusts: list[Gusts] = []
        east, north, _ = wind.velocity_mps
        speed = math.hypot(east, north)
        c, s = (east / speed, north / speed) if speed > 0 else (1.0, 0.0)
        self._axes = np.array([[c, -s, 0.0], [s, c, 0.0], [0.0, 0.0, 1.0]])

    def step(self, heights_m: Floats, velocities: Floats, seconds: float) -> Floats:
        """(n, 3): the velocities of the air around robots at these heights above the ground, moving so, m/s."""
        steady = np.array(self.wind.velocity_mps, dtype=np.float64)
        air = np.tile(steady, (len(heights_m), 1))
        if self.wind.gusts_mps == 0:
            return air
        while len(self._gusts) < len(heights_m):
            self._gusts.append(Gusts((self._seed, len(self._gusts))))
        deviations, lengths = turbulence(heights_m, self.wind.gusts_mps)
        airspeeds = np.linalg.norm(velocities - steady, axis=1)
        for k, gusts in enumerate(self._gusts[: len(air)]):
            air[k] += self._axes @ gusts.step(float(airspeeds[k]), deviations[k], lengths[k], seconds)
        return air
