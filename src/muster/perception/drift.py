"""The drift study: how far an estimate is from the truth by time, with and without fixes ([tcf-thesis], Appendix A6.1).

The thesis flew a drone five times around the setpoints of Table A.21, by visual inertial odometry, and measured with
motion capture (Figure A.14). Here a robot goes any way that is given, its sensors are simulated, and the same readings
go into plain integration of odometry, a filter with the inertial unit, and that filter with fixes.

By the table a pass is 9.98 m long and five are 51.6 m with the way there, at up to 0.5 m/s; the thesis' text counts
four passes of 15 m, 60 m in all. Its errors, 0.15 m to 0.5 m, are 0.25 % to 0.83 % of 60 m.
"""

from __future__ import annotations

import itertools
import math
from dataclasses import dataclass

import numpy as np

from muster.mission.errors import ParameterError
from muster.motion.frames import wrapped
from muster.perception import air_fusion, ground_fusion
from muster.perception.errors import AirErrors, GroundErrors
from muster.perception.kalman import Estimate, Floats, require_seconds

START = (-2.18, 0.04, 0.118)
SETPOINTS = ((-1.0, -1.0, 0.75), (1.0, -1.5, 1.25), (2.0, 0.0, 0.75), (1.0, 1.5, 1.25), (-1.0, 1.0, 0.75))
"""Metres, map frame: where the drone of A6.1 stood, and Table A.21."""
_A_STEP = 1e-9


@dataclass(frozen=True, kw_only=True)
class Bias:
    """What sensors get wrong always in the same way.

    Parameters
    ----------
    scale
        share by which odometry counts too much. On the ground the filter looks for it, in the air not.
    turn_radps, gyro_radps
        of a robot in the plane: by how much the yaw rate of its wheels, and that of its gyro, is off. The filter looks
        for the latter.
    drift_mps
        of a drone: by how much each coordinate of its velocity is off.
    """

    scale: float = 0.0
    turn_radps: float = 0.0
    gyro_radps: float = 0.0
    drift_mps: float = 0.0


@dataclass(frozen=True, eq=False)
class Drift:
    """Errors by time. All arrays are (t,), places (t, d).

    Parameters
    ----------
    times, travelled
        seconds, and metres of the true way until then.
    truth, places
        metres: where it is, and where the estimates take it to be, in the order of the errors.
    odometry, inertial, fixes
        metres from the estimated place to the true one: odometry alone; odometry and inertial unit; both and fixes.
    """

    times: Floats
    travelled: Floats
    truth: Floats
    places: tuple[Floats, Floats, Floats]
    odometry: Floats
    inertial: Floats
    fixes: Floats

    def share(self, errors: Floats) -> float:
        """The last error as a share of the way travelled; 0 of no way."""
        return float(errors[-1] / self.travelled[-1]) if self.travelled[-1] > 0 else 0.0


def published_flight(*, passes: int = 5, speed_mps: float = 0.5, hold_s: float = 3.3, dt: float = 0.1) -> Floats:
    """The places (t, 3), `dt` apart, of a flight as in A6.1: straight around and back to the first setpoint.

    Five passes, 0.5 m/s at most and about 10 readings a second are the thesis'. From setpoint to setpoint the drone
    moves by the share 3 s^2 - 2 s^3 of the time s, fastest half way; how long it stays is chosen so that the flight
    takes the four minutes between the marks of the thesis' figures.
    """
    stops = np.array([START, *SETPOINTS * passes, SETPOINTS[0]])
    parts = [stops[:1]]
    for start, end in itertools.pairwise(stops):
        steps = math.ceil(1.5 * np.linalg.norm(end - start) / (speed_mps * dt))
        time = np.arange(1, steps + 1)[:, None] / steps
        parts += [start + (end - start) * time**2 * (3 - 2 * time), np.tile(end, (round(hold_s / dt), 1))]
    return np.concatenate(parts)


def air_drift(
    positions: Floats, dt: float, errors: AirErrors, bias: Bias, *, fix_every_s: float, seed: int = 0
) -> Drift:
    """The study of a drone that is truly at positions (t, 3), `dt` seconds apart; it knows where and how it begins.

    Raises
    ------
    ParameterError
        for another shape, or fixes that are not whole steps apart.
    """
    _require(positions, dt)
    every = _steps(fix_every_s, dt)
    random = np.random.default_rng(seed)
    velocities = np.gradient(positions, dt, axis=0)
    said = velocities * (1 + bias.scale) + bias.drift_mps + random.normal(0, errors.velocity_mps, velocities.shape)
    felt = np.diff(velocities, axis=0) / dt
    felt += random.normal(0, errors.acceleration_mps2, felt.shape)
    fixes = positions + random.normal(0, errors.position_m, positions.shape)

    def flown(until_fix: int) -> Floats:
        estimate = Estimate(np.concatenate([positions[0], velocities[0], [0.0]]), np.zeros((7, 7)))
        places = [estimate.mean[:3]]
        for step in range(1, len(positions)):
            estimate = air_fusion.moved(estimate, dt, errors, felt[step - 1])
            estimate = air_fusion.by_odometry(estimate, said[step], errors).estimate
            if step % until_fix == 0:
                estimate = air_fusion.by_position(estimate, fixes[step], errors).estimate
            places.append(estimate.mean[:3])
        return np.array(places)

    reckoned = positions[0] + np.vstack([np.zeros(3), np.cumsum(dt * _between(said), axis=0)])
    return _drift(positions, dt, reckoned, flown(len(positions)), flown(every))


def ground_drift(
    poses: Floats, dt: float, errors: GroundErrors, bias: Bias, *, fix_every_s: float, seed: int = 0
) -> Drift:
    """The study of a robot whose true poses are (t, 3): x, y, heading, `dt` seconds apart; it knows how it begins.

    Its speed is along its heading, forward or backward. Fixes are of the position alone.

    Raises
    ------
    ParameterError
        for another shape, or fixes that are not whole steps apart.
    """
    _require(poses, dt)
    every = _steps(fix_every_s, dt)
    random = np.random.default_rng(seed)
    speeds, turns = _driven(poses, dt)
    said = speeds * (1 + bias.scale) + random.normal(0, np.hypot(errors.odometry_share * speeds, errors.odometry_mps))
    wheel_turns = turns + bias.turn_radps + random.normal(0, errors.odometry_radps, len(turns))
    gyro = turns + bias.gyro_radps + random.normal(0, errors.gyro_radps, len(turns))
    ahead = np.diff(speeds) / dt
    ahead += random.normal(0, errors.acceleration_mps2, len(ahead))
    fixes = poses[:, :2] + random.normal(0, errors.position_m, (len(poses), 2))
    start = np.array([*poses[0], speeds[0], turns[0], 0.0, 0.0])
    known = np.diag(np.square([0.0] * 5 + [errors.gyro_bias_radps, errors.odometry_slip]))

    def driven(until_fix: int) -> Floats:
        estimate = Estimate(start, known)
        places = [estimate.mean[:2]]
        for step in range(1, len(poses)):
            estimate = ground_fusion.moved(estimate, dt, errors, float(ahead[step - 1]))
            estimate = ground_fusion.by_odometry(estimate, said[step], wheel_turns[step], errors).estimate
            estimate = ground_fusion.by_gyro(estimate, gyro[step], errors).estimate
            if step % until_fix == 0:
                estimate = ground_fusion.by_position(estimate, fixes[step], errors).estimate
            places.append(estimate.mean[:2])
        return np.array(places)

    state, reckoned = start, [start[:2]]
    for speed, turn in zip(_between(said), _between(wheel_turns), strict=True):
        state = ground_fusion.arc(np.array([*state[:3], speed, turn, 0.0, 0.0]), dt)[0]
        reckoned.append(state[:2])
    return _drift(poses[:, :2], dt, np.array(reckoned), driven(len(poses)), driven(every))


def _driven(poses: Floats, dt: float) -> tuple[Floats, Floats]:
    """Speeds ahead and yaw rates (t,) at the poses: the means of the arcs before and after."""
    turns = wrapped(np.diff(poses[:, 2]))
    way = np.diff(poses[:, :2], axis=0)
    middle = poses[:-1, 2] + turns / 2
    chords = way[:, 0] * np.cos(middle) + way[:, 1] * np.sin(middle)
    speeds = chords / np.sinc(turns / (2 * math.pi))
    return _at_ends(speeds) / dt, _at_ends(turns) / dt


def _at_ends(pieces: Floats) -> Floats:
    return _between(np.concatenate([pieces[:1], pieces, pieces[-1:]]))


def _between(readings: Floats) -> Floats:
    """The means (t - 1, ...) of readings (t, ...) beside each other."""
    means: Floats = (readings[1:] + readings[:-1]) / 2
    return means


def _drift(truth: Floats, dt: float, *estimated: Floats) -> Drift:
    pieces = np.linalg.norm(np.diff(truth, axis=0), axis=1)
    travelled = np.concatenate([[0.0], np.cumsum(pieces)])
    odometry, inertial, fixes = estimated
    errors = [np.linalg.norm(places - truth, axis=1) for places in estimated]
    times: Floats = dt * np.arange(len(truth), dtype=np.float64)
    return Drift(times, travelled, truth, (odometry, inertial, fixes), *errors)


def _steps(every_s: float, dt: float) -> int:
    steps = round(every_s / dt) if math.isfinite(every_s) else 0
    if steps < 1 or abs(steps * dt - every_s) > _A_STEP:
        raise ParameterError(f"fix_every_s: {every_s}; expected a whole number of steps of {dt} s")
    return steps


def _require(places: Floats, dt: float) -> None:
    if places.ndim != 2 or places.shape[1] != 3 or len(places) < 2:
        raise ParameterError(f"places: shape {places.shape}; expected (t, 3), t >= 2")
    require_seconds(dt)
