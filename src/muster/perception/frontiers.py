"""Frontiers: where what was seen borders on what was not, and robots can get ([yamauchi1997]).

There are some on the ground, in the air, and on the ground that robots in the air look at.
"""

from __future__ import annotations

import math
from abc import ABC, abstractmethod
from collections.abc import Sequence

import numpy as np

from muster.motion.grid import Bools, Floats, Indices
from muster.motion.map_world import Body
from muster.perception.explored_air import ExploredAir
from muster.perception.explored_ground import ExploredGround
from muster.perception.team_map import TeamMap

_LEAST_CELLS = 3
_AS_WIDE = np.ones((3, 3), dtype=np.bool_)
_BLOCK_M = 4.0
"""Side of the cubes into which frontiers in the air are cut: they are shells all around what was seen."""


class Frontiers(ABC):
    """The frontiers of a map, as it is when this is made, for the robots of a body.

    Attributes
    ----------
    apart_m : float
        How near to its frontier a place is, at most.
    """

    apart_m: float

    @abstractmethod
    def groups(self) -> list[Floats]:
        """Return the places (n, d) of the cells of each frontier, the largest frontier first, metres."""

    @abstractmethod
    def reached(self, here: Floats, places: Floats) -> Bools:
        """Return which places (m, d) ways lead to from where robots are (n, d)."""

    @abstractmethod
    def are_near(self, place: Sequence[float]) -> bool:
        """Return whether a cell of a frontier is near a place."""

    def places(self, here: Floats) -> list[Floats]:
        """Return a place on each frontier that robots at (n, 3) can reach, the largest frontier first."""
        targets = np.array([_middle(group) for group in self.groups()])
        if not len(targets):
            return []
        return list(targets[self.reached(here, targets)])


class GroundFrontiers(Frontiers):
    """Frontiers on the ground.

    Parameters
    ----------
    ground : ExploredGround
        The ground.
    body : Body
        The robots' body.
    near : bool
        Whether only what was seen from near counts as seen.
    """

    def __init__(self, ground: ExploredGround, body: Body, *, near: bool) -> None:
        self.ground, self.body = ground, body
        self.cells = _borders(self._free(), ground.seen.near if near else ground.seen.known)
        self.apart_m = max(2 * body.radius_m, 10 * ground.seen.frame.resolution_m)

    def groups(self) -> list[Floats]:
        """See `Frontiers`."""
        from scipy.ndimage import label

        numbers, count = label(self.cells, _AS_WIDE)
        cells = np.argwhere(numbers > 0)
        least = max(_LEAST_CELLS, math.ceil(2 * self.body.radius_m / self.ground.seen.frame.resolution_m))
        groups = _grouped(cells, numbers[tuple(cells.T)] - 1, count, least)
        return [self._placed(group) for group in groups]

    def reached(self, here: Floats, places: Floats) -> Bools:
        """See `Frontiers`."""
        reached: Bools = np.isfinite(self.ground.lengths(self.body, here[:, :2], places).min(axis=0))
        return reached

    def are_near(self, place: Sequence[float]) -> bool:
        """See `Frontiers`."""
        cells = math.ceil(self.apart_m / self.ground.seen.frame.resolution_m)
        column, row = np.floor(self.ground.seen.frame.to_grid(np.array([place[:2]]))[0]).astype(int)
        return bool(
            self.cells[max(0, row - cells) : row + cells + 1, max(0, column - cells) : column + cells + 1].any()
        )

    def _free(self) -> Bools:
        return self.ground.free_cells(self.body)

    def _placed(self, cells: Indices) -> Floats:
        return self.ground.seen.centres(cells)


class OverflownFrontiers(GroundFrontiers):
    """Frontiers of the ground that robots in the air have looked at from near, from a height at which they fly.

    Parameters
    ----------
    team_map : TeamMap
        The map.
    body : Body
        The robots' body.
    height_m : float
        In the map frame.
    """

    def __init__(self, team_map: TeamMap, body: Body, height_m: float) -> None:
        self._map, self._height_m = team_map, height_m
        super().__init__(team_map.ground, body, near=True)

    def reached(self, here: Floats, places: Floats) -> Bools:
        """See `Frontiers`."""
        assert self._map.air is not None
        return self._map.air.reached(self.body, here, places)

    def _free(self) -> Bools:
        air = self._map.air
        assert air is not None
        layer = int((self._height_m - air.seen.frame.origin[2]) / air.seen.frame.cell_m)
        return self._map.on_ground(air.free_voxels(self.body)[layer])

    def _placed(self, cells: Indices) -> Floats:
        flat = self.ground.seen.centres(cells)
        return np.column_stack([flat, np.full(len(flat), self._height_m)])


class AirFrontiers(Frontiers):
    """Frontiers in the air.

    Parameters
    ----------
    air : ExploredAir
        The air.
    body : Body
        The robots' body.
    """

    def __init__(self, air: ExploredAir, body: Body) -> None:
        self.air, self.body = air, body
        self._voxels = _borders(air.free_voxels(body), air.seen.known)
        self.apart_m = max(2 * body.radius_m, 3 * air.seen.frame.cell_m)

    def groups(self) -> list[Floats]:
        """See `Frontiers`."""
        frame = self.air.seen.frame
        voxels = np.argwhere(self._voxels)
        if not len(voxels):
            return []
        blocks, parts = np.unique(voxels // max(1, round(_BLOCK_M / frame.cell_m)), axis=0, return_inverse=True)
        least = max(_LEAST_CELLS, math.ceil(2 * self.body.radius_m / frame.cell_m) ** 2)
        return [frame.centres(group) for group in _grouped(voxels, parts.reshape(-1), len(blocks), least)]

    def reached(self, here: Floats, places: Floats) -> Bools:
        """See `Frontiers`."""
        return self.air.reached(self.body, here, places)

    def are_near(self, place: Sequence[float]) -> bool:
        """See `Frontiers`."""
        frame = self.air.seen.frame
        cells = math.ceil(self.apart_m / frame.cell_m)
        (at,), _ = frame.voxels(np.array([place]))
        return bool(self._voxels[tuple(slice(max(0, k - cells), max(0, k + cells + 1)) for k in at.tolist())].any())


def _borders(free: Bools, known: Bools) -> Bools:
    """Return the cells that were seen, are free, and border on such as were not seen and may be free."""
    from scipy.ndimage import maximum_filter

    cells: Bools = free & known & maximum_filter(free & ~known, size=3, mode="constant", cval=0)
    return cells


def _grouped(cells: Indices, parts: Indices, count: int, least: int) -> list[Indices]:
    """Return the cells (n, d) by the number of their part, the largest part first, without those that are too small."""
    order = np.argsort(parts, kind="stable")
    groups = np.split(cells[order], np.cumsum(np.bincount(parts, minlength=count))[:-1]) if count else []
    return sorted((group for group in groups if len(group) >= least), key=len, reverse=True)


def _middle(places: Floats) -> Floats:
    """Return the place of some that is nearest to their mean; the first of those as near, but for rounding."""
    apart_m = np.linalg.norm(places - places.mean(axis=0), axis=1)
    nearest: Floats = places[np.argmin(np.round(apart_m, 9))]
    return nearest
