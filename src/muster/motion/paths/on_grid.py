"""Common parts of the planners on a grid: the cells, and the path from a point to their centres."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from muster import core
from muster.mission.errors import ParameterError
from muster.mission.values.arrays import Floats
from muster.mission.values.ranges import require_positive
from muster.motion.free_space import GridSpace, PolygonSpace
from muster.motion.grid import Grid
from muster.motion.maps.raster import grid_of
from muster.motion.path import NoPath, Path
from muster.motion.paths.planner import blocked, disconnected, not_free

_CELLS_ALONG_A_REGION = 500


@dataclass(frozen=True, kw_only=True)
class Parameters:
    """`resolution_m`: side of the cells that a region is divided into; by default a 500th of its longer side."""

    resolution_m: float | None = None

    def __post_init__(self) -> None:
        require_positive(resolution_m=self.resolution_m)


@dataclass(frozen=True)
class Question:
    """Start and goal in cells, on a grid in the core."""

    grid: Grid
    cells: core.GridMap
    start: tuple[float, float]
    goal: tuple[float, float]

    def way(self, *, heuristic: bool, any_angle: bool = False) -> Floats:
        """(k, 2) points in cells: start, centres of cells, goal; empty if there is no way."""
        if set(self.cells.cells_at(self.start)) & set(self.cells.cells_at(self.goal)):
            return np.array([self.start, self.goal])
        found = np.array(self.cells.search(self.start, self.goal, heuristic=heuristic, any_angle=any_angle), dtype=int)
        if found.size == 0:
            return np.empty((0, 2))
        rows, columns = np.divmod(found, self.grid.shape[1])
        centres = np.stack([columns, rows], axis=1) + 0.5
        return np.concatenate([[self.start], centres, [self.goal]])

    def path(self, way: Floats, start: Floats, goal: Floats) -> Path | NoPath:
        """The way in metres, between these very points."""
        if len(way) == 0:
            return disconnected(start, goal)
        points = self.grid.to_map(way)
        points[0], points[-1] = start, goal
        return Path(without_repetitions(points))


def question(space: GridSpace | PolygonSpace, start: Floats, goal: Floats, params: Parameters) -> Question | NoPath:
    """Start and goal on the grid, or which of them is blocked there."""
    reason = blocked(space, start, goal)
    if reason is not None:
        return reason
    grid = space.grid if isinstance(space, GridSpace) else _cells_of(space, params)
    cells = core_grid(grid)
    ends = [(float(x), float(y)) for x, y in grid.to_grid(np.stack([start, goal]))]
    reason = not_free(cells.free(ends[0]), cells.free(ends[1]), start, goal)
    if reason is None:
        return Question(grid, cells, *ends)
    if isinstance(space, PolygonSpace):
        return NoPath(reason.reason, f"{reason.detail} on a grid of {grid.resolution_m:g} m")
    return reason


def between_centres(
    space: GridSpace | PolygonSpace, start: Floats, goal: Floats, params: Parameters, *, heuristic: bool
) -> Path | NoPath:
    """The shortest path along the eight directions, with or without a heuristic."""
    asked = question(space, start, goal, params)
    return asked if isinstance(asked, NoPath) else asked.path(asked.way(heuristic=heuristic), start, goal)


def core_grid(grid: Grid) -> core.GridMap:
    """The grid in the core.

    Raises
    ------
    ParameterError
        if a side has more cells than the core takes.
    """
    try:
        return core.GridMap(grid.blocked)
    except ValueError as error:
        raise ParameterError(f"map: {grid.shape[0]} x {grid.shape[1]} cells; expected 16384 a side at most") from error


def without_repetitions(points: Floats) -> Floats:
    """The points without those that are where the one before is."""
    moved = np.ones(len(points), dtype=bool)
    moved[1:] = (np.diff(points, axis=0) != 0).any(axis=1)
    return points[moved]


def _cells_of(space: PolygonSpace, params: Parameters) -> Grid:
    west, south, east, north = space.region.bounds
    return grid_of(space, params.resolution_m or max(east - west, north - south) / _CELLS_ALONG_A_REGION)
