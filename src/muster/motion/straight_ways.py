"""Straight legs among closed areas: which of them enter a zone that is closed to a body, or leave the boundary.

A leg enters a zone where some point of it, at a height that the zone reaches, is nearer to the zone's polygon than the
radius; of a body without a radius, where it is inside. It leaves the boundary where a point is nearer to it than the
radius, or outside. Touching is allowed. In the plane heights are unknown, so that zones reach all heights; robots on
the ground pass below zones as `World.stopping` says. Drones rise and land upright: a leg with one end on the ground is
closed, too, where the column over that end is, or the level leg from its top.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np
import numpy.typing as npt

from muster.motion.grid import Bools, Floats
from muster.motion.map_world import Area, Body, World
from muster.motion.path import NoPath, Path

if TYPE_CHECKING:
    import shapely

_SLACK_M, _SLACK, _ULPS = 2e-9, 1e-9, 1e-14  # metres, of the extent, of the greatest coordinate: so deep is touching
_LEGS_AT_ONCE = 200_000
CLOSED = "closed area"
"""The reason of legs that do not exist."""


@dataclass(frozen=True, eq=False)
class _Block:
    """A zone for one body: legs may not meet `shape` where they are above `low` and below `high`.

    They meet it within `reach_m`, if that is above 0, else where they intersect it; never farther than `radius_m` from
    its `middle`.
    """

    name: str
    shape: shapely.Polygon | shapely.MultiPolygon
    reach_m: float
    low: float
    high: float

    @cached_property
    def middle(self) -> Floats:
        """The middle (2,) of the box around the shape."""
        west, south, east, north = self.shape.bounds
        return np.array([west + east, south + north]) / 2

    @cached_property
    def radius_m(self) -> float:
        """The radius of a circle around the middle that holds the shape, and what is within its reach."""
        west, south, east, north = self.shape.bounds
        return math.hypot(east - west, north - south) / 2 * (1 + _SLACK) + self.reach_m


class StraightWays:
    """Straight ways of one body, as far as they keep out of closed areas."""

    def __init__(self, world: World, body: Body) -> None:
        import shapely

        self._flies = world.dimensions == 3 and body.kind == "air"
        self._radius_m, self._ground_m = body.radius_m, world.lowest_m
        self._blocks = [self._block(area) for area in world.stopping(body, world.dimensions == 3)]
        for block in self._blocks:
            shapely.prepare(block.shape)
        self._within, self._edge, self._edge_m, self._is_convex = None, None, 0.0, True
        if world.boundary is not None and not world.is_unbounded:
            slack = _slack_m(world.boundary)
            self._within = shapely.buffer(world.boundary, slack, join_style="mitre")
            self._edge, self._edge_m = world.boundary.exterior, body.radius_m - slack
            self._is_convex = bool(world.boundary.equals(world.boundary.convex_hull))
            shapely.prepare(self._within)
            shapely.prepare(self._edge)

    def path(self, start: npt.ArrayLike, goal: npt.ArrayLike) -> Path | NoPath:
        """Return the straight path between two points of the map frame, or the reason why there is none."""
        ends = np.array([start, goal], dtype=np.float64)
        why = self.obstacle(ends[0], ends[1])
        if why is not None:
            return NoPath(CLOSED, f"the straight leg from {_shown(ends[0])} to {_shown(ends[1])} {why}")
        return Path(ends if (ends[0] != ends[1]).any() else ends[:1])

    def obstacle(self, start: Floats, end: Floats) -> str | None:
        """Return what the leg from one point to another does: `enters zone 2`, `leaves the boundary`; None: nothing."""
        starts, ends = _in_space(start[None]), _in_space(end[None])
        pieces = [(starts, ends, "")]
        if self._grounded(starts, ends)[0]:
            tops = _tops(starts, ends)
            pieces += [(starts, tops, " on take-off or landing"), (tops, ends, " on take-off or landing")]
        for from_, to, how in pieces:
            for block in self._blocks:
                if self._meets(block, from_, to)[0]:
                    return f"enters {block.name}{how}"
        return "leaves the boundary" if self._leaves(starts, ends)[0] else None

    def clear(self, points: Floats) -> bool:
        """Return whether the straight pieces through points (k, d) keep out of closed areas."""
        places = _in_space(points)
        return not self.crossed(places[: max(1, len(places) - 1)], places[min(1, len(places) - 1) :]).any()

    def lengths(self, exits: npt.ArrayLike, entries: npt.ArrayLike, *, threads: int = 1) -> Floats:
        """Return the lengths (n, m), metres, of legs from exits (n, 3) to entries (m, 3); inf where they are closed."""
        leave, enter = _in_space(np.asarray(exits)), _in_space(np.asarray(entries))
        metres = np.asarray(np.linalg.norm(leave[:, None] - enter[None], axis=2))
        metres[self.crossed(leave, leave)] = math.inf
        metres[:, self.crossed(enter, enter)] = math.inf
        both_ways = np.array_equal(leave, enter)  # then a leg is closed as the leg back is
        rows = max(1, _LEGS_AT_ONCE // max(1, len(enter)))
        for first in range(0, len(leave), rows):
            some = metres[first : first + rows]
            at, to = np.nonzero(np.triu(np.isfinite(some), first) if both_ways else np.isfinite(some))
            some[at, to] += np.where(self._between(leave[first + at], enter[to]), math.inf, 0.0)
        return np.maximum(metres, metres.T) if both_ways else metres

    def crossed(self, starts: Floats, ends: Floats) -> Bools:
        """Return which legs (k,) from starts (k, 3) to ends (k, 3) enter a closed zone or leave the boundary."""
        return np.asarray(self._leaves(starts, ends) | self._meets_any(starts, ends))

    def _between(self, starts: Floats, ends: Floats) -> Bools:
        """Which legs (k,) between places that are open are closed."""
        return self._meets_any(starts, ends) if self._is_convex else self.crossed(starts, ends)

    def _meets_any(self, starts: Floats, ends: Floats) -> Bools:
        """Which legs (k,) meet a block."""
        found = np.zeros(len(starts), dtype=np.bool_)
        grounded = self._grounded(starts, ends)
        for block in self._blocks:
            left = np.flatnonzero(~found)
            found[left] = self._meets(block, starts[left], ends[left])
            left = np.flatnonzero(~found & grounded)
            tops = _tops(starts[left], ends[left])
            found[left] = self._meets(block, starts[left], tops) | self._meets(block, tops, ends[left])
        return found

    def _grounded(self, starts: Floats, ends: Floats) -> Bools:
        """Whether each leg (k,) begins or ends with a drone on the ground."""
        lower, upper = np.minimum(starts[:, 2], ends[:, 2]), np.maximum(starts[:, 2], ends[:, 2])
        return np.asarray((lower <= self._ground_m) & (upper > lower) & self._flies)

    def is_open(self, points: Floats) -> bool:
        """Return whether no closed zone and no side of the boundary is near the convex hull of points (k, 3)."""
        import shapely

        hull = shapely.convex_hull(shapely.multipoints(points[:, :2]))
        if any(shapely.dwithin(block.shape, hull, block.reach_m) for block in self._blocks):
            return False
        return self._within is None or bool(
            shapely.covers(self._within, hull)
            and not (self._edge_m > 0 and shapely.dwithin(self._edge, hull, self._edge_m))
        )

    def _block(self, area: Area) -> _Block:
        import shapely

        name = f"zone {area.number}" + ("" if area.zone.id is None else f" ({area.zone.id})")
        slack, reach_m = _slack_m(area.polygon), self._radius_m
        low, high = (area.floor_m - reach_m, area.ceiling_m + reach_m) if self._flies else (-math.inf, math.inf)
        if reach_m > 2 * slack:
            return _Block(name, area.polygon, reach_m - slack, low + slack, high - slack)
        shape = shapely.buffer(area.polygon, -slack, join_style="mitre")
        return _Block(name, shape, 0.0, low + slack, high - slack)

    def _meets(self, block: _Block, starts: Floats, ends: Floats) -> Bools:
        """Whether each leg (k,) meets a block."""
        import shapely

        begin, end = _shares_between(starts[:, 2], ends[:, 2], block.low, block.high)
        from_, to = (starts + share[:, None] * (ends - starts) for share in (begin, end))
        near = (begin <= end) & (_distances(block.middle, from_, to) <= block.radius_m)
        legs = _lines(from_[near], to[near])
        shape, reach_m = block.shape, block.reach_m
        near[near] = shapely.dwithin(shape, legs, reach_m) if reach_m else shapely.intersects(shape, legs)
        return np.asarray(near)

    def _leaves(self, starts: Floats, ends: Floats) -> Bools:
        """Whether each leg (k,) leaves the boundary."""
        import shapely

        if self._within is None:
            return np.zeros(len(starts), dtype=np.bool_)
        legs = _lines(starts, ends)
        outside = ~shapely.covers(self._within, legs)
        if self._edge_m > 0:
            outside |= shapely.dwithin(self._edge, legs, self._edge_m)
        return np.asarray(outside)


def _tops(starts: Floats, ends: Floats) -> Floats:
    """The tops (k, 3) of the columns over the lower ends of legs."""
    rises = starts[:, 2] < ends[:, 2]
    feet = np.where(rises[:, None], starts[:, :2], ends[:, :2])
    return np.column_stack([feet, np.maximum(starts[:, 2], ends[:, 2])])


def _slack_m(polygon: shapely.Polygon) -> float:
    west, south, east, north = polygon.bounds
    return _SLACK_M + _SLACK * max(east - west, north - south) + _ULPS * max(map(abs, polygon.bounds))


def _shares_between(first: Floats, last: Floats, low: float, high: float) -> tuple[Floats, Floats]:
    """The shares (k,) of legs between which their heights are within a range; first > last: nowhere."""
    if math.isinf(low) and math.isinf(high):
        return np.zeros(len(first)), np.ones(len(first))
    rise = last - first
    level = rise == 0
    with np.errstate(divide="ignore", invalid="ignore"):
        at = np.array([(low - first) / rise, (high - first) / rise])
    begin, end = np.maximum(at.min(axis=0), 0.0), np.minimum(at.max(axis=0), 1.0)
    inside = (first > low) & (first < high)
    return np.where(level, np.where(inside, 0.0, 1.0), begin), np.where(level, np.where(inside, 1.0, 0.0), end)


def _distances(point: Floats, starts: Floats, ends: Floats) -> Floats:
    """The distances (k,) in the plane of legs from a point (2,)."""
    along, toward = (ends - starts)[:, :2], point - starts[:, :2]
    squares = np.einsum("ij,ij->i", along, along)
    shares = np.clip(np.einsum("ij,ij->i", toward, along) / np.where(squares > 0, squares, 1.0), 0.0, 1.0)
    return np.asarray(np.linalg.norm(toward - shares[:, None] * along, axis=1))


def _lines(starts: Floats, ends: Floats) -> npt.NDArray[np.object_]:
    """The legs in the plane; those without a length are points."""
    import shapely

    legs: npt.NDArray[np.object_] = np.asarray(shapely.linestrings(np.stack([starts[:, :2], ends[:, :2]], axis=1)))
    standing = (starts[:, :2] == ends[:, :2]).all(axis=1)
    legs[standing] = shapely.points(starts[standing, :2])
    return legs


def _in_space(points: Floats) -> Floats:
    """Points (k, 2) or (k, 3) with heights, 0 in the plane."""
    return points if points.shape[1] == 3 else np.column_stack([points, np.zeros(len(points))])


def _shown(point: Floats) -> str:
    return f"({', '.join(f'{c:g}' for c in point.tolist())})"
