"""RRT ([lavalle1998]; [tcf-thesis], section 2.2): the tree of RRT* without rewiring, until it first sees the goal."""

from __future__ import annotations

import numpy as np

from muster.mission.values.arrays import Floats
from muster.motion.free_space import Space
from muster.motion.path import NoPath, Path
from muster.motion.paths.planner import Planner, blocked
from muster.motion.paths.random_tree import TreeParameters, field_of, path_of

_WITHOUT_REWIRING = 0.0


def find_path(space: Space, start: Floats, goal: Floats, seed: int, params: TreeParameters) -> Path | NoPath:
    """The first path that the tree finds, however long; `not found` if the samples did not reach the goal."""
    reason = blocked(space, start, goal)
    if reason is not None:
        return reason
    if (start == goal).all():
        return Path(start[np.newaxis])
    tree = field_of(space, start, goal).tree(seed, params, _WITHOUT_REWIRING)
    for _ in range(params.iterations):
        if len(tree.way()):
            break
        tree.grow(1)
    return path_of(tree, space, start, goal, params.iterations)


RRT = Planner(
    name="rrt",
    summary="a tree of random samples, in the plane and in the air; the first path it finds",
    parameters=TreeParameters,
    algorithm=find_path,
)
