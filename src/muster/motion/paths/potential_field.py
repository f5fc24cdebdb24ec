"""Artificial potential fields ([khatib1986]; [tcf-thesis], section 2.2.1): downhill to the goal.

The goal attracts: half the square of the distance near it, in proportion to the distance farther away. Each obstacle
nearer than its influence repels, by half of (influence / distance - 1)^2 times the square of the influence, so that the
field of a map does not change with its scale. A goal beside an obstacle is to be the minimum all the same, so what
repels falls with the square of the distance to the goal [ge2000]. The path goes down the
steepest slope. It ends where there is none: at the goal, or in a local minimum, which is told as `not found`.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from muster.mission.values.arrays import Floats
from muster.mission.values.ranges import require_finite_positive
from muster.motion.free_space import Space
from muster.motion.path import NoPath, Path
from muster.motion.paths.free_region import part_around
from muster.motion.paths.planner import Planner, blocked, in_plane, shown

if TYPE_CHECKING:
    import shapely

_LEAST_STEP = 2.0**-12
_SLOPE = 1e-6
"""Half the distance over which a slope is measured, as a share of the influence."""


@dataclass(frozen=True, kw_only=True)
class Parameters:
    """The field: factors, the reach of an obstacle, and the most steps; a step is at most a tenth of the reach.

    `influence_m` is by default a fiftieth of the diagonal of the free region.
    """

    attraction: float = 1.0
    repulsion: float = 0.1
    influence_m: float | None = None
    steps: int = 20_000

    def __post_init__(self) -> None:
        require_finite_positive(attraction=self.attraction, repulsion=self.repulsion)
        require_finite_positive(influence_m=self.influence_m, steps=self.steps)


@dataclass(frozen=True)
class _Field:
    region: shapely.Polygon
    goal: Floats
    params: Parameters

    @property
    def reach(self) -> float:
        """The influence of an obstacle, metres."""
        west, south, east, north = self.region.bounds
        return self.params.influence_m or math.hypot(east - west, north - south) / 50

    @property
    def step_m(self) -> float:
        return self.reach / 10

    def height(self, points: Floats) -> Floats:
        """The potential (n,) at points (n, 2)."""
        import shapely

        p, reach = self.params, self.reach
        away = np.linalg.norm(points - self.goal, axis=1)
        attracted = p.attraction * np.where(away < reach, away**2 / 2, reach * (away - reach / 2))
        borders = [self.region.exterior, *self.region.interiors]
        places = np.array(shapely.points(points))
        gaps = shapely.distance(np.array(borders)[:, None], places[None])
        with np.errstate(divide="ignore"):
            pushes = np.where(gaps < reach, reach**2 * (reach / gaps - 1) ** 2 / 2, 0.0).sum(axis=0)
        return np.asarray(attracted + p.repulsion * pushes * np.minimum(away / reach, 1.0) ** 2)

    def downhill(self, at: Floats) -> Floats:
        """The direction (2,) of steepest descent; 0 where there is none."""
        offsets = _SLOPE * self.reach * np.array([[1.0, 0.0], [-1.0, 0.0], [0.0, 1.0], [0.0, -1.0]])
        east, west, north, south = self.height(at + offsets)
        slope = np.array([west - east, south - north])
        steepness = float(np.linalg.norm(slope))
        return slope / steepness if 0 < steepness < math.inf else np.zeros(2)

    def sees(self, a: Floats, b: Floats) -> bool:
        import shapely

        return bool(shapely.LineString([a, b]).within(self.region))


def find_path(space: Space, start: Floats, goal: Floats, seed: int, params: Parameters) -> Path | NoPath:
    """The way down; `not found` with the place if it ends in a local minimum."""
    plane = in_plane(space, "potential-field")
    reason = blocked(plane, start, goal)
    if reason is not None:
        return reason
    field = _Field(part_around(plane, start), goal, params)
    points, step = [start], field.step_m
    for _ in range(params.steps):
        here = points[-1]
        away = float(np.linalg.norm(goal - here))
        if away <= field.step_m and (away == 0 or field.sees(here, goal)):
            return Path(np.array([*points, goal] if away else points))
        taken = _step(field, here, min(field.step_m, 2 * step))
        if taken is None:
            return NoPath("not found", f"a local minimum at {shown(here.round(3))}, {away:.3g} m from the goal")
        step = float(np.linalg.norm(taken - here))
        points.append(taken)
    return NoPath("not found", f"{params.steps} steps did not reach the goal; more may")


def _step(field: _Field, here: Floats, length: float) -> Floats | None:
    """The next point: as far downhill as it goes down, at most by a length; None in a minimum."""
    direction, height = field.downhill(here), float(field.height(here[np.newaxis])[0])
    while direction.any() and length >= _LEAST_STEP * field.step_m:
        there = here + length * direction
        if field.height(there[np.newaxis])[0] < height and field.sees(here, there):
            return np.asarray(there)
        length /= 2
    return None


POTENTIAL_FIELD = Planner(
    name="potential-field",
    summary="down a field in which the goal attracts and obstacles repel; may end in a local minimum",
    parameters=Parameters,
    algorithm=find_path,
)
