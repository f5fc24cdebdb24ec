"""Free space by the size of robots: what each has for itself, the paths there, and proofs that there is none."""

from __future__ import annotations

import math
from collections.abc import Collection, Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property
from typing import NamedTuple

import numpy as np

from muster.mission.values.arrays import Floats
from muster.motion.free_space import GridSpace, PolygonSpace
from muster.motion.grid import Grid
from muster.motion.map_world import World
from muster.motion.maps.free_points import free
from muster.motion.path import Path
from muster.motion.paths import PathFinder

Place = tuple[float, float]


class Disc(NamedTuple):
    """Where the centre of a robot may not be: nearer than so many metres to a place."""

    at: Place
    apart_m: float


@dataclass(frozen=True, eq=False)
class RobotSpaces:
    """The free space of robots of every radius.

    Parameters
    ----------
    world
        the map; None where there is none, and all is free.
    kind
        of the robots: `ground` or `air`.
    """

    world: World | None = None
    kind: str = "ground"
    _finders: dict[float, PathFinder] = field(default_factory=dict, init=False, repr=False)

    def space(self, radius_m: float) -> GridSpace | PolygonSpace | None:
        """Where the centre of a robot may be while all doors are open; None where it may be anywhere."""
        return None if self._opened is None else self._in(self._opened, radius_m)

    def finder(self, radius_m: float) -> PathFinder | None:
        """Finds the paths of a robot while all doors are open; None where it may be anywhere."""
        space = self.space(radius_m)
        if space is None:
            return None
        if radius_m not in self._finders:
            self._finders[radius_m] = PathFinder(space)
        return self._finders[radius_m]

    def clear(self, points: Floats, radius_m: float) -> bool:
        """Whether the straight way along points, (n, 2) metres, is free for a robot."""
        finder = self.finder(radius_m)
        return finder is None or finder.clear(points)

    def corners(self, start: Floats, goal: Floats, radius_m: float) -> Floats | None:
        """The corners (k, 2) between the ends of a robot's shortest path; None where there is none."""
        finder = self.finder(radius_m)
        found = None if finder is None else finder.path(start, goal)
        if found is None:
            return np.zeros((0, 2))
        return found.points[1:-1] if isinstance(found, Path) else None

    def separates(
        self,
        start: Place,
        goal: Place,
        radius_m: float,
        *,
        closed: Collection[str] = (),
        discs: Sequence[Disc] = (),
    ) -> bool:
        """Whether a robot has no way from one place to another in its own free space: the only proof that it has none.

        A robot that stands a little outside its free space, as robots err in where they are, starts from the nearest
        place in it.

        Parameters
        ----------
        closed
            the ids of the doors that are closed.
        discs
            around others that stand for good.
        """
        space = self._proving_space(start, goal, radius_m, closed)
        if space is None:
            if not discs:
                return False
            space = _around([start, goal, *(disc.at for disc in discs)], max(disc.apart_m for disc in discs))
        if discs:
            space = _without(space, discs)
        begin = _nearest_free(space, np.array(start))
        return begin is None or not isinstance(PathFinder(space).path(begin, goal), Path)

    def _proving_space(
        self, start: Place, goal: Place, radius_m: float, closed: Collection[str]
    ) -> GridSpace | PolygonSpace | None:
        if self.world is None:
            return None
        return self._in(self.world.with_closed(closed), radius_m) if closed else self.space(radius_m)

    @cached_property
    def _opened(self) -> World | None:
        return None if self.world is None else self.world.with_closed(())

    def _in(self, world: World, radius_m: float) -> GridSpace | PolygonSpace:
        space = world.free_space(radius_m, self.kind, three_d=False)
        assert isinstance(space, GridSpace | PolygonSpace)
        return space


def _around(places: Sequence[Place], apart_m: float) -> PolygonSpace:
    """The open plane around places, with room to get round what is `apart_m` away from them."""
    import shapely

    points = np.array(places)
    (west, south), (east, north) = points.min(axis=0) - 4 * apart_m, points.max(axis=0) + 4 * apart_m
    return PolygonSpace(shapely.box(west, south, east, north))


def _without(space: GridSpace | PolygonSpace, discs: Sequence[Disc]) -> GridSpace | PolygonSpace:
    """A space without discs; what is left is too large rather than too small, so that proofs hold."""
    if isinstance(space, GridSpace):
        blocked = space.grid.blocked.copy()
        for disc in discs:
            _block(blocked, space.grid, disc)
        return GridSpace(replace(space.grid, blocked=blocked))
    import shapely

    taken = shapely.buffer(shapely.points([disc.at for disc in discs]), [disc.apart_m for disc in discs], quad_segs=32)
    left = shapely.difference(space.region, shapely.union_all(taken))
    parts = [part for part in shapely.get_parts(left) if isinstance(part, shapely.Polygon)]
    return PolygonSpace(shapely.MultiPolygon(parts))


def _block(blocked: np.ndarray[tuple[int, int], np.dtype[np.bool_]], grid: Grid, disc: Disc) -> None:
    """Block the cells that are inside a disc as a whole."""
    column, row = grid.to_grid(np.array([disc.at]))[0]
    reach = disc.apart_m / grid.resolution_m
    rows, columns = grid.shape
    up = np.arange(max(0, math.floor(row - reach)), min(rows, math.ceil(row + reach) + 1))
    across = np.arange(max(0, math.floor(column - reach)), min(columns, math.ceil(column + reach) + 1))
    farthest_up, farthest_across = np.abs(up + 0.5 - row) + 0.5, np.abs(across + 0.5 - column) + 0.5
    blocked[np.ix_(up, across)] |= np.hypot(farthest_up[:, np.newaxis], farthest_across) < reach


def _nearest_free(space: GridSpace | PolygonSpace, place: Floats) -> Floats | None:
    """The place itself where it is free, else the nearest that is; None where no place is."""
    if free(space, place[np.newaxis])[0]:
        return place
    if isinstance(space, GridSpace):
        cells = np.argwhere(~space.grid.blocked)[:, ::-1] + 0.5
        if not len(cells):
            return None
        nearest = cells[np.argmin(np.hypot(*(cells - space.grid.to_grid(place[np.newaxis])[0]).T))]
        return np.asarray(space.grid.to_map(nearest[np.newaxis])[0])
    import shapely

    if space.region.is_empty:
        return None
    return np.asarray(shapely.get_coordinates(shapely.shortest_line(space.region, shapely.Point(place)))[0])
