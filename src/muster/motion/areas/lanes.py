"""Lanes along x that see a whole region, whatever its shape.

The region is cut into strips of one height, no higher than what is seen across a lane. A lane runs along the middle of
each strip where that is inside the region, and sees the rectangle around it. What no lane sees lies in half a strip, at
slanted edges and in corners. A piece of it is seen from one short lane between two of its corners, else from the
longest side of each triangle of a triangulation: the height of a triangle over its longest side is no more than its
extent in any direction, and that is half a strip at most. So every way along lanes stays inside the region; but lanes
go on over the border by as much as ways may, where that spares a short lane along a sliver.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass, replace
from itertools import combinations
from typing import TYPE_CHECKING, Any, cast

import numpy as np
import numpy.typing as npt

from muster.mission.values.arrays import Floats
from muster.motion.areas.region import Region, Surface

if TYPE_CHECKING:
    import shapely

_WHOLE = 1e-9
"""A height that is a whole number of strips but for rounding has no strip more."""
_SEEN = 1 - 1e-6
"""Of the width: so that what is seen of neighbouring strips overlaps, whatever the rounding."""
_SPECK = 1e-9
"""Of a square of the width: smaller pieces that are left are rounding."""
_MOST_CORNERS = 8
"""Of a piece, between all of which lanes are tried."""


@dataclass(frozen=True, eq=False)
class Lanes:
    """The lanes over a region, in the frame in which most run along x.

    Parameters
    ----------
    region
        the region.
    width_m
        of what is seen from a lane.
    strips
        how many strips there are.
    rows
        (n, 2, 2) west and east end of each lane in the middle of a strip, from south to north and west to east.
    numbers
        (n) the number of its strip.
    rest
        what is not seen from rows.
    """

    region: Region
    width_m: float
    strips: int
    rows: Floats
    numbers: npt.NDArray[np.int64]
    rest: Surface

    @classmethod
    def over(cls, region: Region, width_m: float) -> Lanes:
        """The lanes that see a region, of each of which so wide a strip is seen."""
        import shapely

        west, south, east, north = region.seen.bounds
        count = math.ceil(strip_count(region, width_m))
        middles = south + (np.arange(count) + 0.5) * (north - south) / count
        rows, numbers = _rows(region, middles, west - width_m, east + width_m)
        side_by_side = max(width_m * _SEEN, (north - south) / count)

        def unseen(rows: Floats) -> Surface:
            return cast("Surface", shapely.difference(region.seen, shapely.union_all(swaths(rows, side_by_side))))

        lanes = cls(region, width_m, count, rows, numbers, unseen(rows))
        longer = lanes._over_slivers()
        return lanes if np.array_equal(longer, rows) else replace(lanes, rows=longer, rest=unseen(longer))

    def _over_slivers(self) -> Floats:
        """The rows, longer by slivers at their ends, but not into holes."""
        import shapely

        _, south, _, north = self.region.seen.bounds
        rows = self.rows.copy()
        for piece in _pieces(self.rest, self.region, self.strips, self.width_m):
            west, low, east, high = piece.bounds
            if east - west > self.region.over_m:
                continue
            strip = math.floor(((low + high) / 2 - south) / (north - south) * self.strips)
            for k in np.flatnonzero(self.numbers == strip):
                (begin, _), (end, _) = self.rows[k]
                if abs(end - west) <= self.region.over_m:
                    rows[k, 1, 0] = max(rows[k, 1, 0], east)
                if abs(begin - east) <= self.region.over_m:
                    rows[k, 0, 0] = min(rows[k, 0, 0], west)
        inside = np.asarray(shapely.covers(self.region.within, shapely.linestrings(rows)))
        found: Floats = np.where(inside[:, None, None], rows, self.rows)
        return found

    def short(self) -> Floats:
        """(m, 2, 2) the ends of short lanes from which the rest is seen."""
        pieces = _pieces(self.rest, self.region, self.strips, self.width_m)
        found = [lane for piece in pieces for lane in _short_lanes(piece, self.region, self.rows, self.width_m * _SEEN)]
        return np.array(found, dtype=np.float64).reshape(-1, 2, 2)

    def estimate_m(self, cells: int) -> float:
        """About how long the way along all lanes is, if these form so many cells."""
        import shapely

        bounds = shapely.bounds(shapely.get_parts(self.rest)).reshape(-1, 4)
        west, south, east, north = self.region.seen.bounds
        short = float((bounds[:, 2] - bounds[:, 0]).sum()) + len(bounds) * self.width_m / 2
        between = (len(self.rows) - cells) * self.width_m + (cells - 1) * math.hypot(east - west, north - south) / 4
        return float((self.rows[:, 1, 0] - self.rows[:, 0, 0]).sum()) + short + between


def strip_count(region: Region, width_m: float) -> float:
    """How many strips a region needs, as a number that may be huge."""
    _, south, _, north = region.seen.bounds
    return max(1.0, (north - south) / width_m - _WHOLE)


def swaths(lanes: Floats, width_m: float) -> npt.NDArray[Any]:
    """(n) the rectangles that are seen from lanes (n, 2, 2): from end to end, half the width to each side."""
    import shapely

    begin, end = lanes[:, 0], lanes[:, 1]
    way = end - begin
    lengths = np.linalg.norm(way, axis=1, keepdims=True)
    ahead = np.divide(way, lengths, out=np.tile([1.0, 0.0], (len(lanes), 1)), where=lengths > 0)
    aside = width_m / 2 * np.column_stack([-ahead[:, 1], ahead[:, 0]])
    corners = np.stack([begin - aside, end - aside, end + aside, begin + aside], axis=1)
    return np.asarray(shapely.polygons(corners))


def _rows(region: Region, middles: Floats, west: float, east: float) -> tuple[Floats, npt.NDArray[np.int64]]:
    """The lanes in the middle of strips, and the number of each one's strip."""
    import shapely

    ends = np.stack([np.column_stack([np.full_like(middles, x), middles]) for x in (west, east)], axis=1)
    inside = shapely.intersection(region.seen, shapely.linestrings(ends))
    parts, strips = shapely.get_parts(inside, return_index=True)
    bounds = shapely.bounds(parts)
    order = np.lexsort((bounds[:, 0], strips))
    found: list[list[float]] = []
    numbers: list[int] = []
    for x_from, x_to, strip in zip(bounds[order, 0], bounds[order, 2], strips[order], strict=True):
        if numbers and numbers[-1] == strip and x_from <= found[-1][1] + region.rounding_m:
            found[-1][1] = max(found[-1][1], x_to)  # one lane, which touches a corner
        elif x_to > x_from:
            found.append([x_from, x_to])
            numbers.append(int(strip))
    spans, of = np.array(found).reshape(-1, 2), np.array(numbers, dtype=np.int64)
    return np.stack([spans, np.repeat(middles[of][:, None], 2, axis=1)], axis=2), of


def _pieces(rest: Surface, region: Region, strips: int, width_m: float) -> Iterator[shapely.Polygon]:
    """What is left, cut into pieces none of which is higher than half a strip."""
    import shapely

    _, south, _, north = region.seen.bounds
    halves = 2 * strips
    half_m = (north - south) / halves
    for part in shapely.get_parts(rest):
        if part.geom_type != "Polygon" or part.area <= _SPECK * width_m**2:
            continue
        west, low, east, high = part.bounds
        first = max(0, math.floor((low - south) / half_m + 1e-9))
        last = min(halves - 1, math.ceil((high - south) / half_m - 1e-9) - 1)
        if last <= first:
            yield part
            continue
        for k in range(first, last + 1):
            box = shapely.box(west, south + k * half_m, east, south + (k + 1) * half_m)
            for piece in shapely.get_parts(shapely.intersection(part, box)):
                if piece.geom_type == "Polygon" and piece.area > _SPECK * width_m**2:
                    yield piece


def _short_lanes(piece: shapely.Polygon, region: Region, rows: Floats, width_m: float) -> list[Floats]:
    """Lanes inside the region from which the whole piece is seen."""
    import shapely

    tried = _between_corners(piece, rows)
    inside = shapely.covers(region.within, shapely.linestrings(tried))
    tried = tried[inside]
    left = shapely.area(shapely.difference(piece, swaths(tried, width_m))) <= _SPECK * width_m**2
    if left.any():
        return [tried[int(np.argmax(left))]]
    return _sides_of_triangles(piece, width_m)


def _between_corners(piece: shapely.Polygon, rows: Floats) -> Floats:
    """(k, 2, 2) lanes between the corners of a piece, the cheapest first, with the way to the nearest lane's end."""
    import shapely

    corners = shapely.get_coordinates(piece.exterior)[:-1]
    if len(corners) > _MOST_CORNERS:
        corners = corners[np.unique([*corners.argmin(axis=0), *corners.argmax(axis=0)])]
    ends = rows.reshape(-1, 2)
    away = np.linalg.norm(corners[:, None] - ends[None], axis=2).min(axis=1) if len(ends) else np.zeros(len(corners))
    pairs = np.array(list(combinations(range(len(corners)), 2)))
    lanes = corners[pairs]
    costs = np.linalg.norm(lanes[:, 1] - lanes[:, 0], axis=1) + away[pairs].min(axis=1)
    found: Floats = lanes[np.argsort(costs, kind="stable")]
    return found


def _sides_of_triangles(piece: shapely.Polygon, width_m: float) -> list[Floats]:
    """The longest sides of triangles, the largest triangle first, as far as they see something new."""
    import shapely

    triangles = shapely.get_parts(shapely.constrained_delaunay_triangles(piece))
    left: Surface = piece
    found: list[Floats] = []
    for triangle in triangles[np.argsort(-shapely.area(triangles), kind="stable")]:
        if shapely.intersection(left, triangle).area <= _SPECK * width_m**2:
            continue
        corners = shapely.get_coordinates(triangle)
        sides = np.stack([corners[:-1], corners[1:]], axis=1)
        side = sides[np.argmax(np.linalg.norm(sides[:, 1] - sides[:, 0], axis=1))]
        found.append(side)
        left = shapely.difference(left, swaths(side[None], width_m)[0])
    return found
