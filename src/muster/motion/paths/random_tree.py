"""Common parts of the planners that grow a tree of random samples: where it grows, its step, and its way in metres."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from muster import core
from muster.mission.errors import ParameterError
from muster.mission.values.arrays import Floats
from muster.motion.free_space import GridSpace, PolygonSpace, PrismSpace, Space
from muster.motion.path import NoPath, Path
from muster.motion.paths.on_grid import core_grid, without_repetitions
from muster.motion.paths.rings import rings_of


@dataclass(frozen=True, kw_only=True)
class TreeParameters:
    """How a tree grows.

    `iterations`: samples. `step_m`: the longest branch; a tenth of the space's diagonal by default. `goal_share`: of
    the samples, those that are the goal.
    """

    iterations: int = 5000
    step_m: float | None = None
    goal_share: float = 0.05

    def __post_init__(self) -> None:
        for name, fine, expected in (
            ("iterations", 1 <= self.iterations <= 10**7, "1 to 10^7"),
            ("step_m", self.step_m is None or self.step_m > 0, "a number above 0"),
            ("goal_share", 0 <= self.goal_share <= 1, "0 to 1"),
        ):
            if not fine:
                raise ParameterError(f"{name}: {getattr(self, name)}; expected {expected}")


@dataclass(frozen=True)
class Field:
    """Where the tree grows, in its own unit: cells on a grid, else metres."""

    where: core.Ways | core.AirWays
    low: tuple[float, float, float]
    high: tuple[float, float, float]
    start: tuple[float, ...]
    goal: tuple[float, ...]
    unit_m: float = 1.0

    def tree(self, seed: int, params: TreeParameters, reach: float) -> core.Tree:
        """A tree of the start alone. `reach` scales the radius of rewiring; with 0 nothing is rewired."""
        step = float(np.linalg.norm(np.subtract(self.high, self.low))) / 10
        return core.Tree(
            self.where,
            low=self.low,
            high=self.high,
            start=_triple(self.start),
            goal=_triple(self.goal),
            seed=seed,
            step=step if params.step_m is None else params.step_m / self.unit_m,
            goal_share=params.goal_share,
            reach=reach,
        )


def field_of(space: Space, start: Floats, goal: Floats) -> Field:
    """The field of a tree between two free points."""
    if isinstance(space, GridSpace):
        rows, columns = space.grid.shape
        a, b = space.grid.to_grid(np.stack([start, goal]))
        ways = core.Ways.on_grid(core_grid(space.grid))
        return Field(ways, (0, 0, 0), (columns, rows, 0), _floats(a), _floats(b), space.grid.resolution_m)
    west, south, east, north = space.region.bounds
    if isinstance(space, PolygonSpace):
        region = core.Ways.on_region(rings_of(space.region))
        return Field(region, (west, south, 0), (east, north, 0), _floats(start), _floats(goal))
    top = _top(space, start, goal)
    width = max(east - west, north - south)
    prisms = [(rings_of(prism.polygon), prism.floor_m, prism.ceiling_m) for prism in space.prisms]
    air = core.AirWays(rings_of(space.region), prisms, lowest=space.lowest_m, top=top, rise=width, run=width)
    return Field(air, (west, south, space.lowest_m), (east, north, top), _floats(start), _floats(goal))


def path_of(tree: core.Tree, space: Space, start: Floats, goal: Floats, samples: int) -> Path | NoPath:
    """The tree's way to the goal in metres; `not found` if it has none."""
    way = tree.way()[:, : len(start)]
    if len(way) == 0:
        return NoPath("not found", f"{samples} samples did not reach the goal; more may")
    points = space.grid.to_map(way) if isinstance(space, GridSpace) else way
    points[0], points[-1] = start, goal
    return Path(without_repetitions(points))


def _top(space: PrismSpace, start: Floats, goal: Floats) -> float:
    """A height above everything: a little over the highest ceiling, start and goal."""
    ceilings = [prism.ceiling_m for prism in space.prisms if np.isfinite(prism.ceiling_m)]
    highest = max([space.lowest_m, float(start[2]), float(goal[2]), *ceilings])
    return highest + 0.1 * max(highest - space.lowest_m, 1.0)


def _floats(point: Floats) -> tuple[float, ...]:
    return tuple(float(value) for value in point)


def _triple(point: tuple[float, ...]) -> tuple[float, float, float]:
    return point[0], point[1], point[2] if len(point) == 3 else 0.0
