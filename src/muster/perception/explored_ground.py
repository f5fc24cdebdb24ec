"""The ground as robots know it that have no map: what the rules close, and what lasers have seen of the rest.

The operation's boundary, no-fly zones and doors are known beforehand; obstacles are not. Ways are planned as if all
that was not seen were free, and planned anew where they turn out to be blocked ([koenig2005]): a way is found wherever
there is one, and there is none only when what was seen proves it.

A centre of a body is kept off the points that lasers hit, not off whole cells, unless obstacles fill cells. Two passes
see to the rest that cells round off: at first cells count as free that are so for certain; where that leaves no way,
those that may be free.
"""

from __future__ import annotations

import math
from collections.abc import Collection, Sequence
from dataclasses import dataclass, field, replace

import numpy as np
import numpy.typing as npt

from muster.motion.free_space import GridSpace, PolygonSpace
from muster.motion.grid import Bools, Floats, Grid, Indices
from muster.motion.map_world import Area, Body, World
from muster.motion.maps.free_points import free
from muster.motion.maps.raster import in_cells, touched
from muster.motion.path import NoPath, Path
from muster.motion.paths import PathFinder
from muster.motion.paths.on_grid import without_repetitions
from muster.motion.paths.planner import disconnected, not_free
from muster.perception.occupancy_map import OccupancyMap
from muster.perception.tight_ways import in_the_middle

CERTAIN, POSSIBLE = PASSES = (1, -1)
"""The two passes: which cells count as free."""
_HALF = math.sqrt(0.5)
_SPARE = 0.15
"""Of a cell by which ways that are free for certain are farther off: what is hit lies anywhere between hits."""
_SNAP_CELLS = 4
"""Cells between a place that is free and the nearest cell that is free for certain, at most."""
_TRIED = 50
"""Cells to which an end of a way may be joined, at most."""
_FITS = 0.98
"""Of its radius that a body needs on both sides, where points of obstacles are all that is known of them."""
_SLACK = 1e-6
"""Of a radius, by which a place may be too near to what was hit."""


def is_obstacle(area: Area) -> bool:
    """Return whether a zone is a thing that stands there, which lasers see; else it is closed by rule, and known."""
    return area.zone.id is None and "ground" in area.zone.forbidden_to


def ruled_world(world: World) -> World:
    """Return the world without obstacles: its extent or boundary, its no-fly zones and its doors."""
    import shapely

    areas = tuple(area for area in world.areas if not is_obstacle(area))
    if world.image is None:
        return replace(world, areas=areas)
    rows, columns = world.image.shape
    corners = world.image.to_map(np.array([(0, 0), (columns, 0), (columns, rows), (0, rows)], dtype=np.float64))
    return replace(world, image=None, boundary=shapely.Polygon(corners), areas=areas)


def frame_of(world: World, radius_m: float) -> Grid:
    """Return the cells of a map to be built: a quarter of the least radius wide, 1000 on a side at most.

    The cells of an image that are coarser than that are halved until they are not.
    """
    if world.image is not None:
        rows, columns = world.image.shape
        wanted = max(radius_m / 4, world.image.resolution_m * max(rows, columns) / 1000)
        parts = max(1, math.floor(world.image.resolution_m / wanted))
        size = (rows * parts, columns * parts)
        return Grid(np.zeros(size, dtype=np.bool_), world.image.resolution_m / parts, world.image.origin)
    assert world.boundary is not None
    west, south, east, north = world.boundary.bounds
    extent = max(east - west, north - south)
    cell_m = min(max(radius_m / 4, extent / 1000), extent / 100)
    size = (max(1, math.ceil((north - south) / cell_m)), max(1, math.ceil((east - west) / cell_m)))
    return Grid(np.zeros(size, dtype=np.bool_), cell_m, (west, south, 0.0))


def map_to_build(
    world: World, radii_m: Collection[float], frame: Grid | None = None, *, fills_cells: bool = False
) -> OccupancyMap:
    """Return an empty map of a world for bodies of some radii, in the cells of `frame_of` unless others are given.

    Obstacles fill its cells where that is said, and where they are cells of an image.
    """
    frame = frame_of(world, min(radii_m)) if frame is None else frame
    return OccupancyMap(
        frame, max(radii_m) + 2 * frame.resolution_m, fills_cells=fills_cells or world.image is not None
    )


@dataclass(eq=False)
class ExploredGround:
    """Ways over ground that is partly known.

    Parameters
    ----------
    rules : World
        What is known beforehand, of `ruled_world`.
    seen : OccupancyMap
        What was seen; `grown` is to be called when cells of it have become occupied or free.
    least_m : float, default 0
        How far every body keeps off what was seen, metres, however narrow it is.
    """

    rules: World
    seen: OccupancyMap
    least_m: float = 0.0
    _made: dict[tuple[Body, int], _Finder] = field(default_factory=dict, init=False, repr=False)
    _ruled: dict[tuple[Body, int], Bools] = field(default_factory=dict, init=False, repr=False)

    def grown(self) -> None:
        """Forget what was made of the map as it was."""
        self._made.clear()

    def close(self, rules: World) -> None:
        """Take over rules that have changed: doors that have closed or opened."""
        self.rules = rules
        self._ruled.clear()
        self._made.clear()

    def way(self, body: Body, start: Sequence[float], goal: Sequence[float]) -> Path | NoPath:
        """Return the shortest way by what is known, or the reason why that leaves none."""
        return self.sure_way(body, start, goal)[0]

    def sure_way(self, body: Body, start: Sequence[float], goal: Sequence[float]) -> tuple[Path | NoPath, int]:
        """Return the way as `way` does, and of which pass it is."""
        a, b = np.array(start[:2], dtype=np.float64), np.array(goal[:2], dtype=np.float64)
        if not self.stands(body, b):
            blocked = not_free(True, False, a, b)
            assert blocked is not None
            return blocked, CERTAIN
        points = self._finder(body, CERTAIN).way(a, b)
        if points is not None:
            return Path(without_repetitions(points)), CERTAIN
        found = None if self.seen.fills_cells else self._tight_way(body, a, b)
        return disconnected(a, b) if found is None else Path(without_repetitions(found)), POSSIBLE

    def _tight_way(self, body: Body, start: Floats, goal: Floats) -> Floats | None:
        """Return a way of the second pass, in the middle of what is narrow; None where all that is left is too narrow.

        Where a way does not fit after all its cells are blocked, and another is sought.
        """
        finder, room_m = self._finder(body, POSSIBLE), self._room_m(body)
        tree = self.seen.tree()
        while (points := finder.way(start, goal)) is not None:
            cell_m = self.seen.frame.resolution_m
            points, narrow = in_the_middle(points, tree, cell_m, room_m + _SPARE * cell_m, room_m * _FITS)
            if not len(narrow):
                return points
            finder = self._made[body, POSSIBLE] = finder.without(narrow)
        return None

    def lengths(self, body: Body, exits: Floats, entries: Floats) -> Floats:
        """Return the lengths (n, m) of ways from exits (n, d) to entries (m, d), metres; inf where there is none."""
        metres = np.full((len(exits), len(entries)), math.inf)
        stands = np.array([self.stands(body, place) for place in entries[:, :2]], dtype=np.bool_)
        for certainty in PASSES:
            open_ = np.isinf(metres) & stands
            if open_.any():
                rows, columns = open_.any(axis=1), open_.any(axis=0)
                found = self._finder(body, certainty).lengths(exits[rows, :2], entries[columns, :2])
                some = np.ix_(rows, columns)
                metres[some] = np.minimum(metres[some], found)
        return metres

    def stands(self, body: Body, place: Floats) -> bool:
        """Return whether a body can stand at a place, as far as is known."""
        if not self._may_be(body, place[None, :2])[0]:
            return False
        return self.seen.nearest_m(place[:2]) >= self._room_m(body) * (1 - _SLACK)

    def is_clear(self, body: Body, points: Floats, certainty: int, cells: Indices) -> bool:
        """Return whether no obstacle in cells (n, 2) is too near to the line through points (k, 2).

        A way of the second pass may be a little nearer than the body is wide. A body of no width keeps off by what
        cells round off, as lines between two points that were hit are not clear.
        """
        if not len(cells):
            return True
        room_m = self._room_m(body)
        spare = (_SLACK if certainty == CERTAIN else 1 - _FITS) * room_m
        least_m = max(room_m - spare, _HALF * self.seen.frame.resolution_m)
        return bool(self.seen.from_line_m(points, cells).min() >= least_m)

    def is_free(self, body: Body, points: Floats) -> bool:
        """Return whether a body can stand at points (k, d), and go straight from each to the next."""
        points = points[:, :2]
        return all(self.stands(body, point) for point in points) and (
            len(points) < 2 or self._finder(body, POSSIBLE).sees(points)
        )

    def free_cells(self, body: Body, certainty: int = CERTAIN) -> Bools:
        """Return which cells are free for a body as far as is known, unseen ones included."""
        return ~self._finder(body, certainty).blocked

    def _room_m(self, body: Body) -> float:
        """Return how far a body keeps off what was seen, in metres."""
        return max(body.radius_m, self.least_m)

    def _may_be(self, body: Body, places: Floats) -> Bools:
        return free(self.rules.free_space(body.radius_m, body.kind), places)

    def _finder(self, body: Body, certainty: int) -> _Finder:
        key = (body, certainty)
        if key not in self._made:
            self._made[key] = _Finder(self.seen.frame, self._blocked(body, certainty), self.seen.clearances)
        return self._made[key]

    def _blocked(self, body: Body, certainty: int) -> Bools:
        """Return the cells that are blocked by rule, and those whose centres are too near to what was hit."""
        cell_m = self.seen.frame.resolution_m
        if self.seen.fills_cells:
            least = max(self._room_m(body) * (1 - _SLACK), _SLACK * cell_m)
        else:
            spare = _HALF + _SPARE if certainty == CERTAIN else -_HALF
            least = max(self._room_m(body) + spare * cell_m, _HALF * cell_m)
        self.seen.require_clearance(least + cell_m)
        near: Bools = self.seen.clearances < least
        return self._by_rule(body, certainty) | near

    def _by_rule(self, body: Body, certainty: int) -> Bools:
        key = (body, certainty)
        if key not in self._ruled:
            import shapely

            frame = self.seen.frame
            radius_m = body.radius_m - (2 * _HALF * frame.resolution_m if certainty == POSSIBLE else 0.0)
            space = self.rules.free_space(max(radius_m, 0.0), body.kind)
            assert isinstance(space, PolygonSpace)
            rows, columns = frame.shape
            beyond = shapely.difference(shapely.box(0, 0, columns, rows), in_cells(space.region, frame))
            self._ruled[key] = touched(beyond, frame.shape)
        return self._ruled[key]


class _Finder:
    """Shortest ways through the free cells of one pass; ends beside them are joined to the nearest."""

    def __init__(self, frame: Grid, blocked: Bools, clearances: npt.NDArray[np.float32]) -> None:
        self.blocked, self._clearances = blocked, clearances
        self._grid = Grid(blocked, frame.resolution_m, frame.origin)
        self._finder = PathFinder(GridSpace(self._grid))

    def way(self, start: Floats, goal: Floats) -> Floats | None:
        begin, end = self._joined(start, _SNAP_CELLS * 4), self._joined(goal, _SNAP_CELLS)
        if begin is None or end is None:
            return None
        found = self._finder.path(begin, end)
        return None if isinstance(found, NoPath) else np.concatenate([[start], found.points, [goal]])

    def without(self, places: Floats) -> _Finder:
        """Return the finder of the same cells, with those blocked, too, that places (n, 2) are in."""
        blocked = self.blocked.copy()
        columns, rows = np.floor(self._grid.to_grid(places)).astype(np.int64).T
        blocked[np.clip(rows, 0, blocked.shape[0] - 1), np.clip(columns, 0, blocked.shape[1] - 1)] = True
        return _Finder(self._grid, blocked, self._clearances)

    def sees(self, points: Floats) -> bool:
        return self._finder.clear(points)

    def lengths(self, exits: Floats, entries: Floats) -> Floats:
        begins = [self._joined(place, _SNAP_CELLS * 4) for place in exits]
        ends = [self._joined(place, _SNAP_CELLS) for place in entries]
        metres = np.full((len(exits), len(entries)), math.inf)
        rows = [k for k, place in enumerate(begins) if place is not None]
        columns = [k for k, place in enumerate(ends) if place is not None]
        if rows and columns:
            leave, enter = np.array([begins[k] for k in rows]), np.array([ends[k] for k in columns])
            before = np.linalg.norm(leave - exits[rows], axis=1)[:, None]
            after = np.linalg.norm(enter - entries[columns], axis=1)
            metres[np.ix_(rows, columns)] = before + self._finder.lengths(leave, enter) + after
        same = (exits[:, None] == entries).all(axis=2)
        metres[same] = 0.0
        return metres

    def _joined(self, place: Floats, cells: int) -> Floats | None:
        """Return the place itself where it is free, or the nearest centre of a free cell within some cells."""
        column, row = self._grid.to_grid(place[None, :2])[0]
        height, width = self._grid.shape
        i, j = math.floor(row), math.floor(column)
        if 0 <= i < height and 0 <= j < width and not self.blocked[i, j]:
            return place
        top, left = max(0, i - cells), max(0, j - cells)
        free_ = np.argwhere(~self.blocked[top : i + cells + 1, left : j + cells + 1]) + np.array([top, left])
        apart = np.hypot(free_[:, 0] + 0.5 - row, free_[:, 1] + 0.5 - column)
        order = np.argsort(apart, kind="stable")
        for k in order[apart[order] <= cells][:_TRIED]:
            if self._gets_off(np.array([row, column]), free_[k] + 0.5):
                joined: Floats = self._grid.to_map(free_[None, k, ::-1] + 0.5)[0]
                return joined
        return None

    def _gets_off(self, start: Floats, end: Floats) -> bool:
        """Return whether a leg, in cells, only leads away from obstacles, as far as cells tell."""
        count = 2 + int(2 * np.abs(end - start).max())
        cells = np.floor(np.linspace(start, end, count)).astype(np.int64)
        height, width = self.blocked.shape
        away = self._clearances[np.clip(cells[:, 0], 0, height - 1), np.clip(cells[:, 1], 0, width - 1)]
        return bool(away.min() >= away[0] - 1.5 * self._grid.resolution_m)
