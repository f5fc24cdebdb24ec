"""A yardstick: how long robots with one goal each take by prioritised space-time A* over a grid ([silver2005]).

Cells are a little wider than robots, and each move to one of four neighbours takes as long as a robot needs at full
speed: without turns and acceleration, in time with all others. It is no bound: robots may go straight where the grid
has stairs.
"""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
import numpy.typing as npt

from muster.generation.narrow import RADIUS_M, SPEED_MPS
from muster.mission.model import Mission
from muster.motion.map_world import World
from muster.motion.paths import PathFinder
from muster.traffic.reservations import Cell
from muster.traffic.space_time import NotTogether, Parameters, together

SIDE_M = 0.65
_AROUND_M = 4.0
"""Free space around the places of a mission without a map."""


def space_time_s(mission: Mission, seed: int) -> float | None:
    """When the last robot is at the place of its one task, in seconds; None where no order gives all a path."""
    goals = {task.only_robots[0]: task.position for task in mission.tasks if task.only_robots}
    places = np.array([robot.position[:2] for robot in mission.robots] + [goals[r.id][:2] for r in mission.robots])
    low = np.floor((places.min(axis=0) - _AROUND_M) / SIDE_M).astype(int)
    high = np.ceil((places.max(axis=0) + _AROUND_M) / SIDE_M).astype(int)
    centres = np.stack(np.meshgrid(*(np.arange(a, b + 1) for a, b in zip(low, high, strict=True)), indexing="ij"), -1)
    free = _free(mission, centres * SIDE_M)
    cells = list(_cells(free, places / SIDE_M - low))
    count = len(mission.robots)
    ends = {robot.id: (cells[k], cells[count + k]) for k, robot in enumerate(mission.robots)}
    found = together(~free, ends, seed=seed, params=Parameters(neighbours=4))
    if isinstance(found, NotTogether):
        return None
    return (max(len(way) for way in found.values()) - 1) * SIDE_M / SPEED_MPS


def _free(mission: Mission, centres: npt.NDArray[np.float64]) -> npt.NDArray[np.bool_]:
    """(rows, columns): whether a robot may be at a cell's centre, (rows, columns, 2) metres."""
    if mission.map is None:
        return np.ones(centres.shape[:2], dtype=np.bool_)
    finder = PathFinder(World.of(mission).free_space(RADIUS_M, "ground", three_d=False))
    return np.array([[finder.clear(np.array([at, at])) for at in row] for row in centres], dtype=np.bool_)


def _cells(free: npt.NDArray[np.bool_], places: npt.NDArray[np.float64]) -> Iterator[Cell]:
    """For each place, in units of cells, the nearest free one; starts have cells of their own, and so have goals."""
    cells = np.argwhere(free)
    taken: set[Cell] = set()
    for k, place in enumerate(places):
        if k == len(places) // 2:  # goals may be where others start
            taken = set()
        order = np.argsort(np.hypot(*(cells - place).T))
        cell = next((int(r), int(c)) for r, c in cells[order] if (int(r), int(c)) not in taken)
        taken.add(cell)
        yield cell
