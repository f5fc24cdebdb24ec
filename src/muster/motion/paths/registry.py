"""The planners of paths by name."""

from __future__ import annotations

from collections.abc import Mapping
from types import MappingProxyType
from typing import Any

import numpy.typing as npt

from muster.mission.values.keywords import require_one_of
from muster.motion.free_space import Space
from muster.motion.path import NoPath, Path
from muster.motion.paths.a_star import A_STAR
from muster.motion.paths.bug import BUG
from muster.motion.paths.dijkstra import DIJKSTRA
from muster.motion.paths.dubins import DUBINS
from muster.motion.paths.planner import Planner
from muster.motion.paths.potential_field import POTENTIAL_FIELD
from muster.motion.paths.rrt import RRT
from muster.motion.paths.rrt_star import RRT_STAR
from muster.motion.paths.shortest import SHORTEST
from muster.motion.paths.theta_star import THETA_STAR

_IMPLEMENTATIONS = (SHORTEST, THETA_STAR, A_STAR, DIJKSTRA, RRT_STAR, RRT, BUG, POTENTIAL_FIELD, DUBINS)

PLANNERS: Mapping[str, Planner] = MappingProxyType({planner.name: planner for planner in _IMPLEMENTATIONS})


def planner_named(name: str) -> Planner:
    """The planner of that name.

    Raises
    ------
    ParameterError
        if there is none.
    """
    require_one_of("planner", name, PLANNERS)
    return PLANNERS[name]


def find(
    space: Space,
    start: npt.ArrayLike,
    goal: npt.ArrayLike,
    *,
    planner: str = "shortest",
    seed: int = 0,
    params: Any = None,
) -> Path | NoPath:
    """A path by the planner of that name; see `Planner.find`."""
    return planner_named(planner).find(space, start, goal, seed=seed, params=params)
