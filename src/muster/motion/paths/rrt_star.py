"""RRT* ([karaman2011], algorithm 6)."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from muster import core
from muster.mission.errors import ParameterError
from muster.motion.free_space import GridSpace, PolygonSpace, PrismSpace, Space
from muster.motion.path import NoPath, Path
from muster.motion.paths.on_grid import core_grid, without_repetitions
from muster.motion.paths.planner import Planner, blocked
from muster.motion.paths.rings import rings_of

Floats = npt.NDArray[np.float64]
_SAMPLES_AT_A_TIME = 500  # so that Ctrl-C is heard


@dataclass(frozen=True, kw_only=True)
class Parameters:
    """How the tree grows.

    `iterations`: samples. `step_m`: the longest branch; a tenth of the space's diagonal by default. `goal_share`: of
    the samples, those that are the goal. `reach`: the radius of rewiring over the least one that converges.
    """

    iterations: int = 5000
    step_m: float | None = None
    goal_share: float = 0.05
    reach: float = 1.1

    def __post_init__(self) -> None:
        for name, fine, expected in (
            ("iterations", 1 <= self.iterations <= 10**7, "1 to 10^7"),
            ("step_m", self.step_m is None or self.step_m > 0, "a number above 0"),
            ("goal_share", 0 <= self.goal_share <= 1, "0 to 1"),
            ("reach", self.reach > 0, "a number above 0"),
        ):
            if not fine:
                raise ParameterError(f"{name}: {getattr(self, name)}; expected {expected}")


def find_path(space: Space, start: Floats, goal: Floats, seed: int, params: Parameters) -> Path | NoPath:
    """A path that nears the shortest with the samples; `not found` if they did not reach the goal."""
    reason = blocked(space, start, goal)
    if reason is not None:
        return reason
    field = _field_of(space, start, goal)
    if (start == goal).all():
        return Path(start[np.newaxis])
    step = float(np.linalg.norm(np.subtract(field.high, field.low))) / 10
    tree = core.Tree(
        field.where,
        low=field.low,
        high=field.high,
        start=_triple(field.start),
        goal=_triple(field.goal),
        seed=seed,
        step=step if params.step_m is None else params.step_m / field.unit_m,
        goal_share=params.goal_share,
        reach=params.reach,
    )
    for first in range(0, params.iterations, _SAMPLES_AT_A_TIME):
        tree.grow(min(_SAMPLES_AT_A_TIME, params.iterations - first))
    way = tree.way()[:, : len(start)]
    if len(way) == 0:
        return NoPath("not found", f"{params.iterations} samples did not reach the goal; more may")
    points = space.grid.to_map(way) if isinstance(space, GridSpace) else way
    points[0], points[-1] = start, goal
    return Path(without_repetitions(points))


@dataclass(frozen=True)
class _Field:
    """Where the tree grows, in its own unit: cells on a grid, else metres."""

    where: core.Ways | core.AirWays
    low: tuple[float, float, float]
    high: tuple[float, float, float]
    start: tuple[float, ...]
    goal: tuple[float, ...]
    unit_m: float = 1.0


def _field_of(space: Space, start: Floats, goal: Floats) -> _Field:
    if isinstance(space, GridSpace):
        rows, columns = space.grid.shape
        a, b = space.grid.to_grid(np.stack([start, goal]))
        ways = core.Ways.on_grid(core_grid(space.grid))
        return _Field(ways, (0, 0, 0), (columns, rows, 0), _floats(a), _floats(b), space.grid.resolution_m)
    west, south, east, north = space.region.bounds
    if isinstance(space, PolygonSpace):
        region = core.Ways.on_region(rings_of(space.region))
        return _Field(region, (west, south, 0), (east, north, 0), _floats(start), _floats(goal))
    top = _top(space, start, goal)
    width = max(east - west, north - south)
    prisms = [(rings_of(prism.polygon), prism.floor_m, prism.ceiling_m) for prism in space.prisms]
    air = core.AirWays(rings_of(space.region), prisms, lowest=space.lowest_m, top=top, rise=width, run=width)
    return _Field(air, (west, south, space.lowest_m), (east, north, top), _floats(start), _floats(goal))


def _top(space: PrismSpace, start: Floats, goal: Floats) -> float:
    """A height above everything: a little over the highest ceiling, start and goal."""
    ceilings = [prism.ceiling_m for prism in space.prisms if np.isfinite(prism.ceiling_m)]
    highest = max([space.lowest_m, float(start[2]), float(goal[2]), *ceilings])
    return highest + 0.1 * max(highest - space.lowest_m, 1.0)


def _floats(point: Floats) -> tuple[float, ...]:
    return tuple(float(value) for value in point)


def _triple(point: tuple[float, ...]) -> tuple[float, float, float]:
    return point[0], point[1], point[2] if len(point) == 3 else 0.0


RRT_STAR = Planner(
    name="rrt-star",
    summary="a tree of random samples, in the plane and in the air; shorter with more iterations",
    parameters=Parameters,
    algorithm=find_path,
)
