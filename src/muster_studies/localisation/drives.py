"""Drives over the floor plan: where a robot truly is, what its odometry counts, and what its laser measures.

The mission is `floor`. A robot drives shortest paths between random places; its odometry and its laser err.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass, replace
from functools import cache

import numpy as np

from muster.mission.model import Robot
from muster.motion.frames import wrapped
from muster.motion.grid import Floats
from muster.motion.map_world import body_of
from muster.motion.path import NoPath
from muster.motion.paths.robot_paths import RobotPaths
from muster.motion.port import Waypoint
from muster.perception.laser import Scanner
from muster.simulation import KinematicWorld
from muster.simulation.map_scans import ScannedMap
from muster_studies.runs import mission_named

MISSION = "floor"
SCAN_S = 0.5
"""Seconds between scans."""
SCANNER = Scanner(reach_m=8.0, step_rad=math.radians(1), range_m=0.02)
SLIP = 0.05
"""Standard deviation of the share of its way by which odometry errs between two scans."""
TURN_RAD = 0.01
"""Standard deviation of the turn between two scans while the robot drives."""


@dataclass(frozen=True, eq=False)
class Reading:
    """What happened since the last scan.

    Parameters
    ----------
    time_s
        since the beginning.
    poses
        (n, 3): where robots truly are, x, y in metres and heading in radians.
    moves
        (n, 3): by how much they moved by odometry, metres ahead and to the left, and radians, in their frames before.
    ranges
        (n, m): scans of the lasers.
    """

    time_s: float
    poses: Floats
    moves: Floats
    ranges: Floats


@cache
def floor_paths() -> RobotPaths:
    """The floor plan."""
    return RobotPaths.of(mission_named(MISSION))


@cache
def scanned_floor() -> ScannedMap:
    """The floor plan as the laser of a rover sees it."""
    return ScannedMap.of(floor_paths().world, body_of(rover()))


def rover() -> Robot:
    """The robot that drives."""
    return mission_named(MISSION).robots[0]


def drive(starts: Floats, until_s: float, seed: int) -> Iterator[Reading]:
    """Rovers that start at poses (n, 3) and drive to random places, one after the other, until a time."""
    random = np.random.default_rng((seed, 1))
    mission = mission_named(MISSION)
    rovers = tuple(
        replace(rover(), id=f"rover{k}", position=(float(x), float(y)), heading_deg=math.degrees(heading))
        for k, (x, y, heading) in enumerate(starts)
    )
    world = KinematicWorld(replace(mission, robots=rovers, tasks=(), events=()), seed=seed, avoidance="orca")
    poses = _poses(world)
    yield Reading(0.0, poses, np.zeros_like(poses), _scans(world, random))
    while world.time_s < until_s - 1e-9:
        for k, robot in enumerate(rovers):
            if world.idle(robot.id):
                world.ports[robot.id].send(_way((float(poses[k, 0]), float(poses[k, 1])), random))
        world.advance(world.time_s + SCAN_S)
        before, poses = poses, _poses(world)
        yield Reading(world.time_s, poses, _odometry(before, poses, random), _scans(world, random))


def _way(start: tuple[float, float], random: np.random.Generator) -> list[Waypoint]:
    """The shortest path to a random place that can be reached."""
    while True:
        found = floor_paths().path(body_of(rover()), start, tuple(scanned_floor().anywhere(random, 1)[0, :2]))
        if not isinstance(found, NoPath):
            return [Waypoint((float(x), float(y), 0.0)) for x, y in found.points[1:]]


def _poses(world: KinematicWorld) -> Floats:
    return np.column_stack([world.positions[:, :2], world.headings])


def _scans(world: KinematicWorld, random: np.random.Generator) -> Floats:
    return np.array([SCANNER.measured(world.scan(robot, SCANNER), random) for robot in world.ports])


def _odometry(before: Floats, after: Floats, random: np.random.Generator) -> Floats:
    """Moves (n, 3) with errors; a robot that stands counts nothing."""
    east, north = (after[:, :2] - before[:, :2]).T
    c, s = np.cos(before[:, 2]), np.sin(before[:, 2])
    turn = wrapped(after[:, 2] - before[:, 2])
    drives = np.hypot(east, north) > 0
    share = 1 + random.normal(0.0, SLIP, len(before))
    turned = turn + random.normal(0.0, TURN_RAD, len(before)) * drives
    return np.column_stack([share * (c * east + s * north), share * (c * north - s * east), turned])
