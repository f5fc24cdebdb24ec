"""Exact lines of sight in a region of polygons, for the judge's shortest paths.

A shortest way turns only at the region's inward corners, and leaves each along a line that both its sides lie on one
side of. Sight is Shapely's, against the region made smaller by a hair: its corners are taken from one made smaller by
two, so that they see along its sides, and nothing passes where two free parts meet in one point. Ways so found are
longer than the shortest by less than 1e-8 of it.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from muster.motion.free_space import PolygonSpace
from muster.motion.grid import Bools, Floats, Indices
from muster.motion.maps.free_points import free as is_free

if TYPE_CHECKING:
    import shapely

    Region = shapely.Polygon | shapely.MultiPolygon

_HAIR = 1e-10  # of the region's extent
_TURN = 1e-5  # sine of an angle that may be rounding


class Regions:
    """Sight in a region. `corners` (c, 2), metres from the region's lower left corner, are where ways may turn."""

    unit_m = 1.0

    def __init__(self, space: PolygonSpace) -> None:
        import shapely

        self._space, region = space, space.region
        west, south, east, north = (0.0, 0.0, 1.0, 1.0) if region.is_empty else region.bounds
        self._origin = np.array([west, south])
        moved = shapely.transform(region, lambda points: points - self._origin)
        hair = _HAIR * max(east - west, north - south)
        self._open = shapely.buffer(moved, -hair, join_style="mitre")
        self._inner = shapely.buffer(moved, -2 * hair, join_style="mitre")
        self._hair = hair
        shapely.prepare(self._open)
        shapely.prepare(self._inner)
        self.corners, self._back, self._on = _inward_corners(self._inner)

    def settled(self, points: Floats) -> tuple[Floats, Bools]:
        """Points (n, 2) of the map frame, moved by a hair where they are on a border; and whether each is free."""
        import shapely

        places = points - self._origin
        if self._inner.is_empty:
            return places, np.zeros(len(places), dtype=np.bool_)
        marks = shapely.points(places)
        free = is_free(self._space, points)
        near = shapely.get_point(shapely.shortest_line(self._inner, marks), 0)
        return np.where(free[:, None], shapely.get_coordinates(near), places), free

    def between_corners(self) -> Indices:
        """Pairs (k, 2) of corners that see each other, where a way may turn at both."""
        found = [np.empty((0, 2), dtype=np.int64)]
        for i, corner in enumerate(self.corners):
            steps = self.corners[i + 1 :] - corner
            j = np.flatnonzero(_taut(self._back[i], self._on[i], steps))
            j = j[_taut(self._back[i + 1 + j], self._on[i + 1 + j], steps[j])] + i + 1
            found.append(np.stack([np.full(len(j), i), j], axis=1))
        pairs = np.concatenate(found)
        return pairs[self._sees(self.corners[pairs[:, 0]], self.corners[pairs[:, 1]])]

    def from_places(self, places: Floats) -> Indices:
        """Pairs (k, 2) of a place and a corner it sees, where a way may turn at the corner."""
        found = [np.empty((0, 2), dtype=np.int64)]
        for k, place in enumerate(places):
            taut = np.flatnonzero(_taut(self._back, self._on, place - self.corners))
            found.append(np.stack([np.full(len(taut), k), taut], axis=1))
        pairs = np.concatenate(found)
        return pairs[self._sees(places[pairs[:, 0]], self.corners[pairs[:, 1]])]

    def clear(self, start: Floats, end: Floats) -> bool:
        """Whether the straight line between two free places is free."""
        return bool(self._sees(start[None], end[None])[0])

    def _sees(self, starts: Floats, ends: Floats) -> Bools:
        import shapely

        return np.asarray(shapely.covers(self._open, shapely.linestrings(np.stack([starts, ends], axis=1))))


def _taut(back: Floats, on: Floats, steps: Floats) -> Bools:
    """Whether a way along each step can turn at a corner at its one end: the corner's sides are on one side of it.

    `back` and `on` are directions (2,) or (n, 2) of the corner's sides, `steps` (n, 2) lead to it or from it.
    """
    doubt = _TURN * np.hypot(steps[:, 0], steps[:, 1])
    before, after = _cross(steps, back), _cross(steps, on)
    return np.asarray((np.minimum(before, after) >= -doubt) | (np.maximum(before, after) <= doubt))


def _inward_corners(region: Region) -> tuple[Floats, Floats, Floats]:
    """The corners (c, 2) at which a region is wider than a half-plane; the directions of the sides before and after."""
    import shapely

    found: list[tuple[Floats, Floats, Floats]] = [(np.empty((0, 2)),) * 3]
    for ring in shapely.get_rings(shapely.get_parts(shapely.orient_polygons(region))):
        points = shapely.get_coordinates(ring)[:-1]
        on = np.roll(points, -1, axis=0) - points
        lengths = np.hypot(*on.T)
        on = on / lengths[:, None]
        back = -np.roll(on, 1, axis=0)
        inward = _cross(on, back) < 0  # the region lies to the left of its rings
        found.append((points[inward], back[inward], on[inward]))
    corners, back, on = (np.concatenate(parts) for parts in zip(*found, strict=True))
    return corners, back, on


def _cross(a: Floats, b: Floats) -> Floats:
    return np.asarray(a[..., 0] * b[..., 1] - a[..., 1] * b[..., 0])
