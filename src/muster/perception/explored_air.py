"""The air as robots know it that have no map: ways through voxels, as `explored_ground` has them in the plane.

What was not seen counts as free ([koenig2005]). A way that was found stays the shortest as long as what is seen later
leaves it open, since obstacles only make ways longer; so ways are kept, and sought anew only where they are closed.
"""

from __future__ import annotations

import itertools
import math
from collections.abc import Collection, Sequence
from dataclasses import dataclass, field

import numpy as np

from muster.mission.mission_parts import positions
from muster.mission.model import Mission
from muster.motion.free_space import PrismSpace
from muster.motion.grid import Bools, Floats
from muster.motion.map_world import Body, World
from muster.motion.maps.free_points import free
from muster.motion.path import NoPath, Path
from muster.motion.paths.on_grid import without_repetitions
from muster.motion.paths.planner import disconnected, not_free
from muster.motion.voxels import VoxelFrame, VoxelWays
from muster.perception.explored_ground import CERTAIN, POSSIBLE, is_obstacle
from muster.perception.tight_ways import dense, in_the_middle
from muster.perception.voxel_map import VoxelMap

MOST_VOXELS = 600_000
"""Of a map, about."""
_HALF = math.sqrt(0.75)
"""From the centre of a voxel to its corners, in voxels."""
_SPARE, _NEAR = 0.3, 0.2
"""Of a voxel by which ways are farther off than the body is wide, where that is certain, and in narrow places.

Surfaces lie anywhere between the points that stand for them."""
_SNAP_CELLS = 4
"""Voxels between a place that is free and the nearest voxel that is free for certain, at most."""
_TRIED = 50
"""Voxels to which an end of a way may be joined, at most."""
_MOST_WAYS = 5_000
"""Ways that are kept."""
_SLACK = 1e-6
"""Of a radius, by which a place may be too near to what was hit."""


def air_to_build(world: World, mission: Mission, radii_m: Collection[float]) -> VoxelMap:
    """Return an empty map of the air for bodies of some radii: as high as places and obstacles, and room above."""
    assert world.boundary is not None
    west, south, east, north = world.boundary.bounds
    widest = max(radii_m)
    tops = [area.ceiling_m for area in world.areas if is_obstacle(area) and math.isfinite(area.ceiling_m)]
    places = [place[2] for _, place in positions(mission) if len(place) == 3]
    room_m = 2 * widest + max(east - west, north - south) / 30
    low = np.array([west, south, world.lowest_m])
    high = np.array([east, north, max([*tops, *places, world.lowest_m]) + room_m])
    frame = VoxelFrame.over(low, high, min(radii_m) / 2, MOST_VOXELS)
    return VoxelMap(frame, widest + (_HALF + _SPARE + 1) * frame.cell_m)


@dataclass
class _Known:
    """A way that was found, None where there is none, and up to which obstacle it was compared with what was seen."""

    points: Floats | None
    seen: int


@dataclass(eq=False)
class ExploredAir:
    """Ways through air that is partly known.

    Parameters
    ----------
    rules : World
        What is known beforehand, of `ruled_world`.
    seen : VoxelMap
        What was seen.
    """

    rules: World
    seen: VoxelMap
    _finders: dict[tuple[Body, int], _Finder] = field(default_factory=dict, init=False, repr=False)
    _ruled: dict[Body, Bools] = field(default_factory=dict, init=False, repr=False)
    _ways: dict[tuple[Body, tuple[float, ...], tuple[float, ...]], _Known] = field(
        default_factory=dict, init=False, repr=False
    )
    _fresh: Floats = field(default_factory=lambda: np.empty((0, 3)), init=False, repr=False)

    def grown(self, fresh: Floats) -> None:
        """Take note that the map has changed: obstacles at points (n, 3) are new; without any some have gone."""
        self._finders.clear()
        if len(fresh):
            self._fresh = np.concatenate([self._fresh, fresh])
        else:
            self._forget_ways()

    def close(self, rules: World) -> None:
        """Take over rules that have changed: doors that have closed or opened."""
        self.rules = rules
        self._ruled.clear()
        self._finders.clear()
        self._forget_ways()

    def way(self, body: Body, start: Sequence[float], goal: Sequence[float]) -> Path | NoPath:
        """Return the shortest way by what is known, or the reason why that leaves none."""
        a, b = np.array(start, dtype=np.float64), np.array(goal, dtype=np.float64)
        if not self.stands(body, b):
            blocked = not_free(True, False, a, b)
            assert blocked is not None
            return blocked
        points = self._way(body, a, b)
        return disconnected(a, b) if points is None else Path(without_repetitions(points))

    def reached(self, body: Body, exits: Floats, entries: Floats) -> Bools:
        """Return which entries (m, 3) ways of the first pass lead to from some of the exits (n, 3)."""
        finder = self._finder(body, CERTAIN)
        parts = {finder.part(place, 4 * _SNAP_CELLS) for place in exits} - {0}
        return np.array([self.stands(body, place) and finder.part(place, _SNAP_CELLS) in parts for place in entries])

    def lengths(self, body: Body, exits: Floats, entries: Floats) -> Floats:
        """Return the lengths (n, m) of ways from exits (n, 3) to entries (m, 3), metres; inf where there is none."""
        stands = [self.stands(body, place) for place in entries]
        metres = np.full((len(exits), len(entries)), math.inf)
        for row, start in enumerate(exits):
            for column, goal in enumerate(entries):
                if np.array_equal(start, goal):
                    metres[row, column] = 0.0
                elif stands[column] and (points := self._way(body, start, goal)) is not None:
                    metres[row, column] = np.linalg.norm(np.diff(points, axis=0), axis=1).sum()
        return metres

    def stands(self, body: Body, place: Floats) -> bool:
        """Return whether a body can be at a place, as far as is known."""
        if not free(self._space(body), place[None])[0]:
            return False
        away, _ = self.seen.tree().query(place) if self.seen.occupied.any() else (math.inf, 0)
        return bool(away >= body.radius_m * (1 - _SLACK))

    def is_clear(self, body: Body, points: Floats, obstacles: Floats) -> bool:
        """Return whether no obstacle of some at (n, 3) is too near to the line through points (k, 3)."""
        least_m = body.radius_m + _NEAR * self.seen.frame.cell_m / 2
        low, high = points.min(axis=0) - least_m, points.max(axis=0) + least_m
        near = obstacles[((low <= obstacles) & (obstacles <= high)).all(axis=1)]
        return not len(near) or _from_line_m(points, near) >= least_m

    def is_free(self, body: Body, points: Floats) -> bool:
        """Return whether a body can be at points (k, 3), and go straight from each to the next."""
        finder = self._finder(body, CERTAIN)
        if all(finder.ways.sees(a, b) for a, b in itertools.pairwise(points)):
            return True
        places = dense(points, self.seen.frame.cell_m / 2)
        if not free(self._space(body), places).all():
            return False
        away, _ = self.seen.tree().query(places) if self.seen.occupied.any() else (np.array([math.inf]), 0)
        return bool(np.min(away) >= self._least_m(body))

    def free_voxels(self, body: Body) -> Bools:
        """Return which voxels are free for a body as far as is known, unseen ones included."""
        return ~self._finder(body, CERTAIN).ways.blocked

    def _space(self, body: Body) -> PrismSpace:
        space = self.rules.free_space(body.radius_m, body.kind)
        assert isinstance(space, PrismSpace)
        return space

    def _least_m(self, body: Body) -> float:
        """How far a body is to be from points of obstacles, in narrow places."""
        return body.radius_m + _NEAR * self.seen.frame.cell_m

    def _way(self, body: Body, start: Floats, goal: Floats) -> Floats | None:
        key = (body, tuple(start.tolist()), tuple(goal.tolist()))
        known = self._ways.get(key)
        if known is not None and (known.points is None or self.is_clear(body, known.points, self._fresh[known.seen :])):
            known.seen = len(self._fresh)
            return known.points
        if len(self._ways) >= _MOST_WAYS:
            self._ways.clear()
        points = self._finder(body, CERTAIN).way(start, goal)
        if points is None:
            points = self._tight_way(body, start, goal)
        self._ways[key] = _Known(points, len(self._fresh))
        return points

    def _tight_way(self, body: Body, start: Floats, goal: Floats) -> Floats | None:
        """Return a way in the middle of what is narrow; None where all that is left is too narrow.

        Where a way does not fit after all its voxels are blocked, and another is sought.
        """
        if not self.seen.occupied.any():
            return None
        finder, cell_m, tree = self._finder(body, POSSIBLE), self.seen.frame.cell_m, self.seen.tree()
        while (points := finder.way(start, goal)) is not None:
            least_m = self._least_m(body)
            points, narrow = in_the_middle(points, tree, cell_m, least_m + 0.1 * cell_m, least_m)
            if not len(narrow):
                return points
            finder = self._finders[body, POSSIBLE] = finder.without(narrow, least_m)
        return None

    def _finder(self, body: Body, certainty: int) -> _Finder:
        key = (body, certainty)
        if key not in self._finders:
            cells = body.radius_m / self.seen.frame.cell_m
            least = cells + _HALF + _SPARE if certainty == CERTAIN else max(cells + _NEAR - 0.5, _HALF)
            self.seen.require_clearance((least + 1) * self.seen.frame.cell_m)
            if body not in self._ruled:
                self._ruled[body] = self.seen.frame.beyond(self._space(body))
            near: Bools = self.seen.clearances < least
            self._finders[key] = _Finder(VoxelWays(self.seen.frame, near | self._ruled[body]), self.seen)
        return self._finders[key]

    def _forget_ways(self) -> None:
        self._ways.clear()
        self._fresh = np.empty((0, 3))


@dataclass
class _Finder:
    """The shortest ways through the free voxels of one pass; ends beside them are joined to the nearest."""

    ways: VoxelWays
    seen: VoxelMap

    def way(self, start: Floats, goal: Floats) -> Floats | None:
        begin, end = self._joined(start, 4 * _SNAP_CELLS), self._joined(goal, _SNAP_CELLS)
        if begin is None or end is None:
            return None
        found = self.ways.way(begin, end)
        return None if found is None else np.concatenate([[start], found, [goal]])

    def part(self, place: Floats, cells: int) -> int:
        """Return the number of the connected part that a place is joined to; 0: it is joined to none."""
        joined = self._joined(place, cells)
        return 0 if joined is None else self.ways.part(joined)

    def without(self, places: Floats, least_m: float) -> _Finder:
        """Return the finder with those voxels blocked, too, that places (n, 3) are in, and narrow ones around them."""
        from scipy.ndimage import binary_dilation

        voxels, within = self.ways.frame.voxels(places)
        at = np.zeros_like(self.ways.blocked)
        at[tuple(voxels[within].T)] = True
        narrow = binary_dilation(at, np.ones((3, 3, 3)), mask=self.seen.clearances < least_m / self.ways.frame.cell_m)
        blocked: Bools = self.ways.blocked | at | narrow
        return _Finder(VoxelWays(self.ways.frame, blocked), self.seen)

    def _joined(self, place: Floats, cells: int) -> Floats | None:
        """Return the place itself where it is free, or the nearest centre of a free voxel within some voxels."""
        if self.ways.free(place):
            return place
        frame = self.ways.frame
        at = np.clip(np.floor(frame.to_cells(place)).astype(np.int64)[::-1], 0, np.array(frame.shape) - 1)
        low = np.maximum(at - cells, 0)
        part = tuple(slice(int(a), int(b) + cells + 1) for a, b in zip(low, at, strict=True))
        centres = frame.centres(np.argwhere(~self.ways.blocked[part]) + low)
        apart = np.linalg.norm(centres - place, axis=1)
        order = np.argsort(apart, kind="stable")
        for k in order[apart[order] <= cells * frame.cell_m][:_TRIED]:
            if self._gets_off(place, centres[k]):
                joined: Floats = centres[k]
                return joined
        return None

    def _gets_off(self, start: Floats, end: Floats) -> bool:
        """Return whether a leg only leads away from obstacles, as far as voxels tell."""
        frame = self.ways.frame
        voxels, within = frame.voxels(dense(np.array([start, end]), frame.cell_m / 2))
        away = self.seen.clearances[tuple(voxels[within].T)]
        return bool(not len(away) or away.min() >= away[0] - 1.5)


def _from_line_m(points: Floats, obstacles: Floats) -> float:
    """Return the least distance of obstacles (n, 3) from the line through points (k, 3), metres."""
    if len(points) == 1:
        return float(np.linalg.norm(obstacles - points[0], axis=1).min())
    a, way = points[:-1], np.diff(points, axis=0)
    square = np.maximum((way**2).sum(axis=1), 1e-12)
    share = np.clip(((obstacles[:, None] - a) * way).sum(axis=2) / square, 0.0, 1.0)
    apart = obstacles[:, None] - (a + share[..., None] * way)
    return float(np.linalg.norm(apart, axis=2).min())
