"""How well a robot kept to its reference: [market-paper], section 4.2, (7) and (8), and section 5.

The reference is the way of the path finder, its corners rounded by cubic Bezier splines (section 3.2), from the robot's
start to its tasks in order. Robots are sent the way points of the path finder: they round corners as they can.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from functools import cache
from itertools import pairwise

import numpy as np

from muster.motion.grid import Floats
from muster.motion.kinematics.registry import turning_radius_of
from muster.motion.map_world import body_of
from muster.motion.metrics import closest, path_length, risk_factor, trajectory_error
from muster.motion.path import NoPath
from muster.motion.paths.robot_paths import RobotPaths
from muster_studies.rescue.flights import FlightResult
from muster_studies.rescue.teams import mission_of

SAMPLE_M = 0.01
"""Between two points of the reference."""


@dataclass(frozen=True, kw_only=True)
class Tracking:
    """Of one robot in one flight, metres but for the last.

    Parameters
    ----------
    goal_error
        the greatest distance from a survivor at which its work ended.
    mean_error, greatest_error
        (7) between points of the reference and where the robot was at the same share of its way to the same survivor.
    mean_aside, greatest_aside
        cross-track: to the nearest point of the reference, from the places of (7), and from those of every step.
    reference_m, flown_m
        lengths.
    odometry_off
        metres that the robot says it has travelled, less those that it has.
    obstacle, robot
        least distance of its centre to an obstacle or the boundary, and to the centre of another robot.
    risk
        (8) over the points of (7), 1/m.
    """

    goal_error: float
    mean_error: float
    greatest_error: float
    mean_aside: float
    greatest_aside: float
    reference_m: float
    flown_m: float
    odometry_off: float
    obstacle: float
    robot: float
    risk: float


@cache
def _robot_paths(team: str) -> RobotPaths:
    return RobotPaths.of(mission_of(team))


@cache
def legs(team: str, robot: str, tasks: tuple[str, ...]) -> tuple[Floats, ...]:
    """The reference to each task in order: (k, 2) metres, evenly along it."""
    mission, robot_paths = mission_of(team), _robot_paths(team)
    (mover,) = (one for one in mission.robots if one.id == robot)
    body, radius_m = body_of(mover), turning_radius_of(mover)
    starts = {one.id: one.position for one in mission.robots}
    places = {task.id: task.position for task in mission.tasks}
    found = []
    for start, goal in pairwise([starts[robot], *(places[task] for task in tasks)]):
        path = robot_paths.path(body, start, goal)
        assert not isinstance(path, NoPath)  # it was planned
        curve = robot_paths.smoothed(body, path, radius_m).curve
        found.append(curve.points(np.linspace(0.0, curve.length_m, math.ceil(curve.length_m / SAMPLE_M) + 1)))
    return tuple(found)


def track(flown: FlightResult, robot: str) -> Floats:
    """Where the robot was until its last work ended: (k, 2), every step."""
    return flown.positions[: _steps(flown, robot)[-1] + 1, _index(flown, robot)]


def tracks(flown: FlightResult, robot: str) -> tuple[Floats, ...]:
    """The same for each of its tasks in turn, the way there and the work, both ends included."""
    whole = track(flown, robot)
    return tuple(whole[first : last + 1] for first, last in pairwise(_steps(flown, robot)))


def _steps(flown: FlightResult, robot: str) -> list[int]:
    """At which steps the robot began, and ended each work."""
    ends = np.array([0.0, *(visit.ends_s for visit in flown.visits[robot])])
    found: list[int] = np.searchsorted(flown.times, ends - _ROUNDING_S).tolist()
    return found


_ROUNDING_S = 1e-6


def deviations(reference: Sequence[Floats], way: Floats) -> Floats:
    """Cross-track: metres (n,) from places (n, 2) to the nearest of the reference."""
    import shapely  # an extra, whose presence the map has checked

    line = shapely.LineString(np.concatenate(list(reference)))
    return np.asarray(shapely.distance(line, shapely.points(way)), dtype=np.float64)


def tracking(team: str, flown: FlightResult, robot: str) -> Tracking:
    """Measure one robot, which did at least one task."""
    ways, index = tracks(flown, robot), _index(flown, robot)
    reference = legs(team, robot, tuple(visit.task for visit in flown.visits[robot]))
    matched = [at_same_shares(one, way) for one, way in zip(reference, ways, strict=True)]
    error = trajectory_error(np.concatenate(reference), np.concatenate(matched))
    whole = track(flown, robot)
    world = _robot_paths(team).world
    others = [k for k in range(flown.positions.shape[1]) if k != index]
    return Tracking(
        goal_error=max(math.dist(way[-1], one[-1]) for one, way in zip(reference, ways, strict=True)),
        mean_error=error.mean,
        greatest_error=error.most,
        mean_aside=float(deviations(reference, np.concatenate(matched)).mean()),
        greatest_aside=float(deviations(reference, whole).max()),
        reference_m=sum(path_length(one) for one in reference),
        flown_m=path_length(flown.positions[:, index]),
        odometry_off=flown.last_words[robot].odometry_m - path_length(flown.positions[:, index]),
        obstacle=float(world.clearance(whole, "ground").min()),
        robot=min(closest(flown.times, flown.positions[:, [index, k]]).distance_m for k in others),
        risk=risk_factor(world.clearance(np.concatenate(matched), "ground")),
    )


def at_same_shares(reference: Floats, way: Floats) -> Floats:
    """Where a robot was at the shares of its way at which the points of the reference lie, evenly."""
    along = np.concatenate([[0.0], np.cumsum(np.linalg.norm(np.diff(way, axis=0), axis=1))])
    asked = np.linspace(0.0, along[-1], len(reference))
    return np.column_stack([np.interp(asked, along, way[:, axis]) for axis in range(2)])


def _index(flown: FlightResult, robot: str) -> int:
    return list(flown.visits).index(robot)
