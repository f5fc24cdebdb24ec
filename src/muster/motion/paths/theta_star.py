"""Basic Theta* [nash2007]: paths at any angle between the centres of cells."""

from __future__ import annotations

from itertools import pairwise

import numpy as np

from muster.mission.values.arrays import Floats
from muster.motion.free_space import Space
from muster.motion.path import NoPath, Path
from muster.motion.paths.on_grid import Parameters, Question, question
from muster.motion.paths.planner import Planner, in_plane, pair


def find_path(space: Space, start: Floats, goal: Floats, seed: int, params: Parameters) -> Path | NoPath:
    """Never longer than the path of A*.

    Theta* alone does not promise that: a parent that it fixes early may turn out worse. So the path of A* with its
    string pulled is a second answer, and the shorter one is given.
    """
    asked = question(in_plane(space, "theta-star"), start, goal, params)
    if isinstance(asked, NoPath):
        return asked
    ways = [pulled(asked, asked.way(heuristic=True, any_angle=any_angle)) for any_angle in (True, False)]
    return asked.path(min(ways, key=_length), start, goal)


def pulled(asked: Question, way: Floats) -> Floats:
    """The path (k, 2) in cells without points that are not needed, as their neighbours see each other."""
    kept = list(way[:1])
    for point, after in pairwise(way[1:]):
        if not asked.cells.sees(pair(kept[-1]), pair(after)):
            kept.append(point)
    return np.array([*kept, *way[-1:]]) if len(way) > 1 else way


def _length(way: Floats) -> float:
    return float(np.linalg.norm(np.diff(way, axis=0), axis=1).sum())


THETA_STAR = Planner(
    name="theta-star",
    summary="short at any angle between the cells of a grid; never longer than a-star",
    parameters=Parameters,
    algorithm=find_path,
)
