"""Table `planners`: the path planners that [tcf-thesis], section 2.2, reviews, between random places of maps."""

from __future__ import annotations

import math
import time
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from functools import cache
from statistics import fmean, median
from typing import Any

import numpy as np

from muster.motion.free_space import GridSpace, Space
from muster.motion.grid import Floats
from muster.motion.maps.free_points import free
from muster.motion.path import NoPath
from muster.motion.paths import PLANNERS, find
from muster.motion.paths.dubins import Parameters as DubinsParameters
from muster.motion.paths.robot_paths import RobotPaths
from muster_studies.effort import Effort
from muster_studies.runs import mission_named
from muster_studies.tables import Cell, Table
from muster_studies.thesis_2.samples import half_interval

MISSIONS = ("floor", "depot", "market-rescue-arena")
SEEDS, QUICK_SEEDS = 30, 2
TURNING_RADII = 2.0
"""The turning radius of `dubins`, in radii of the robot."""


@dataclass(frozen=True)
class FoundPath:
    """The result of one search.

    Parameters
    ----------
    excess
        the share by which the path is longer than the shortest one; None where none was found.
    cpu_s
        processor time.
    sharpest_rad
        the greatest turn between two pieces of the path.
    """

    excess: float | None
    cpu_s: float
    sharpest_rad: float


@dataclass(frozen=True)
class PathSearch:
    """A path between two random places of a map, which are connected."""

    mission: str
    planner: str
    seed: int

    def measured(self) -> FoundPath:
        """Search it; the shortest path is known before."""
        space, radius_m = space_of(self.mission)
        start, goal, shortest_m = ends(self.mission, self.seed)
        params = DubinsParameters(turning_radius_m=TURNING_RADII * radius_m) if self.planner == "dubins" else None
        begin = time.process_time()
        path = find(space, start, goal, planner=self.planner, seed=self.seed, params=params)
        cpu_s = time.process_time() - begin
        if isinstance(path, NoPath):
            return FoundPath(None, cpu_s, 0.0)
        return FoundPath(path.length_m / shortest_m - 1, cpu_s, _sharpest_rad(path.points))


@cache
def space_of(mission: str) -> tuple[Space, float]:
    """The free space of the first robot of a mission, and its radius."""
    loaded = mission_named(mission)
    robot = loaded.robots[0]
    world = RobotPaths.of(loaded).world
    return world.free_space(robot.radius_m, robot.kind, three_d=False), robot.radius_m


@cache
def ends(mission: str, seed: int) -> tuple[Floats, Floats, float]:
    """Two random places with a path between them, and the length of the shortest."""
    space, _ = space_of(mission)
    random = np.random.default_rng(seed)
    low, high = _bounds(space)
    while True:
        start, goal = random.uniform(low, high, (2, 2))
        if free(space, np.array([start, goal])).all():
            path = find(space, start, goal)
            if not isinstance(path, NoPath) and path.length_m > 0:
                return start, goal, path.length_m


def _bounds(space: Space) -> tuple[Floats, Floats]:
    if isinstance(space, GridSpace):
        rows, columns = space.grid.shape
        corners = space.grid.to_map(np.array([[0.0, 0.0], [columns, 0.0], [0.0, rows], [columns, rows]]))
        return corners.min(axis=0), corners.max(axis=0)
    west, south, east, north = space.region.bounds
    return np.array([west, south]), np.array([east, north])


def _sharpest_rad(points: Floats) -> float:
    """The greatest turn of a path (n, 2) at a corner."""
    pieces = np.diff(points, axis=0)
    pieces = pieces[np.linalg.norm(pieces, axis=1) > 1e-9]
    headings = np.arctan2(pieces[:, 1], pieces[:, 0])
    turns = np.abs((np.diff(headings) + math.pi) % (2 * math.pi) - math.pi)
    return float(turns.max(initial=0.0))


@dataclass(frozen=True)
class PathPlanners:
    """A row for each planner, over all maps and seeds."""

    number: str = "planners"

    def jobs(self, effort: Effort) -> Iterable[PathSearch]:
        return [PathSearch(m, name, seed) for m in MISSIONS for name in PLANNERS for seed in range(_seeds(effort))]

    def table(self, effort: Effort, found: Mapping[Any, Any]) -> Table:
        rows: list[tuple[Cell, ...]] = []
        for name in PLANNERS:
            results = [found[job] for job in self.jobs(effort) if job.planner == name]
            excesses = [100 * one.excess for one in results if one.excess is not None]
            if not excesses:
                rows.append((name, len(results), 0, None, None, None, None, None))
                continue
            turns = [math.degrees(one.sharpest_rad) for one in results if one.excess is not None]
            times = [1000 * one.cpu_s for one in results]
            spread = half_interval(excesses)
            row = (len(results), len(excesses), fmean(excesses), spread, max(excesses), median(turns), median(times))
            rows.append((name, *row))
        columns = ("planner", "searches", "found", "longer %", "+-", "worst %", "sharpest turn", "median ms")
        notes = (
            f"Between random connected places of {', '.join(MISSIONS)}, {_seeds(effort)} of each, for the first robot. "
            "longer: than the shortest path, mean of the paths found, with half the 95 % interval of the mean. "
            "sharpest turn: of a path at a corner, degrees, median; dubins keeps a turning radius of "
            f"{TURNING_RADII:g} radii of the robot and its corners are those of points along its arcs. ms: processor "
            "time of this machine.",
        )
        return Table(self.number, "Path planners beside the shortest path", columns, tuple(rows), notes)


def _seeds(effort: Effort) -> int:
    return effort.seeds or (QUICK_SEEDS if effort.quick else SEEDS)
