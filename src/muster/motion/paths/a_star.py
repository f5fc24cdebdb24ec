"""A* between the centres of cells ([hart1968]; [market-paper], section 3.2.2, (3))."""

from __future__ import annotations

from muster.mission.values.arrays import Floats
from muster.motion.free_space import Space
from muster.motion.path import NoPath, Path
from muster.motion.paths.on_grid import Parameters, between_centres
from muster.motion.paths.planner import Planner, in_plane


def find_path(space: Space, start: Floats, goal: Floats, seed: int, params: Parameters) -> Path | NoPath:
    """As short as Dijkstra's: the octile distance never exceeds what is left."""
    return between_centres(in_plane(space, "a-star"), start, goal, params, heuristic=True)


A_STAR = Planner(
    name="a-star",
    summary="shortest along the 8 directions of a grid",
    parameters=Parameters,
    algorithm=find_path,
)
