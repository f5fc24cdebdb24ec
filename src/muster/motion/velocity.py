"""Velocity generation: a curve becomes a trajectory that keeps a robot's limits ([market-paper], section 3.2.3).

On each smooth leg of the curve the speed is bounded at every place by what it turns there, then a pass forward bounds
what can be reached by accelerating and a pass backward what can still be braked. Between places the acceleration is
constant. At corners, and at both ends, the robot stands; without a limit of acceleration speeds jump instead. A robot
that must face its way turns on the spot at corners.
"""

from __future__ import annotations

import math

import numpy as np
import numpy.typing as npt

from muster.mission.errors import ParameterError
from muster.mission.values.arrays import Floats
from muster.motion.curve import Curve
from muster.motion.frames import wrapped
from muster.motion.limits import BENDS_SHARE, Limits
from muster.motion.trajectory import Trajectory, joined
from muster.motion.wheels import fastest_translation

Indices = npt.NDArray[np.intp]

_CORNER = 1e-6  # radians; a smaller turn between two segments is rounding
_TURN_STEP = 0.05  # radians between two moments on a bend
_LEAST_PIECES = 4  # of a bent segment
_SWING = 0.05  # radians by which a heading may swing out on a straight segment, until the yaw rate of a bend is 0


def timed(
    curve: Curve,
    limits: Limits,
    *,
    faces_its_way: bool,
    start_heading: float | None = None,
    end_heading: float | None = None,
    step_m: float = 0.1,
) -> Trajectory:
    """The trajectory along a curve, from rest to rest, as fast as the limits allow on each leg.

    Parameters
    ----------
    faces_its_way
        whether the robot drives only where it looks (differential drive). Otherwise it keeps its start heading on the
        way.
    start_heading
        radians; without it that of the curve's start for a robot that faces its way, otherwise 0.
    end_heading
        radians, to which it turns at the end; without it, it stays as it arrives.
    step_m
        metres, at most, between two moments on a bend.

    Raises
    ------
    ParameterError
        if `step_m` is not above 0.
    """
    if not step_m > 0:
        raise ParameterError(f"step_m: {step_m}; expected metres above 0")
    legs = _legs(curve)
    heading = _first_heading(curve, legs, faces_its_way) if start_heading is None else start_heading
    parts = [_rest(curve.control[0, 0], heading)]
    for leg in legs:
        driven = _driven(curve, leg, limits, heading, faces_its_way, step_m)
        if faces_its_way:
            parts.append(_turned(curve.control[leg[0], 0], heading, float(driven.headings[0]), limits))
        parts.append(driven)
        heading = float(driven.headings[-1])
    if end_heading is not None:
        goal = heading + float(wrapped(end_heading - heading))
        parts.append(_turned(curve.control[-1, 3], heading, goal, limits))
        heading = goal
    return joined([*parts, _rest(curve.control[-1, 3], heading)])


def _legs(curve: Curve) -> list[Indices]:
    """The segments between corners, without those that are points."""
    long = np.flatnonzero(np.abs(curve.control - curve.control[:, :1]).max(axis=(1, 2)) > 0)
    if not len(long):
        return []
    arriving = curve.tangents_at(long[:-1], np.ones(len(long) - 1))
    leaving = curve.tangents_at(long[1:], np.zeros(len(long) - 1))
    corners = np.flatnonzero(np.linalg.norm(leaving - arriving, axis=1) > _CORNER) + 1
    return list(np.split(long, corners))


def _first_heading(curve: Curve, legs: list[Indices], faces_its_way: bool) -> float:
    if not (faces_its_way and legs):
        return 0.0
    return float(_headings(curve.tangents_at(legs[0][:1], np.zeros(1)), 0.0)[0])


def _headings(tangents: Floats, before: float) -> Floats:
    """Directions over ground without jumps, the first near `before`; straight up and down the last one stays."""
    over_ground = np.hypot(tangents[:, 0], tangents[:, 1]) > 1e-9
    angles = np.arctan2(tangents[:, 1], tangents[:, 0])
    last = np.maximum.accumulate(np.where(over_ground, np.arange(len(angles)), -1))
    known = np.where(last < 0, before, angles[np.maximum(last, 0)])
    return np.unwrap(np.concatenate([[before], known]))[1:]


def _rest(position: Floats, heading: float) -> Trajectory:
    still = np.zeros((1, len(position)))
    return Trajectory(np.zeros(1), position[None], np.array([heading]), still, np.zeros(1))


def _turned(position: Floats, start: float, end: float, limits: Limits) -> Trajectory:
    """A turn on the spot: faster, even, slower."""
    angle, top, gain = abs(end - start), limits.spot_yaw_rate, limits.yaw_acceleration_radps2
    peak = min(top, math.sqrt(angle * gain) if angle else 0.0)
    if angle == 0 or math.isinf(peak):
        return joined([_rest(position, start), _rest(position, end)])
    ramp = peak / gain
    whole = angle / peak + ramp
    turned = np.array([0.0, peak * ramp / 2, angle - peak * ramp / 2, angle])
    sign = math.copysign(1.0, end - start)
    return Trajectory(
        np.array([0.0, ramp, max(ramp, whole - ramp), whole]),
        np.repeat(position[None], 4, axis=0),
        start + sign * turned,
        np.zeros((4, len(position))),
        sign * np.array([0.0, peak, peak, 0.0]),
    )


def _driven(
    curve: Curve, leg: Indices, limits: Limits, heading: float, faces_its_way: bool, step_m: float
) -> Trajectory:
    """One leg, from its first place to its last."""
    which, parts = _places(curve, leg, step_m)
    way = curve.arc_lengths(which, parts)
    turning = _turning(curve, which, parts, limits) if faces_its_way else np.zeros(len(way))
    which, way, turning = _with_settling(curve.straight, which, way, turning)
    parts = curve.parts_at(which, way)
    bend = np.abs(curve.curvature_at(which, parts))
    squares = _squares(way, bend, np.abs(turning), limits)
    which, way, squares, turning = _with_cruising(curve.straight, (which, way, squares, turning), limits)
    speeds = np.sqrt(squares)
    parts = curve.parts_at(which, way)
    tangents = curve.tangents_at(which, parts)
    steps = np.diff(way)
    spans = np.where(steps > 0, 2 * steps / np.where(steps > 0, speeds[:-1] + speeds[1:], 1.0), 0.0)
    motion = Trajectory(
        np.concatenate([[0.0], np.cumsum(spans)]),
        curve.points_at(which, parts),
        _headings(tangents, heading) if faces_its_way else np.full(len(way), heading),
        tangents * speeds[:, None],
        turning * speeds,
    )
    bent = (~curve.straight[which[:-1]]) & (which[:-1] == which[1:])
    return motion.slower(max(1.0, _excess(motion, bent, limits)))


def _places(curve: Curve, leg: Indices, step_m: float) -> tuple[Indices, Floats]:
    """Segments and parameters at which speeds are computed: the ends of straight segments, and all along bends."""
    dense = np.linspace(0.0, 1.0, 129)
    parts = []
    for k in leg:
        if curve.straight[k]:
            parts.append(np.array([0.0, 1.0]))
            continue
        same = np.full(len(dense), k)
        ways = np.diff(curve.arc_lengths(same, dense))
        turns = np.linalg.norm(np.diff(curve.tangents_at(same, dense), axis=0), axis=1)
        even = np.concatenate([[0.0], np.cumsum(ways / step_m + turns / _TURN_STEP)])
        count = max(_LEAST_PIECES, math.ceil(even[-1]))
        parts.append(np.interp(np.linspace(0.0, even[-1], count + 1), even, dense))
    return np.repeat(leg, [len(part) for part in parts]), np.concatenate(parts)


def _turning(curve: Curve, which: Indices, parts: Floats, limits: Limits) -> Floats:
    """Radians a metre; between two segments their mean where the yaw rate cannot jump."""
    turning = curve.turning_at(which, parts)
    if math.isfinite(limits.yaw_acceleration_radps2):
        first = np.flatnonzero(np.diff(which))
        turning[first] = turning[first + 1] = (turning[first] + turning[first + 1]) / 2
    return turning


def _with_settling(
    straight: npt.NDArray[np.bool_], which: Indices, way: Floats, turning: Floats
) -> tuple[Indices, Floats, Floats]:
    """The same places, and on straight segments beside bends those between which the yaw rate is 0.

    A heading that begins a straight segment with a yaw rate and ends it as it began swings out by 4 / 27 of the angle
    that the rate alone would make, however long the segment is.
    """
    at: list[int] = []
    more: list[float] = []
    for k in np.flatnonzero(straight[which[:-1]] & (which[:-1] == which[1:])):
        first, last = np.minimum(_ratio(_SWING * 27 / 4, np.abs(turning[k : k + 2])), (way[k + 1] - way[k]) / 3)
        inside = [way[k] + first] * bool(turning[k]) + [way[k + 1] - last] * bool(turning[k + 1])
        at += [int(k) + 1] * len(inside)
        more += inside
    return np.insert(which, at, which[np.array(at, dtype=np.intp)]), np.insert(way, at, more), np.insert(turning, at, 0)


def _squares(way: Floats, bend: Floats, turning: Floats, limits: Limits) -> Floats:
    """Squared speeds at places along a leg: bounded at each, then forward, then backward."""
    most = fastest_translation(limits.speed_mps, turning, limits.track_m) ** 2
    most = np.minimum(most, _ratio(limits.yaw_rate_radps, turning) ** 2)
    most = np.minimum(most, _ratio(BENDS_SHARE * limits.acceleration_mps2, bend))
    steps = np.diff(way)
    winding = np.abs(np.diff(turning)) / np.where(steps > 0, steps, np.inf)
    swing = _ratio(limits.yaw_acceleration_radps2 / 2, winding)
    most = np.minimum(most, np.minimum(np.append(swing, np.inf), np.append(np.inf, swing)))
    for end in (0, -1):
        if math.isfinite(limits.acceleration_mps2) or (math.isfinite(limits.yaw_acceleration_radps2) and turning[end]):
            most[end] = 0.0
    across = np.where(bend > 0, bend * most, 0.0)
    if math.isfinite(limits.acceleration_mps2):
        along = np.sqrt(limits.acceleration_mps2**2 - np.maximum(across[:-1], across[1:]) ** 2)
    else:
        along = np.full(len(steps), math.inf)
    along = np.minimum(along, _ratio(limits.yaw_acceleration_radps2 / 2, np.maximum(turning[:-1], turning[1:])))
    gains = np.where(steps > 0, 2 * along * np.where(steps > 0, steps, 1.0), 0.0).tolist()
    squares = most.tolist()
    for k, gain in enumerate(gains):
        squares[k + 1] = min(squares[k + 1], squares[k] + gain)
    for k in range(len(gains) - 1, -1, -1):
        squares[k] = min(squares[k], squares[k + 1] + gains[k])
    return np.array(squares)


def _ratio(limit: float, of: Floats) -> Floats:
    """Limit / of, and inf where `of` is 0."""
    return np.where(of > 0, limit / np.where(of > 0, of, 1.0), np.inf)


Places = tuple[Indices, Floats, Floats, Floats]


def _with_cruising(straight: npt.NDArray[np.bool_], places: Places, limits: Limits) -> Places:
    """The same places, and on straight segments those at which the top speed is reached and left."""
    which, way, squares, turning = places
    gain, top = 2 * limits.acceleration_mps2, limits.speed_mps**2
    at: list[int] = []
    more: list[tuple[float, float]] = []
    for k in np.flatnonzero(straight[which[:-1]] & (which[:-1] == which[1:])) if math.isfinite(gain) else ():
        first, last, length = squares[k], squares[k + 1], way[k + 1] - way[k]
        peak = min(top, (first + last + gain * length) / 2)
        reached = way[k] + (peak - first) / gain
        left = way[k + 1] - (peak - last) / gain
        inside = sorted({place for place in (reached, left) if way[k] < place < way[k + 1]})
        at += [int(k) + 1] * len(inside)
        more += [(place, peak) for place in inside]
    new = np.array(more).reshape(-1, 2)
    return (
        np.insert(which, at, which[np.array(at, dtype=np.intp)]),
        np.insert(way, at, new[:, 0]),
        np.insert(squares, at, new[:, 1]),
        np.insert(turning, at, 0.0),
    )


def _excess(motion: Trajectory, bent: npt.NDArray[np.bool_], limits: Limits) -> float:
    """The factor by which the motion is too fast on bends, where its cubics differ from the motion that was planned."""
    spans = np.diff(motion.times)
    k = np.flatnonzero(bent & (spans > 0))
    if not len(k):
        return 0.0
    span = spans[k, None]
    rates = []
    for values, ends in ((motion.positions, motion.velocities), (motion.headings[:, None], motion.yaw_rates[:, None])):
        middle = 3 * (values[k + 1] - values[k]) / span - ends[k] - ends[k + 1]
        rates.append(np.stack([ends[k], middle, ends[k + 1]]))
    speed, yaw_rate = (np.linalg.norm(rate, axis=2) for rate in rates)
    gain, yaw_gain = (2 * np.linalg.norm(np.diff(rate, axis=0), axis=2) / span[:, 0] for rate in rates)
    worst = max(
        (speed + yaw_rate * limits.track_m / 2).max() / limits.speed_mps,
        yaw_rate.max() / limits.yaw_rate_radps,
        math.sqrt(gain.max() / limits.acceleration_mps2),
        math.sqrt(yaw_gain.max() / limits.yaw_acceleration_radps2),
    )
    return float(worst)
