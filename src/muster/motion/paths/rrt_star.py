"""RRT* ([karaman2011], algorithm 6)."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from muster.mission.values.arrays import Floats
from muster.mission.values.ranges import require_positive
from muster.motion.free_space import Space
from muster.motion.path import NoPath, Path
from muster.motion.paths.planner import Planner, blocked
from muster.motion.paths.random_tree import TreeParameters, field_of, path_of

_SAMPLES_AT_A_TIME = 500  # so that Ctrl-C is heard


@dataclass(frozen=True, kw_only=True)
class Parameters(TreeParameters):
    """See `TreeParameters`. `reach`: the radius of rewiring over the least one that converges."""

    reach: float = 1.1

    def __post_init__(self) -> None:
        super().__post_init__()
        require_positive(reach=self.reach)


def find_path(space: Space, start: Floats, goal: Floats, seed: int, params: Parameters) -> Path | NoPath:
    """A path that nears the shortest with the samples; `not found` if they did not reach the goal."""
    reason = blocked(space, start, goal)
    if reason is not None:
        return reason
    if (start == goal).all():
        return Path(start[np.newaxis])
    tree = field_of(space, start, goal).tree(seed, params, params.reach)
    for first in range(0, params.iterations, _SAMPLES_AT_A_TIME):
        tree.grow(min(_SAMPLES_AT_A_TIME, params.iterations - first))
    return path_of(tree, space, start, goal, params.iterations)


RRT_STAR = Planner(
    name="rrt-star",
    summary="a tree of random samples, in the plane and in the air; shorter with more iterations",
    parameters=Parameters,
    algorithm=find_path,
)
