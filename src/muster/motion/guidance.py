"""Guidance along a path by pursuit of a point that keeps ahead of the robot ([tcf-thesis], section 2.2.1).

A robot heads for the point by the azimuth (2.15) and the elevation (2.16). Where the point is, the law says:

- `pure-pursuit` [coulter1992]: on the path, a lookahead beyond the place that is nearest to the robot;
- `virtual-target`: a target that flies along the path at the robot's speed; the robot pursues it at a speed in
  proportion to its range, and so follows at the lookahead without intercepting it;
- `synthetic-waypoint`: a way point that moves by (2.17) along the course of the leg it is on, as soon as the robot is
  nearer to it than the least range, which is the lookahead.

(2.17) is printed with -sin of the course for the height; that is -sin of the climb angle, z being downward. Here z is
upward. The arctangents are taken by quadrant.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, field
from types import MappingProxyType
from typing import Protocol

import numpy as np

from muster.mission.values.arrays import Floats
from muster.mission.values.keywords import require_one_of
from muster.mission.values.ranges import require_finite_positive
from muster.motion.kinematics.kinematics import Kinematics, approach
from muster.motion.limits import Limits
from muster.motion.path import Path

_SETTLING_S = 1.0
"""Within this many seconds of the goal a robot slows down."""


def pursuit_angles(place: Floats, target: Floats) -> tuple[float, float]:
    """The azimuth (2.15) and the elevation (2.16) from a place (3,) to a target (3,), radians."""
    east, north, up = target - place
    return math.atan2(north, east), math.atan2(up, math.hypot(east, north))


def synthetic_waypoint(before: Floats, speed_mps: float, course_rad: float, climb_rad: float, dt: float) -> Floats:
    """(2.17): the way point (3,) after `dt` seconds along a course and a climb angle."""
    level = math.cos(climb_rad)
    direction = [level * math.cos(course_rad), level * math.sin(course_rad), math.sin(climb_rad)]
    return before + speed_mps * dt * np.array(direction)


class Line:
    """A path in space by the length along it."""

    def __init__(self, path: Path) -> None:
        points = np.asarray(path.points, dtype=np.float64)
        if points.shape[1] == 2:
            points = np.column_stack([points, np.zeros(len(points))])
        legs = np.linalg.norm(np.diff(points, axis=0), axis=1)
        self.points = np.concatenate([points[:1], points[1:][legs > 0]])
        self.along = np.concatenate([[0.0], np.cumsum(legs[legs > 0])])

    @property
    def length_m(self) -> float:
        return float(self.along[-1])

    def at(self, along: float) -> Floats:
        """The point (3,) at a length from the start."""
        return np.array([np.interp(along, self.along, axis) for axis in self.points.T])

    def leg(self, along: float) -> int:
        """The number of the leg on which a length lies."""
        return int(np.clip(np.searchsorted(self.along, along, side="right") - 1, 0, len(self.along) - 2))

    def nearest(self, place: Floats, begin: float, end: float) -> float:
        """The length, between two of them, at which the path is nearest to a place (3,)."""
        first, last = self.leg(begin), self.leg(end)
        starts, ways = self.points[first : last + 1], np.diff(self.points[first : last + 2], axis=0)
        shares = np.clip(((place - starts) * ways).sum(axis=1) / (ways**2).sum(axis=1), 0.0, 1.0)
        off = np.linalg.norm(starts + shares[:, None] * ways - place, axis=1)
        k = int(np.argmin(off))
        within = self.along[first + k] + shares[k] * np.linalg.norm(ways[k])
        return float(np.clip(within, begin, end))

    def off(self, places: Floats) -> Floats:
        """How far places (n, 3) are from the path: (n,)."""
        starts, ways = self.points[:-1], np.diff(self.points, axis=0)
        shares = ((places[:, None] - starts) * ways).sum(axis=2) / (ways**2).sum(axis=1)
        nearest = starts + np.clip(shares, 0.0, 1.0)[..., None] * ways
        return np.asarray(np.linalg.norm(places[:, None] - nearest, axis=2).min(axis=1))


class Target(Protocol):
    """The point that a robot pursues. `along` is where on the path it is; one instance serves one run."""

    along: float

    def moved(self, place: Floats, dt: float) -> Floats:
        """The point (3,) after `dt` more seconds, the robot being at `place`."""

    def speed(self, place: Floats) -> float:
        """The speed at which the robot pursues it, m/s."""


@dataclass
class PurePursuit:
    """The point a lookahead beyond the place of the path nearest to the robot."""

    line: Line
    lookahead_m: float
    speed_mps: float
    along: float = 0.0
    passed: float = field(default=0.0, init=False)

    def moved(self, place: Floats, dt: float) -> Floats:
        self.passed = self.line.nearest(place, self.passed, self.passed + self.lookahead_m)
        self.along = self.passed + self.lookahead_m
        return self.line.at(self.along)

    def speed(self, place: Floats) -> float:
        return self.speed_mps


@dataclass
class VirtualTarget:
    """A target that moves along the path at the robot's own speed, one lookahead before it at the beginning."""

    line: Line
    lookahead_m: float
    speed_mps: float
    along: float = field(default=-1.0, init=False)

    def moved(self, place: Floats, dt: float) -> Floats:
        begun = self.along >= 0
        self.along = self.along + self.speed_mps * dt if begun else self.lookahead_m
        return self.line.at(self.along)

    def speed(self, place: Floats) -> float:
        away = float(np.linalg.norm(self.line.at(self.along) - place))
        return self.speed_mps * away / self.lookahead_m


@dataclass
class SyntheticWaypoint:
    """A way point that moves along the legs of the path so that it keeps at the least range from the robot."""

    line: Line
    lookahead_m: float
    speed_mps: float
    along: float = 0.0
    point: Floats | None = field(default=None, init=False)

    def moved(self, place: Floats, dt: float) -> Floats:
        if self.point is None:
            self.point = self.line.points[0]
        away = float(np.linalg.norm(self.point - place))
        self._go(self.speed_mps * dt + max(0.0, self.lookahead_m - away) if away <= self.lookahead_m else 0.0)
        return self.point

    def _go(self, length: float) -> None:
        """(2.17) leg by leg."""
        while length > 0 and self.along < self.line.length_m:
            leg = self.line.leg(self.along)
            course, climb = pursuit_angles(*self.line.points[leg : leg + 2])
            part = min(length, self.line.along[leg + 1] - self.along)
            assert self.point is not None
            self.point = synthetic_waypoint(self.point, 1.0, course, climb, part)
            self.along, length = self.along + part, length - part
            if self.along >= self.line.along[leg + 1]:
                self.along, self.point = float(self.line.along[leg + 1]), self.line.points[leg + 1]

    def speed(self, place: Floats) -> float:
        return self.speed_mps


GUIDANCE: Mapping[str, type[PurePursuit] | type[VirtualTarget] | type[SyntheticWaypoint]] = MappingProxyType(
    {"pure-pursuit": PurePursuit, "virtual-target": VirtualTarget, "synthetic-waypoint": SyntheticWaypoint}
)


@dataclass(frozen=True, eq=False)
class Tracked:
    """What a robot drove by a law of guidance.

    Parameters
    ----------
    states
        (k, 4): x, y, z and yaw, one row a step of `dt` seconds.
    cross_track_m
        (k,) distances from the path.
    """

    dt: float
    states: Floats
    cross_track_m: Floats
    arrived: bool

    @property
    def path(self) -> Path:
        return Path(self.states[:, :3])

    @property
    def duration_s(self) -> float:
        return self.dt * (len(self.states) - 1)


def follow(
    path: Path,
    law: str,
    kinematics: Kinematics,
    limits: Limits,
    *,
    lookahead_m: float = 0.5,
    dt: float = 0.05,
    arrival_m: float = 0.05,
) -> Tracked:
    """Drive a robot along a path by a law of `GUIDANCE`, from the start and its first course to the goal.

    It ends within `arrival_m` of the goal, or after four times the time that the path takes at full speed and a minute.

    Raises
    ------
    ParameterError
        for another law, or a number that is not above 0.
    """
    require_one_of("guidance", law, GUIDANCE)
    require_finite_positive(lookahead_m=lookahead_m, dt=dt, arrival_m=arrival_m)
    line = Line(path)
    if line.length_m == 0:
        return Tracked(dt, np.append(line.points[0], 0.0)[np.newaxis], np.zeros(1), True)
    states, arrived = _driven(
        line, GUIDANCE[law](line, lookahead_m, limits.speed_mps), kinematics, limits, dt, arrival_m
    )
    return Tracked(dt, states, line.off(states[:, :3]), arrived)


def _driven(
    line: Line, target: Target, kinematics: Kinematics, limits: Limits, dt: float, arrival_m: float
) -> tuple[Floats, bool]:
    goal, speed = line.points[-1], limits.speed_mps
    state = np.append(line.points[0], pursuit_angles(*line.points[:2])[0])[np.newaxis]
    states, inputs = [state[0]], None
    for _ in range(math.ceil((4 * line.length_m / speed + 60) / dt)):
        place = state[0, :3]
        point = target.moved(place, dt)
        if target.along >= line.length_m:
            wanted = approach((goal - place)[np.newaxis], speed, _SETTLING_S)
        else:
            wanted = _towards(place, point, min(speed, target.speed(place)))
        heading = np.array([pursuit_angles(place, point)[0]])
        steered = kinematics.inputs(state, wanted, heading, limits)
        inputs = kinematics.limited(steered, limits, inputs, dt)
        state = kinematics.step(state, inputs, dt)
        states.append(state[0])
        if target.along >= line.length_m and np.linalg.norm(state[0, :3] - goal) <= arrival_m:
            return np.array(states), True
    return np.array(states), False


def _towards(place: Floats, point: Floats, speed: float) -> Floats:
    """The velocity (1, 3) by (2.15) and (2.16)."""
    azimuth, elevation = pursuit_angles(place, point)
    level = math.cos(elevation)
    return speed * np.array([[level * math.cos(azimuth), level * math.sin(azimuth), math.sin(elevation)]])
