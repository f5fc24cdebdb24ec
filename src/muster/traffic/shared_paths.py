"""Paths in metres and seconds of several robots that share the free space of a map, without contact.

The map is divided into square cells, one robot a cell, and the paths are found by `space_time`. Robots that move at
once between cells come no nearer to each other than 1 / sqrt(5) of a cell where they may go diagonally (one towards the
cell that another leaves at a right angle), and 1 / sqrt(2) of it where they may not. So a cell has at least sqrt(5) or
sqrt(2) times the widest robot's diameter.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np

from muster.mission.errors import ParameterError
from muster.mission.values.arrays import Floats
from muster.mission.values.ranges import require_finite_positive
from muster.motion.free_space import GridSpace, PolygonSpace, Space
from muster.motion.grid import Grid
from muster.motion.maps.raster import grid_of
from muster.motion.metrics import closest
from muster.motion.paths import PathFinder
from muster.traffic.reservations import Cell
from muster.traffic.space_time import NotTogether, Parameters, together

Ends = Mapping[str, tuple[Sequence[float], Sequence[float]]]
_DIAGONAL, _STRAIGHT = math.sqrt(5), math.sqrt(2)
_CELLS_OF_POINTS = 60
"""Cells along a map for robots without a radius."""


@dataclass(frozen=True, eq=False)
class SharedPaths:
    """What all robots do.

    Parameters
    ----------
    robots
        their ids.
    times_s
        (k,) seconds.
    positions
        (k, n, 2) metres in the map frame; between two times robots move straight and evenly.
    cell_m, neighbours
        of the grid.
    """

    robots: tuple[str, ...]
    times_s: Floats
    positions: Floats
    cell_m: float
    neighbours: int

    def lengths_m(self) -> Floats:
        """(n,)."""
        return np.asarray(np.linalg.norm(np.diff(self.positions, axis=0), axis=2).sum(axis=0))

    def arrivals_s(self) -> Floats:
        """When each is at its goal for good: (n,)."""
        moved = (np.diff(self.positions, axis=0) != 0).any(axis=2)
        last = len(moved) - np.argmax(moved[::-1], axis=0)
        return np.asarray(self.times_s[np.where(moved.any(axis=0), last, 0)])

    def least_distance_m(self) -> float:
        """Between any two centres at any time; inf for one robot."""
        return math.inf if len(self.robots) < 2 else closest(self.times_s, self.positions).distance_m


def shared_paths(
    space: Space,
    ends: Ends,
    *,
    radius_m: float,
    speed_mps: float = 1.0,
    cell_m: float | None = None,
    seed: int = 0,
    params: Parameters | None = None,
) -> SharedPaths | NotTogether:
    """Paths for robots with a start and a goal each, (2,) metres in the map frame, which stay at their goals.

    Parameters
    ----------
    space
        free for the widest robot, in the plane.
    radius_m, speed_mps
        of the widest robot, and of the slowest.
    cell_m
        side of a cell; by default the least with diagonal moves. A smaller one allows straight moves only.

    Raises
    ------
    ParameterError
        for a space with heights, a cell that is too small for the robots, or two robots with one end.
    """
    if not isinstance(space, GridSpace | PolygonSpace):
        raise ParameterError("space: with heights; expected the plane: robots of one height share it")
    require_finite_positive(speed_mps=speed_mps)
    cell, neighbours = _cell(space, radius_m, cell_m)
    grid = _cells(space, cell)
    finder = PathFinder(space)
    taken: dict[str, tuple[Cell, Cell]] = {}
    for robot, (start, goal) in ends.items():
        pair = [
            _cell_of(grid, finder, np.asarray(point[:2], dtype=float), {used[k] for used in taken.values()})
            for k, point in enumerate((start, goal))
        ]
        if pair[0] is None or pair[1] is None:
            what = "start" if pair[0] is None else "goal"
            return NotTogether(robot, f"no free cell of {grid.resolution_m:g} m is beside its {what}")
        taken[robot] = (pair[0], pair[1])
    found = together(grid.blocked, taken, seed=seed, params=replace(params or Parameters(), neighbours=neighbours))
    if isinstance(found, NotTogether):
        return NotTogether(found.robot, f"{found.reason} (cells of {grid.resolution_m:g} m)")
    paths = _in_metres(found, grid, ends, neighbours, speed_mps)
    return _apart(paths, 2 * radius_m) or paths


def _apart(paths: SharedPaths, least_m: float) -> NotTogether | None:
    """Who touches another between an end and its cell, where robots need not be a cell apart."""
    if len(paths.robots) < 2 or paths.least_distance_m() >= least_m - 1e-9:
        return None
    one, other = closest(paths.times_s, paths.positions).pair
    return NotTogether(paths.robots[one], f"too near to {paths.robots[other]} between its start or goal and its cell")


def _cell(space: GridSpace | PolygonSpace, radius_m: float, cell_m: float | None) -> tuple[float, int]:
    """The side of a cell, and how many neighbours it has."""
    straight, diagonal = 2 * radius_m * _STRAIGHT, 2 * radius_m * _DIAGONAL
    if cell_m is None:
        cell_m = diagonal or _extent(space) / _CELLS_OF_POINTS
    if not (cell_m > 0 and cell_m >= straight):
        raise ParameterError(
            f"cell_m: {cell_m:g}; expected at least {straight:.3f}, for robots of radius {radius_m:g} m"
        )
    return cell_m, 8 if cell_m >= diagonal else 4


def _extent(space: GridSpace | PolygonSpace) -> float:
    if isinstance(space, GridSpace):
        return max(space.grid.shape) * space.grid.resolution_m
    west, south, east, north = space.region.bounds
    return float(max(east - west, north - south))


def _cells(space: GridSpace | PolygonSpace, cell_m: float) -> Grid:
    """Cells that are free as a whole; of a map of cells a whole number of its cells each."""
    if isinstance(space, PolygonSpace):
        return grid_of(space, cell_m)
    fine = space.grid
    k = max(1, math.ceil(cell_m / fine.resolution_m - 1e-9))
    rows, columns = (-(-size // k) for size in fine.shape)
    padded = np.ones((rows * k, columns * k), dtype=np.bool_)
    padded[: fine.shape[0], : fine.shape[1]] = fine.blocked
    blocked = np.asarray(padded.reshape(rows, k, columns, k).any(axis=(1, 3)), dtype=np.bool_)
    return Grid(blocked, fine.resolution_m * k, fine.origin)


def _cell_of(grid: Grid, finder: PathFinder, point: Floats, taken: set[Cell]) -> Cell | None:
    """The free cell whose centre is nearest to a point, in sight and not taken; within two cells."""
    free = np.argwhere(~grid.blocked)
    centres = grid.to_map(free[:, ::-1].astype(np.float64) + 0.5)
    away = np.linalg.norm(centres - point, axis=1)
    for k in np.argsort(away, kind="stable"):
        cell = (int(free[k, 0]), int(free[k, 1]))
        if away[k] > 2 * grid.resolution_m:
            return None
        if cell not in taken and finder.clear(np.stack([point, centres[k]])):
            return cell
    return None


def _in_metres(
    ways: Mapping[str, list[Cell]], grid: Grid, ends: Ends, neighbours: int, speed_mps: float
) -> SharedPaths:
    """Centres of cells, a step each, between the very ends; a step lasts as long as its longest move."""
    tracks = []
    for robot, way in ways.items():
        centres = grid.to_map(np.array([*way, way[-1]])[:, ::-1] + 0.5)
        start, goal = (np.asarray(end[:2], dtype=np.float64) for end in ends[robot])
        there = len(way) - next((k for k, cell in enumerate(reversed(way)) if cell != way[-1]), len(way))
        centres[there + 1 :] = goal
        tracks.append(np.concatenate([start[np.newaxis], centres]))
    positions = np.stack(tracks, axis=1)
    longest = np.linalg.norm(np.diff(positions, axis=0), axis=2).max(axis=1)
    times = np.concatenate([[0.0], np.cumsum(longest / speed_mps)])
    return SharedPaths(tuple(ways), times, positions, grid.resolution_m, neighbours)
