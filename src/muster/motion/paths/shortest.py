"""The shortest path at any angle: taut pieces between corners of obstacles.

In the plane it is the true shortest path. That turns at convex corners of obstacles only [lozano1979],
each time around the obstacle, so only pieces that are taut at both ends count [oh2017]. Whether points see each other
is decided in whole numbers: on a grid to 2^-16 of a cell, in a region to 2^-29 of its size.

In the air among upright prisms the problem is NP-hard [canny1987]. There turning points are sampled on the
obstacles' edges [papadimitriou1985], and the shortest way between samples is pulled straight: its turning points slide
along their edges to the minimum, which is the only one for that sequence of edges, for the length is convex.
"""

from __future__ import annotations

from dataclasses import dataclass

from muster.mission.values.arrays import Floats
from muster.motion.free_space import Space
from muster.motion.path import NoPath, Path
from muster.motion.paths.path_finder import PathFinder
from muster.motion.paths.planner import Planner


@dataclass(frozen=True, kw_only=True)
class Parameters:
    """None."""


def find_path(space: Space, start: Floats, goal: Floats, seed: int, params: Parameters) -> Path | NoPath:
    """One path; who wants many makes a `PathFinder`."""
    return PathFinder(space).path(start, goal)


SHORTEST = Planner(
    name="shortest",
    summary="the shortest at any angle; in the air, nearly",
    parameters=Parameters,
    algorithm=find_path,
)
