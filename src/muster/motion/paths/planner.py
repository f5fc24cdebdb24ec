"""The interface of path planners."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, Protocol

import numpy as np
import numpy.typing as npt

from muster.mission.errors import ParameterError
from muster.mission.values.arrays import Floats
from muster.motion.free_space import GridSpace, PolygonSpace, PrismSpace, Space
from muster.motion.maps.free_points import free
from muster.motion.path import NoPath, Path


class Algorithm(Protocol):
    """The part of a planner that differs. Start and goal are (2,) in the plane, (3,) in the air."""

    def __call__(self, space: Space, start: Floats, goal: Floats, seed: int, params: Any) -> Path | NoPath: ...


@dataclass(frozen=True, kw_only=True)
class Planner:
    """A way of finding paths. `parameters` is a frozen, keyword-only dataclass that checks itself when made."""

    name: str
    summary: str
    parameters: type[Any]
    algorithm: Algorithm

    def find(
        self, space: Space, start: npt.ArrayLike, goal: npt.ArrayLike, *, seed: int = 0, params: Any = None
    ) -> Path | NoPath:
        """A path from start to goal, or why there is none; the same for the same arguments.

        Start and goal are (2,) or (3,) metres in the map frame; spaces in the plane take no notice of a height.

        Raises
        ------
        ParameterError
            if start or goal is no such point, if the space is not one for this planner, or if the seed is out of range.
        """
        if not (isinstance(seed, int) and 0 <= seed < 2**64):
            raise ParameterError(f"seed: {seed}; expected a whole number from 0 to 2**64 - 1")
        ends = point_of(space, start, "start"), point_of(space, goal, "goal")
        return self.algorithm(space, *ends, seed, params or self.parameters())


def dimensions(space: Space) -> int:
    """3 in the air, 2 in the plane."""
    return 3 if isinstance(space, PrismSpace) else 2


def points_of(space: Space, points: npt.ArrayLike, name: str) -> Floats:
    """Points (n, d) with as many coordinates as the space has.

    Raises
    ------
    ParameterError
        if they have fewer, more than three, or are not finite.
    """
    wanted = dimensions(space)
    array = np.asarray(points, dtype=np.float64)
    if array.ndim != 2 or not wanted <= array.shape[1] <= 3:
        expected = "(n, 3)" if wanted == 3 else "(n, 2) or (n, 3)"
        raise ParameterError(f"{name}: an array of shape {array.shape}; expected {expected} metres")
    if not np.isfinite(array).all():
        raise ParameterError(f"{name}: not finite; expected metres in the map frame")
    return np.ascontiguousarray(array[:, :wanted]) + 0.0  # no -0.0


def point_of(space: Space, point: npt.ArrayLike, name: str) -> Floats:
    """One point, as `points_of`."""
    array = np.asarray(point, dtype=np.float64)
    if array.ndim != 1:
        raise ParameterError(f"{name}: an array of shape {array.shape}; expected a point, x,y or x,y,z in metres")
    found: Floats = points_of(space, array[np.newaxis], name)[0]
    return found


def blocked(space: Space, start: Floats, goal: Floats) -> NoPath | None:
    """Why there can be no path from or to places that are not free."""
    start_is_free, goal_is_free = free(space, np.stack([start, goal])).tolist()
    return not_free(start_is_free, goal_is_free, start, goal)


def not_free(start_is_free: bool, goal_is_free: bool, start: Floats, goal: Floats) -> NoPath | None:
    """Which of two places it is that is not free; None if both are."""
    if not start_is_free:
        return NoPath("start blocked", f"{shown(start)} is not free for this body")
    if not goal_is_free:
        return NoPath("goal blocked", f"{shown(goal)} is not free for this body")
    return None


def disconnected(start: Floats, goal: Floats) -> NoPath:
    return NoPath("disconnected", f"no free way leads from {shown(start)} to {shown(goal)}")


def pair(point: Floats) -> tuple[float, float]:
    """A point of the plane as the core takes it."""
    return float(point[0]), float(point[1])


def shown(point: Floats) -> str:
    return "(" + ", ".join(f"{value:g}" for value in point) + ")"


def in_plane(space: Space, name: str) -> GridSpace | PolygonSpace:
    """The space, if it is a plane.

    Raises
    ------
    ParameterError
        if it is not.
    """
    if isinstance(space, PrismSpace):
        raise ParameterError(f"planner: {name}; expected shortest, rrt-star or rrt in a space with heights")
    return space
