"""Shortest paths in one space between many places: one visibility graph, one search per place (see `shortest`)."""

from __future__ import annotations

from functools import partial
from itertools import pairwise
from typing import Protocol

import numpy as np
import numpy.typing as npt

from muster import core
from muster.mission.errors import ParameterError
from muster.mission.values.arrays import Floats
from muster.motion.free_space import GridSpace, PolygonSpace, PrismSpace, Space
from muster.motion.grid import Grid, Indices
from muster.motion.maps.free_points import free
from muster.motion.path import NoPath, Path
from muster.motion.paths.kept_lengths import KeptLengths
from muster.motion.paths.on_grid import core_grid, without_repetitions
from muster.motion.paths.planner import blocked, disconnected, pair, point_of, points_of
from muster.motion.paths.rings import rings_of

_ROWS_AT_A_TIME = 32  # so that Ctrl-C is heard
_CORNERS_AT_A_TIME = 1000  # for the same


class _Ways(Protocol):
    """Shortest paths in metres of the map frame."""

    def sees(self, a: Floats, b: Floats) -> bool: ...
    def way(self, start: Floats, goal: Floats) -> Floats: ...
    def lengths(self, exits: Floats, entries: Floats, threads: int) -> Floats: ...


class PathFinder:
    """Shortest paths in one space, which is analysed once."""

    def __init__(self, space: Space) -> None:
        self._space = space
        self._ways = _ways_in(space)

    def path(self, start: npt.ArrayLike, goal: npt.ArrayLike) -> Path | NoPath:
        """The shortest path between two points, (2,) or (3,) metres in the map frame, or the reason why there is none.

        Raises
        ------
        ParameterError
            if one is no such point.
        """
        a, b = point_of(self._space, start, "start"), point_of(self._space, goal, "goal")
        reason = blocked(self._space, a, b)
        if reason is not None:
            return reason
        points = self._ways.way(a, b)
        return Path(without_repetitions(points)) if len(points) else disconnected(a, b)

    def clear(self, points: Floats) -> bool:
        """Whether the straight pieces through points (k, d) are free from end to end: a `Clear` for smoothing."""
        places = points_of(self._space, points, "points")
        return bool(free(self._space, places).all()) and all(self._ways.sees(a, b) for a, b in pairwise(places))

    def lengths(self, exits: npt.ArrayLike, entries: npt.ArrayLike | None = None, *, threads: int = 1) -> Floats:
        """The lengths of the shortest paths from each exit (n, d) to each entry (m, d): (n, m) metres.

        Without entries they are the exits; then lengths are symmetric. Where there is no path: inf; `path` gives the
        reason.

        Raises
        ------
        ParameterError
            if there are no such places, or fewer than one thread.
        """
        if threads < 1:
            raise ParameterError(f"threads: {threads}; expected 1 at least")
        leave = points_of(self._space, exits, "exits")
        enter = leave if entries is None else points_of(self._space, entries, "entries")
        metres = self._ways.lengths(leave, enter, threads)
        metres[~free(self._space, leave)] = np.inf
        metres[:, ~free(self._space, enter)] = np.inf
        return metres


def travel_lengths(space: Space, exits: npt.ArrayLike, entries: npt.ArrayLike, threads: int = 1) -> Floats:
    """The lengths of the shortest paths from each exit to each entry; see `PathFinder.lengths`."""
    return PathFinder(space).lengths(exits, entries, threads=threads)


def _ways_in(space: Space) -> _Ways:
    if isinstance(space, GridSpace):
        return _OnGrid(space.grid)
    if space.region.is_empty:
        return _Nowhere()
    return _InRegion(space) if isinstance(space, PolygonSpace) else _InAir(space)


class _Nowhere:
    """A space without a free point."""

    def sees(self, a: Floats, b: Floats) -> bool:
        return False

    def way(self, start: Floats, goal: Floats) -> Floats:
        return np.empty((0, 2))

    def lengths(self, exits: Floats, entries: Floats, threads: int) -> Floats:
        return np.full((len(exits), len(entries)), np.inf)


class _InRegion:
    def __init__(self, space: PolygonSpace) -> None:
        self._ways = core.Ways.on_region(rings_of(space.region))
        self._kept = KeptLengths(partial(_plane_lengths, self._ways))

    def sees(self, a: Floats, b: Floats) -> bool:
        return self._ways.sees(pair(a), pair(b))

    def way(self, start: Floats, goal: Floats) -> Floats:
        return _plane_way(self._ways, pair(start), pair(goal))

    def lengths(self, exits: Floats, entries: Floats, threads: int) -> Floats:
        return self._kept.lengths(exits, entries, threads)


class _OnGrid:
    """Shortest paths on a grid; the core counts in cells."""

    def __init__(self, grid: Grid) -> None:
        self._grid = grid
        self._ways = core.Ways.on_grid(core_grid(grid))
        self._kept = KeptLengths(partial(_plane_lengths, self._ways))

    def sees(self, a: Floats, b: Floats) -> bool:
        return self._ways.sees(self._cell(a), self._cell(b))

    def way(self, start: Floats, goal: Floats) -> Floats:
        way = self._grid.to_map(_plane_way(self._ways, self._cell(start), self._cell(goal)))
        if len(way):
            way[0], way[-1] = start, goal
        return way

    def lengths(self, exits: Floats, entries: Floats, threads: int) -> Floats:
        in_cells = self._kept.lengths(self._grid.to_grid(exits), self._grid.to_grid(entries), threads)
        return in_cells * self._grid.resolution_m

    def _cell(self, point: Floats) -> tuple[float, float]:
        return pair(self._grid.to_grid(point[np.newaxis])[0])


def _plane_way(ways: core.Ways, start: tuple[float, float], goal: tuple[float, float]) -> Floats:
    if ways.graph_pays:
        _build(ways, 1)
    return ways.way(start, goal)


def _plane_lengths(ways: core.Ways, exits: Floats, entries: Floats, threads: int) -> Floats:
    """A table whose exits are its entries is the same in both directions: half of it is searched for."""
    if not np.array_equal(exits, entries):
        return _plane_table(ways, exits, entries, threads, mutual=False)
    order = _outermost_first(exits)
    table = np.empty((len(exits), len(exits)))
    table[np.ix_(order, order)] = _plane_table(ways, exits[order], exits[order], threads, mutual=True)
    return table


def _plane_table(ways: core.Ways, exits: Floats, entries: Floats, threads: int, *, mutual: bool) -> Floats:
    """Way by way until the graph pays; then row by row in the graph."""
    whole = None if ways.built else ways.lengths_alone(exits, entries, mutual=mutual)
    if whole is not None:
        return _joined([whole], whole.shape, mutual=mutual)
    _build(ways, threads)
    rows = [
        ways.lengths(exits, entries, mutual=mutual, first=first, last=last, threads=threads)
        for first, last in _blocks(len(exits), threads)
    ]
    return _joined(rows, (len(exits), len(entries)), mutual=mutual)


def _build(ways: core.Ways, threads: int) -> None:
    """The graph of what corners see, in pieces."""
    while not ways.built:
        ways.build(_CORNERS_AT_A_TIME * threads, threads)


def _outermost_first(places: Floats) -> Indices:
    """An order in which the bounding box of the remaining places shrinks fast; each place is searched to later ones."""
    if not len(places):
        return np.empty(0, dtype=np.intp)
    middle = (places.min(axis=0) + places.max(axis=0)) / 2
    return np.argsort(-np.abs(places - middle).max(axis=1), kind="stable")


class _InAir:
    """Shortest paths in the air.

    Samples: 16 over the height of the obstacles, 100 along the region; higher places make new ones.
    """

    def __init__(self, space: PrismSpace) -> None:
        self._space = space
        ceilings = [prism.ceiling_m for prism in space.prisms if np.isfinite(prism.ceiling_m)]
        self._top = max([space.lowest_m, *ceilings])
        self._sample()

    def _sample(self) -> None:
        space = self._space
        west, south, east, north = space.region.bounds
        height, width = self._top - space.lowest_m, max(east - west, north - south)
        self._ways = core.AirWays(
            rings_of(space.region),
            [(rings_of(prism.polygon), prism.floor_m, prism.ceiling_m) for prism in space.prisms],
            lowest=space.lowest_m,
            top=self._top,
            rise=(height or width) / 16,
            run=width / 100,
        )

    def _reaching(self, places: Floats) -> core.AirWays:
        if len(places) and places[:, 2].max() > self._top:
            self._top = float(places[:, 2].max())
            self._sample()
        return self._ways

    def sees(self, a: Floats, b: Floats) -> bool:
        return self._ways.sees(_triple(a), _triple(b))

    def way(self, start: Floats, goal: Floats) -> Floats:
        """Searched from the lesser point, so that both directions have the same length."""
        ways = self._reaching(np.stack([start, goal]))
        if ways.graph_pays and not ways.built:
            ways.build(1)
        if tuple(start) <= tuple(goal):
            return ways.way(_triple(start), _triple(goal))
        return ways.way(_triple(goal), _triple(start))[::-1]

    def lengths(self, exits: Floats, entries: Floats, threads: int) -> Floats:
        places, where = np.unique(np.concatenate([exits, entries]), axis=0, return_inverse=True)
        ways = self._reaching(places)
        if not ways.built:
            ways.build(threads)
        rows = [
            ways.lengths(places, first=first, last=last, threads=threads)
            for first, last in _blocks(len(places), threads)
        ]
        table = _joined(rows, (len(places), len(places)), mutual=True)
        where = where.reshape(-1)
        return table[np.ix_(where[: len(exits)], where[len(exits) :])]


def _blocks(rows: int, threads: int) -> list[tuple[int, int]]:
    step = _ROWS_AT_A_TIME * threads
    return [(first, min(first + step, rows)) for first in range(0, rows, step)]


def _joined(rows: list[Floats], shape: tuple[int, int], *, mutual: bool) -> Floats:
    table = np.concatenate(rows) if rows else np.empty(shape)
    if mutual:
        below = np.tril_indices(shape[0], -1)
        table[below] = table.T[below]
    return table


def _triple(point: Floats) -> tuple[float, float, float]:
    return float(point[0]), float(point[1]), float(point[2])
