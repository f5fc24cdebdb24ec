"""Dijkstra's algorithm between the centres of cells ([dijkstra1959]; [market-paper], section 3.2.1)."""

from __future__ import annotations

from muster.mission.values.arrays import Floats
from muster.motion.free_space import Space
from muster.motion.path import NoPath, Path
from muster.motion.paths.on_grid import Parameters, between_centres
from muster.motion.paths.planner import Planner, in_plane


def find_path(space: Space, start: Floats, goal: Floats, seed: int, params: Parameters) -> Path | NoPath:
    """No shorter way leads along the eight directions; corners of blocked cells are not cut."""
    return between_centres(in_plane(space, "dijkstra"), start, goal, params, heuristic=False)


DIJKSTRA = Planner(
    name="dijkstra",
    summary="shortest along the 8 directions of a grid, without a heuristic",
    parameters=Parameters,
    algorithm=find_path,
)
