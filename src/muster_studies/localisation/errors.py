"""The runs: how far estimates of a drive are from the truth."""

from __future__ import annotations

import itertools
import math
from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from functools import cache

import numpy as np

from muster.motion.frames import wrapped
from muster.motion.grid import Floats
from muster.perception.collaborative_localisation import by_teammate
from muster.perception.errors import GroundErrors
from muster.perception.kalman import Estimate, extended_prediction
from muster.perception.laser import points_of
from muster.perception.monte_carlo import MonteCarlo
from muster.perception.scan_matching import matched
from muster_studies.localisation.drives import SCANNER, SLIP, TURN_RAD, Reading, drive, scanned_floor

SEEN_M = 8.0
"""The distance within which robots see each other."""
RANGE_M, BEARING_RAD = 0.05, 0.02
"""Standard deviations of a teammate's range and bearing."""
_ERRORS = GroundErrors(range_m=RANGE_M, bearing_rad=BEARING_RAD)


@dataclass(frozen=True, eq=False)
class Track:
    """Errors over time.

    Parameters
    ----------
    times_s, errors_m
        (n,): when, and how far the estimated position is from the true one.
    """

    times_s: Floats
    errors_m: Floats

    def found_s(self, within_m: float, after_s: float = 0.0) -> float | None:
        """Seconds after `after_s` from which on the error stays below; None where it never does."""
        off = np.flatnonzero((self.errors_m > within_m) & (self.times_s >= after_s))
        if len(off) and off[-1] == len(self.times_s) - 1:
            return None
        first = float(self.times_s[off[-1] + 1]) if len(off) else after_s
        return first - after_s


@cache
def drives(seed: int, until_s: float) -> tuple[Reading, ...]:
    """One rover's drive from a random place."""
    return tuple(drive(scanned_floor().anywhere(np.random.default_rng(seed), 1), until_s, seed))


@cache
def carried(seed: int, until_s: float) -> tuple[Reading, ...]:
    """The drive, after which the robot is carried to another place and drives on for as long.

    Odometry counts nothing of its being carried.
    """
    first, other = drives(seed, until_s), scanned_floor().anywhere(np.random.default_rng((seed, 2)), 1)
    later = drive(other, until_s, seed + 1000)
    return (*first, *(Reading(until_s + one.time_s, one.poses, one.moves, one.ranges) for one in later))


def by_odometry(readings: Iterable[Reading]) -> Track:
    """Dead reckoning from the true start."""
    return _track(readings, _reckoned(readings, [reading.moves[0] for reading in readings]))


def by_scan_matching(readings: Iterable[Reading]) -> Track:
    """Scans matched one with the next from the true start; odometry is the guess, and stands in where none matches."""
    scans = [points_of(reading.ranges[0], SCANNER.bearings) for reading in readings]
    moves = [reading.moves[0] for reading in readings]
    for k, (before, after) in enumerate(itertools.pairwise(scans), start=1):
        match = matched(before, after, moves[k])
        moves[k] = moves[k] if match is None else match.pose
    return _track(readings, _reckoned(readings, moves))


def by_monte_carlo(readings: Iterable[Reading], seed: int, *, known: bool) -> Track:
    """Particles, from the true start where it is `known`, else from anywhere."""
    first = next(iter(readings))
    particles = MonteCarlo(
        scanned_floor().field, scanned_floor().anywhere, seed=seed, start=_pose(first.poses[0]) if known else None
    )
    estimates = []
    for reading in readings:
        particles.move(*map(float, reading.moves[0]))
        particles.correct(reading.ranges[0], SCANNER.bearings)
        estimates.append(particles.estimate.mean)
    return _track(readings, np.array(estimates))


def of_team(seed: int, until_s: float, *, together: bool) -> Track:
    """The second of two robots, which has no map: odometry alone, or with sightings of the first, which has one."""
    start = scanned_floor().anywhere(np.random.default_rng(seed), 1)
    starts = np.concatenate([start, start])
    starts[1, :2] = _beside(starts[0])
    random = np.random.default_rng((seed, 3))
    readings = tuple(drive(starts, until_s, seed))
    guide = MonteCarlo(scanned_floor().field, scanned_floor().anywhere, seed=seed, start=_pose(starts[0]))
    follower = Estimate(starts[1], np.diag([0.01, 0.01, 0.01]) ** 2)
    errors = []
    for reading in readings:
        guide.move(*map(float, reading.moves[0]))
        guide.correct(reading.ranges[0], SCANNER.bearings)
        follower = _moved(follower, reading.moves[1])
        seen = _seen(reading, random) if together else None
        if seen is not None:
            follower = by_teammate(follower, guide.estimate, *seen, _ERRORS)
        errors.append(math.dist(follower.mean[:2], reading.poses[1, :2]))
    return Track(np.array([reading.time_s for reading in readings]), np.array(errors))


def _pose(row: Floats) -> tuple[float, float, float]:
    x, y, heading = map(float, row)
    return x, y, heading


def _beside(pose: Floats) -> Floats:
    """A free place (2,) near a pose."""
    near = scanned_floor().anywhere(np.random.default_rng(0), 4000)[:, :2]
    apart = np.hypot(*(near - pose[:2]).T)
    found: Floats = near[np.argmin(np.where(apart > 1.0, apart, np.inf))]
    return found


def _seen(reading: Reading, random: np.random.Generator) -> tuple[float, float] | None:
    """Range and bearing of the first robot from the second; None where it is out of sight."""
    (x, y, _), (own_x, own_y, heading) = reading.poses
    away = math.dist((x, y), (own_x, own_y))
    bearing = float(wrapped(math.atan2(y - own_y, x - own_x) - heading))
    if away > SEEN_M or abs(bearing) > SCANNER.field_rad / 2 or not _in_sight(reading, away, bearing):
        return None
    return away + float(random.normal(0.0, RANGE_M)), bearing + float(random.normal(0.0, BEARING_RAD))


def _in_sight(reading: Reading, away: float, bearing: float) -> bool:
    """Whether no wall is nearer in that direction than the robot is."""
    beam = int(np.argmin(np.abs(SCANNER.bearings - bearing)))
    return bool(reading.ranges[1, beam] > away - _NEARER_M)


_NEARER_M = 0.5
"""A laser meets the body of a robot before its centre, and errs."""


def _moved(estimate: Estimate, move: Floats) -> Estimate:
    """The estimate (3,) after a move of odometry, with its errors."""
    ahead, left, turn = map(float, move)
    c, s = math.cos(estimate.mean[2]), math.sin(estimate.mean[2])
    way = math.hypot(ahead, left)
    spread = np.diag([(SLIP * way) ** 2, (SLIP * way) ** 2, TURN_RAD**2 if way else 0.0])

    def motion(state: Floats) -> tuple[Floats, Floats]:
        after = np.array([state[0] + c * ahead - s * left, state[1] + s * ahead + c * left, state[2] + turn])
        derivative = np.eye(3)
        derivative[:2, 2] = -s * ahead - c * left, c * ahead - s * left
        return after, derivative

    return extended_prediction(estimate, motion, spread)


def _reckoned(readings: Iterable[Reading], moves: Iterable[Floats]) -> Floats:
    """Poses (t, 3) from the true start by moves in the robot's frame; the first move is none."""
    return np.array(list(_chained(next(iter(readings)).poses[0], moves)))


def _chained(pose: Floats, moves: Iterable[Floats]) -> Iterator[Floats]:
    for ahead, left, turn in moves:
        c, s = math.cos(pose[2]), math.sin(pose[2])
        pose = pose + np.array([c * ahead - s * left, s * ahead + c * left, turn])
        yield pose


def _track(readings: Iterable[Reading], estimates: Floats) -> Track:
    truth = np.array([reading.poses[0, :2] for reading in readings])
    times = np.array([reading.time_s for reading in readings])
    return Track(times, np.asarray(np.linalg.norm(estimates[:, :2] - truth, axis=1)))
