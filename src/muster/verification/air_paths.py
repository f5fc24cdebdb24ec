"""The judge's own shortest paths of a drone over, below and around prisms, within about 0.5 % of the optimum.

A shortest way in the air turns on upright edges and on rims of prisms. Points are taken on those edges, first few and
on coarse outlines, then ever closer to the best way found so far, on the true ones ([papadimitriou1985] takes points on
edges; here only near the way). Only prisms that some way has run into count: what is shortest without the others, and
meets none of them, is shortest among all.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from itertools import combinations
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from muster.mission.model import Point
from muster.motion.free_space import PrismSpace
from muster.motion.grid import Bools, Floats, Indices
from muster.motion.maps.free_points import free
from muster.verification.visibility_graph import VisibilityGraph

if TYPE_CHECKING:
    from shapely.geometry.base import BaseGeometry

_ROUNDING = 1e-9  # relative: what float64 may make of two equal lengths
_HAIR = 1e-9  # of the extent: so thin a layer of a prism may be touched
_COARSE = 0.02  # of a prism's width: how far coarse outlines may be off
_LEVELS = 5  # heights on an upright edge, at first
_FIRST_REACH = 0.1  # of the straight line: how far apart points on rims are, when they are first taken near a way
_ROUNDS = 7  # of taking points closer
_CLOSER = 0.4  # how much closer each time


class AirPaths:
    """Shortest ways in a PrismSpace."""

    def __init__(self, space: PrismSpace) -> None:
        import shapely

        self._space = space
        self._lowest = space.lowest_m
        west, south, east, north = (0.0, 0.0, 1.0, 1.0) if space.region.is_empty else space.region.bounds
        extent = max(east - west, north - south)
        margin = 0.05 * extent
        around = shapely.box(west - margin, south - margin, east + margin, north + margin)
        blocks = [_Block(shapely.difference(around, space.region), -math.inf, math.inf)]
        blocks += [_Block(prism.polygon, prism.floor_m, prism.ceiling_m) for prism in space.prisms]
        hair = _HAIR * extent
        self._obstacles = [_Obstacle.of(block, hair) for block in (*blocks, *_joints(blocks, hair))]
        self._known: dict[tuple[Point, Point], float | None] = {}

    def metres(self, start: Point, end: Point) -> float | None:
        """The length of a shortest way between two points (x, y, z); None where none is found."""
        pair = (min(start, end), max(start, end))
        if pair not in self._known:
            ends = np.array(pair, dtype=np.float64)
            self._known[pair] = self._length(ends) if free(self._space, ends).all() else None
        return self._known[pair]

    def _length(self, ends: Floats) -> float | None:
        met: list[_Obstacle] = []
        way = ends
        while True:
            new = [o for o in self._obstacles if o not in met and not o.clear(way[:-1], way[1:]).all()]
            if not new:
                return float(np.linalg.norm(np.diff(way, axis=0), axis=1).sum())
            met += new
            best = self._best(ends, met)
            if best is None:
                return None
            way = best

    def _best(self, ends: Floats, met: list[_Obstacle]) -> Floats | None:
        """The shortest way (k, 3) among some obstacles; None if there is none."""
        heights = [float(z) for o in met for z in (o.floor, o.ceiling) if math.isfinite(z)]
        low, high = min(*ends[:, 2], *heights), max(*ends[:, 2], *heights)
        low = max(low, min(self._lowest, *ends[:, 2]))
        levels = np.unique(np.concatenate([np.linspace(low, high, _LEVELS), ends[:, 2]]))
        along = _FIRST_REACH * float(np.linalg.norm(ends[1] - ends[0]))
        spread = max((high - low) / (_LEVELS - 1), 0.2 * along)
        coarse = [o.coarse_points(levels) for o in met]
        in_gaps = [_raised(corners, levels) for corners in _beside_gaps(met)]
        way = self._through(ends, [*coarse, *in_gaps], met)
        if way is None:  # a gap of one obstacle's own may be too narrow for coarse outlines
            way = self._through(ends, [*coarse, *(_raised(o.corners, levels) for o in met)], met)
        for _ in range(_ROUNDS):
            if way is None:
                break
            way = self._through(ends, [way[1:-1], *(o.points_near(way, spread, along) for o in met)], met)
            spread, along = _CLOSER * spread, _CLOSER * along
        return way

    def _through(self, ends: Floats, points: list[Floats], met: list[_Obstacle]) -> Floats | None:
        nodes = np.unique(np.concatenate(points), axis=0)
        nodes = nodes[nodes[:, 2] >= min(self._lowest, *ends[:, 2])]
        for obstacle in met:
            nodes = nodes[~obstacle.holds(nodes, obstacle.hair)]
        nodes = np.concatenate([ends, nodes])
        pairs = np.stack(np.triu_indices(len(nodes), 1), axis=1)
        upright = (nodes[pairs[:, 0], :2] == nodes[pairs[:, 1], :2]).all(axis=1)
        pairs = pairs[~upright | (pairs[:, 0] < len(ends))]
        for obstacle in met:
            pairs = pairs[obstacle.clear(nodes[pairs[:, 0]], nodes[pairs[:, 1]])]
        way: Indices | None = VisibilityGraph(nodes, pairs).way(0, 1)
        return None if way is None else nodes[way]


class _Block(NamedTuple):
    """An upright body: its shape in the plane and its height range, metres."""

    shape: BaseGeometry
    floor: float
    ceiling: float


def _joints(blocks: Sequence[_Block], hair: float) -> Iterator[_Block]:
    """Blocks that close the slits without width between those that touch, beside each other or one upon the other."""
    import shapely

    for one, other in combinations(sorted(blocks, key=lambda block: block.floor), 2):
        if not shapely.dwithin(one.shape, other.shape, 2 * hair):
            continue
        shared = min(one.ceiling, other.ceiling)
        if shared - other.floor > 2 * hair:
            yield _Block(shapely.union(one.shape, other.shape), other.floor, shared)
        elif other.floor - one.ceiling <= 2 * hair:
            both = shapely.intersection(one.shape, other.shape)
            if both.area > 0:
                yield _Block(both, one.floor, other.ceiling)


@dataclass(frozen=True, eq=False)
class _Obstacle:
    """A block with its inside, smaller by a hair, and an outline of few corners around it."""

    floor: float
    ceiling: float
    outline: BaseGeometry
    inside: BaseGeometry
    around: BaseGeometry
    corners: Floats
    coarse: Floats
    width: float
    hair: float

    @classmethod
    def of(cls, block: _Block, hair: float) -> _Obstacle:
        import shapely

        west, south, east, north = block.shape.bounds
        width = max(east - west, north - south)
        off = _COARSE * width
        coarse = shapely.buffer(shapely.simplify(block.shape, off), 1.01 * off, join_style="mitre")
        inside = shapely.buffer(block.shape, -hair, join_style="mitre")
        shapely.prepare(inside)
        corners, few = (np.unique(shapely.get_coordinates(shape), axis=0) for shape in (block.shape, coarse))
        return cls(block.floor, block.ceiling, block.shape, inside, coarse, corners, few, width, hair)

    def holds(self, points: Floats, slack: float) -> Bools:
        """Whether points (n, 3) are inside by more than the slack."""
        import shapely

        deep = shapely.buffer(self.outline, -slack, join_style="mitre")
        heights = points[:, 2]
        between = (heights > self.floor + slack) & (heights < self.ceiling - slack)
        return np.asarray(between & shapely.intersects(deep, shapely.points(points[:, :2])))

    def clear(self, starts: Floats, ends: Floats) -> Bools:
        """Whether straight lines (n, 3) to (n, 3) stay out: what of each is between floor and ceiling."""
        import shapely

        rise = ends[:, 2] - starts[:, 2]
        with np.errstate(divide="ignore", invalid="ignore"):
            at = np.array([self.floor + self.hair - starts[:, 2], self.ceiling - self.hair - starts[:, 2]]) / rise
        level = (starts[:, 2] > self.floor + self.hair) & (starts[:, 2] < self.ceiling - self.hair)
        first = np.where(rise == 0, np.where(level, 0.0, 1.0), np.clip(at.min(axis=0), 0, 1))
        last = np.where(rise == 0, np.where(level, 1.0, 0.0), np.clip(at.max(axis=0), 0, 1))
        clear = np.ones(len(starts), dtype=np.bool_)
        within = np.flatnonzero(first < last)
        step = ends[within, :2] - starts[within, :2]
        pieces = np.stack([starts[within, :2] + share[within, None] * step for share in (first, last)], axis=1)
        near = self._near(pieces)
        clear[within[near]] = ~shapely.intersects(self.inside, shapely.linestrings(pieces[near]))
        return clear

    def _near(self, pieces: Floats) -> Bools:
        """Which straight pieces (n, 2, 2) meet the box around the inside: neither axis nor the piece parts them."""
        box = np.array(self.inside.bounds).reshape(2, 2)
        middle, half = box.mean(axis=0), (box[1] - box[0]) / 2
        aside = (pieces.min(axis=1) > box[1]) | (pieces.max(axis=1) < box[0])
        along, off = pieces[:, 1] - pieces[:, 0], middle - pieces[:, 0]
        beside = np.abs(along[:, 0] * off[:, 1] - along[:, 1] * off[:, 0]) > np.abs(along) @ half[::-1] * (
            1 + _ROUNDING
        )
        return np.asarray(~aside.any(axis=1) & ~beside)

    def coarse_points(self, levels: Floats) -> Floats:
        """Points (n, 3) on the coarse outline: its corners at all levels, and its rims."""
        import shapely

        rings = shapely.get_rings(shapely.get_parts(shapely.segmentize(self.outline, max(self.width / 6, self.hair))))
        rims = np.unique(shapely.get_coordinates(rings), axis=0) if self._rims() else np.empty((0, 2))
        return np.concatenate([_raised(self.coarse, levels), _raised(rims, self._rims())])

    def points_near(self, way: Floats, spread: float, along: float) -> Floats:
        """Points (n, 3) on the outline's own edges near a way (k, 3).

        They are `spread` apart in height, and `along` in the plane.
        """
        import shapely

        line = shapely.LineString(way[:, :2])
        near = self.corners[shapely.dwithin(line, shapely.points(self.corners), 3 * _COARSE * self.width)]
        heights = np.interp(
            shapely.line_locate_point(line, shapely.points(near)),
            np.concatenate([[0.0], np.cumsum(np.hypot(*np.diff(way[:, :2], axis=0).T))]),
            way[:, 2],
        )
        upright = [np.column_stack([near, heights + k * spread]) for k in (-1, 0, 1)]
        found = [np.empty((0, 2))]
        for ring in shapely.get_rings(shapely.get_parts(self.outline)) if self._rims() else ():
            place = shapely.line_locate_point(ring, shapely.points(way[1:-1, :2]))
            places = (place[:, None] + along * np.arange(-2, 3)).ravel() % ring.length
            found.append(shapely.get_coordinates(shapely.line_interpolate_point(ring, places)))
        rims = np.concatenate(found)
        if len(rims):
            rims = rims[shapely.dwithin(line, shapely.points(rims), 3 * along + 3 * _COARSE * self.width)]
        return np.concatenate([*upright, _raised(np.concatenate([rims, near]), self._rims())])

    def _rims(self) -> list[float]:
        return [height for height in (self.floor, self.ceiling) if math.isfinite(height)]


def _beside_gaps(obstacles: Sequence[_Obstacle]) -> Iterator[Floats]:
    """Corners (n, 2) beside each gap between two obstacles that their coarse outlines close."""
    import shapely

    for one, other in combinations(obstacles, 2):
        level = max(one.floor, other.floor) < min(one.ceiling, other.ceiling)
        if level and one.around.intersects(other.around) and not one.outline.intersects(other.outline):
            closed = shapely.intersection(one.around, other.around)
            for obstacle in (one, other):
                at = shapely.points(obstacle.corners)
                yield obstacle.corners[shapely.dwithin(closed, at, 2 * _COARSE * obstacle.width)]


def _raised(feet: Floats, heights: Floats | list[float]) -> Floats:
    """Every foot (n, 2) at every height (m,): (n * m, 3)."""
    levels = np.asarray(heights, dtype=np.float64)
    return np.column_stack([np.repeat(feet, len(levels), axis=0), np.tile(levels, len(feet))])
