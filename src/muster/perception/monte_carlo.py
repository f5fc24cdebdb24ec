"""Monte Carlo localisation: a robot's pose on a known map as a cloud of particles.

[dellaert1999] and [thrun2005], chapter 8: particles move with odometry, are weighed by a laser scan, and are drawn anew
by weight. Their number follows from how many places they cover (KLD sampling, [fox2003]), and the worse scans fit, the
more of them are drawn from the whole map (sensor resetting, [lenser2000]). So the one filter tracks a pose, finds one
without a start (global localisation), and recovers when the robot is carried elsewhere (the kidnapped robot of
[auction-thesis], section 2.4).
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import asdict, dataclass
from typing import Any

import numpy as np
import numpy.typing as npt

from muster.mission.errors import ParameterError
from muster.mission.values.ranges import require_finite_positive
from muster.motion.frames import wrapped
from muster.perception.kalman import Estimate, Floats
from muster.perception.laser import require_scan
from muster.perception.likelihood_field import LikelihoodField

PoseSampler = Callable[[np.random.Generator, int], Floats]
"""Draws so many poses (n, 3) of the map at which the robot could be, each equally likely."""


CLUSTER_M, CLUSTER_RAD = 0.75, math.radians(45)
"""Particles so near to each other are of one cluster."""


@dataclass(frozen=True, kw_only=True)
class MonteCarloParameters:
    """How a `MonteCarlo` filter works.

    Parameters
    ----------
    least, most
        of the number of particles; it begins with `most`.
    bin_m, bin_rad
        the size of the bins that KLD sampling counts.
    kld_error, kld_quantile
        the error of the distribution that is allowed, and the normal quantile of the probability that it holds.
    beams
        of a scan that are weighed, spread evenly over it.
    deviation_m
        standard deviation of the end of a beam from a wall: errors of the scanner, of the map and of the cells.
    stray_share
        share of beams that end anywhere.
    beam_weight
        the power to which the likelihood of one beam is raised, since neighbouring beams err together.
    way_share, turn_share, turn_per_m
        standard deviations of odometry: of the way and the turn as shares of them, and of the heading in rad for a
        metre of way.
    good_fit
        the mean likelihood of a beam, 0 to 1, from which on no particles are drawn from the whole map.
    fit_share
        the share by which the running mean of that likelihood follows it with each scan.

    Raises
    ------
    ParameterError
        if a number is out of range.
    """

    least: int = 500
    most: int = 20_000
    bin_m: float = 0.25
    bin_rad: float = math.radians(10)
    kld_error: float = 0.02
    kld_quantile: float = 2.33
    beams: int = 60
    deviation_m: float = 0.1
    stray_share: float = 0.1
    beam_weight: float = 0.2
    way_share: float = 0.1
    turn_share: float = 0.1
    turn_per_m: float = 0.05
    good_fit: float = 0.8
    fit_share: float = 0.3

    def __post_init__(self) -> None:
        require_finite_positive(**asdict(self))
        if not self.least <= self.most:
            raise ParameterError(f"most: {self.most}; expected at least {self.least}, as many as least")
        for name in ("stray_share", "good_fit", "fit_share"):
            if getattr(self, name) > 1:
                raise ParameterError(f"{name}: {getattr(self, name)}; expected at most 1")


class MonteCarlo:
    """The filter of one robot.

    Parameters
    ----------
    field
        the walls that scans show.
    anywhere
        draws poses from the whole map.
    seed
        of all that is drawn.
    start, deviations
        where the robot starts, x, y in metres and heading in radians, (3,), and the standard deviations of that; None:
        anywhere.
    """

    def __init__(
        self,
        field: LikelihoodField,
        anywhere: PoseSampler,
        parameters: MonteCarloParameters | None = None,
        *,
        seed: int = 0,
        start: tuple[float, float, float] | None = None,
        deviations: tuple[float, float, float] = (0.1, 0.1, 0.1),
    ) -> None:
        self._field, self._anywhere = field, anywhere
        self._parameters = parameters or MonteCarloParameters()
        self._random = np.random.default_rng(seed)
        self._fit: float | None = None
        if start is None:
            self.particles = anywhere(self._random, self._parameters.most)
        else:
            drawn = self._random.normal(0.0, deviations, (self._parameters.least, 3))
            self.particles = np.array(start) + drawn
        """(n, 3): x, y in metres, heading in radians."""

    @property
    def estimate(self) -> Estimate:
        """The pose (3,) and its covariance (3, 3): of the densest cluster of particles."""
        cluster = self.particles[self._cluster]
        middle = _mean_pose(cluster)
        apart = np.column_stack([cluster[:, :2] - middle[:2], wrapped(cluster[:, 2] - middle[2])])
        return Estimate(middle, apart.T @ apart / len(apart))

    @property
    def share(self) -> float:
        """The share of the particles that are in the densest cluster."""
        return float(self._cluster.mean())

    @property
    def _cluster(self) -> npt.NDArray[np.bool_]:
        """Which particles (n,) are near the mean of the fullest bin."""
        bins = np.floor(self.particles / (CLUSTER_M, CLUSTER_M, CLUSTER_RAD)).astype(np.int64)
        _, number, counts = np.unique(bins, axis=0, return_inverse=True, return_counts=True)
        middle = _mean_pose(self.particles[number.ravel() == int(np.argmax(counts))])
        apart = np.hypot(*(self.particles[:, :2] - middle[:2]).T)
        turned = np.abs(wrapped(self.particles[:, 2] - middle[2]))
        near: npt.NDArray[np.bool_] = (apart <= CLUSTER_M) & (turned <= CLUSTER_RAD)
        return near

    def move(self, ahead_m: float, left_m: float, turn_rad: float) -> None:
        """Move the particles by odometry since the last call, in the robot's frame at its beginning."""
        p, n = self._parameters, len(self.particles)
        way = math.hypot(ahead_m, left_m)
        share = 1 + self._random.normal(0.0, p.way_share, n)
        spread = math.hypot(p.turn_share * turn_rad, p.turn_per_m * way)
        turn = turn_rad + self._random.normal(0.0, spread, n)
        middle = self.particles[:, 2] + turn / 2  # the chord of an arc looks along half of the turn
        c, s = np.cos(middle - turn_rad / 2), np.sin(middle - turn_rad / 2)
        self.particles[:, 0] += share * (c * ahead_m - s * left_m)
        self.particles[:, 1] += share * (s * ahead_m + c * left_m)
        self.particles[:, 2] = wrapped(self.particles[:, 2] + turn)

    def correct(self, ranges: Floats, bearings: Floats) -> None:
        """Weigh the particles by a scan, ranges (n,) in metres at bearings (n,) in radians, and draw them anew.

        Beams without an echo say nothing.

        Raises
        ------
        ParameterError
            if ranges and bearings are not those of one scan.
        """
        require_scan(ranges, bearings)
        fits = self._fits(ranges, bearings)
        if fits is None:
            return
        p = self._parameters
        fit = float(np.exp(fits).mean())
        self._fit = fit if self._fit is None else self._fit + p.fit_share * (fit - self._fit)
        weights = np.exp(p.beam_weight * min(p.beams, len(ranges)) * (fits - fits.max()))
        self.particles = self._drawn(weights / weights.sum(), max(0.0, 1 - self._fit / p.good_fit))

    def _fits(self, ranges: Floats, bearings: Floats) -> Floats | None:
        """(n,): the mean logarithm of the likelihood of a beam, of each particle; None where no beam has an echo."""
        p = self._parameters
        used = np.linspace(0, len(ranges) - 1, min(p.beams, len(ranges))).astype(int)
        used = used[np.isfinite(ranges[used])]
        if not len(used):
            return None
        angles = self.particles[:, 2:] + bearings[used]
        ends = np.stack([np.cos(angles), np.sin(angles)], axis=2) * ranges[used][:, None]
        distances = self._field.distances(self.particles[:, None, :2] + ends)
        hits = np.exp(-0.5 * (distances / p.deviation_m) ** 2)
        fits: Floats = np.log((1 - p.stray_share) * hits + p.stray_share).mean(axis=1)
        return fits

    def _drawn(self, weights: Floats, from_anywhere: float) -> Floats:
        """New particles: by weight, as many as KLD sampling wants, a share of them from the whole map."""
        p = self._parameters
        count = min(2 * p.least, p.most)
        while True:
            new = self.particles[self._random.choice(len(weights), count, p=weights)]
            lost = self._random.random(count) < from_anywhere
            new[lost] = self._anywhere(self._random, int(lost.sum()))
            wanted = self._wanted(new)
            if wanted < count or count == p.most:
                return new[:wanted]
            count = min(4 * count, p.most)

    def _wanted(self, particles: Floats) -> int:
        """How many of these particles are enough for the bins that they cover."""
        p = self._parameters
        size = (p.bin_m, p.bin_m, p.bin_rad)
        bins = np.floor(particles / size).astype(np.int64)
        _, first = np.unique(bins, axis=0, return_index=True)
        covered = np.zeros(len(particles), dtype=np.int64)
        covered[first] = 1
        enough = np.arange(1, len(particles) + 1) >= kld_count(np.cumsum(covered), p.kld_error, p.kld_quantile)
        enough[: p.least - 1] = False
        return int(np.argmax(enough)) + 1 if enough.any() else len(particles)


def _mean_pose(particles: Floats) -> Floats:
    heading = particles[:, 2]
    turn = math.atan2(float(np.sin(heading).mean()), float(np.cos(heading).mean()))
    return np.array([*particles[:, :2].mean(axis=0), turn])


def kld_count(bins: npt.NDArray[Any], error: float, quantile: float) -> Floats:
    """How many particles KLD sampling wants for so many bins (n,): [fox2003], equation (7). 1 for a single bin."""
    k = np.maximum(np.asarray(bins, dtype=np.float64) - 1, 1e-9)
    part = 2 / (9 * k)
    count = k / (2 * error) * (1 - part + np.sqrt(part) * quantile) ** 3
    return np.where(np.asarray(bins) > 1, count, 1.0)
