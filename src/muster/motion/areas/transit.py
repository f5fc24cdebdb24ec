"""Shortest ways between lanes inside a region, holes left out where these may not be crossed.

A shortest way among polygons bends at corners that stick into the region alone; between the corners that see each other
Dijkstra's algorithm finds it [lozano1979].
"""

from __future__ import annotations

import math
from functools import cached_property

import numpy as np
import numpy.typing as npt

from muster.mission.values.arrays import Floats
from muster.motion.areas.region import Region

_MOST_PAIRS = 50_000
"""Of corners whose sight of each other is looked at in one go."""
_ALONG = 1e-9
"""A sine so small is rounding."""


class Transit:
    """The shortest ways within one region, (2) metres to (2) metres."""

    def __init__(self, region: Region) -> None:
        self._region = region
        self._lengths: dict[tuple[bytes, bytes], float] = {}
        self._sights: dict[bytes, Floats] = {}

    def sees(self, begins: Floats, ends: Floats) -> npt.NDArray[np.bool_]:
        """(n) whether the straight ways between points (n, 2) lie within the region."""
        import shapely

        if not len(begins):
            return np.zeros(0, dtype=bool)
        found: list[npt.NDArray[np.bool_]] = []
        for k in range(0, len(begins), _MOST_PAIRS):
            lines = shapely.linestrings(np.stack([begins[k : k + _MOST_PAIRS], ends[k : k + _MOST_PAIRS]], axis=1))
            found.append(np.asarray(shapely.covers(self._region.within, lines)))
        return np.concatenate(found)

    def lengths(self, begins: Floats, ends: Floats) -> Floats:
        """(n, m) metres from each of (n, 2) points to each of (m, 2); inf where there is no way."""
        n, m = len(begins), len(ends)
        straight = np.linalg.norm(begins[:, None] - ends[None], axis=2)
        seen = self.sees(np.repeat(begins, m, axis=0), np.tile(ends, (n, 1))).reshape(n, m)
        if seen.all() or not len(self._corners):
            return np.where(seen, straight, math.inf)
        last = self._to_corners(ends)
        around = [(self._over_corners(first) + last).min(axis=1) for first in self._to_corners(begins)]
        return np.where(seen, straight, around)

    def length(self, begin: Floats, end: Floats) -> float:
        """Metres of the shortest way between two points; kept."""
        key = begin.tobytes(), end.tobytes()
        if key not in self._lengths:
            same = bool((begin == end).all())
            self._lengths[key] = 0.0 if same else float(self.lengths(begin[None], end[None])[0, 0])
        return self._lengths[key]

    def bends(self, begin: Floats, end: Floats) -> list[Floats]:
        """The corners at which the shortest way between two points bends; none where it is straight."""
        if self.sees(begin[None], end[None])[0] or not len(self._corners):
            return []
        lengths, before = self._between
        first, last = self._to_corners(np.array([begin, end]))
        whole = first[:, None] + lengths + last[None]
        i, j = np.unravel_index(int(np.argmin(whole)), whole.shape)
        if not math.isfinite(whole[i, j]):
            return []
        chain = [int(j)]
        while chain[-1] != i:
            chain.append(int(before[i, chain[-1]]))
        return [self._corners[k] for k in reversed(chain)]

    def _over_corners(self, first: Floats) -> Floats:
        """(k) metres to each corner from a point that is so far (k) from the first one of the way."""
        led = np.flatnonzero(np.isfinite(first))
        if not len(led):
            return np.full_like(first, math.inf)
        found: Floats = (first[led, None] + self._between[0][led]).min(axis=0)
        return found

    @property
    def _corners(self) -> Floats:
        """(k, 2) the corners of the region at which a shortest way may bend."""
        return self._bending[0]

    @cached_property
    def _bending(self) -> tuple[Floats, Floats, Floats]:
        """(k, 2) the corners that stick into the region, and the steps to each from the one before and to the next."""
        import shapely

        found = []
        for surface in shapely.get_parts(shapely.normalize(self._region.free)):
            for ring in shapely.get_rings(surface):  # normalised: the outer one clockwise, holes the other way
                corners = shapely.get_coordinates(ring)[:-1]
                comes, goes = corners - np.roll(corners, 1, axis=0), np.roll(corners, -1, axis=0) - corners
                found.append(np.stack([corners, comes, goes])[:, _cross(comes, goes) > 0])
        corners, comes, goes = np.concatenate(found, axis=1)
        return corners, comes, goes

    @cached_property
    def _between(self) -> tuple[Floats, npt.NDArray[np.int32]]:
        """(k, k) metres between corners, and on the way to each the corner before it."""
        from scipy.sparse import csr_array
        from scipy.sparse.csgraph import dijkstra

        corners = self._corners
        i, j = np.triu_indices(len(corners), 1)
        way = corners[j] - corners[i]
        touching = self._touches(i, way) & self._touches(j, way)
        i, j = i[touching], j[touching]
        seen = self.sees(corners[i], corners[j])
        i, j = i[seen], j[seen]
        lengths = np.linalg.norm(corners[i] - corners[j], axis=1)
        graph = csr_array((lengths, (i, j)), shape=(len(corners), len(corners)))
        metres, before = dijkstra(graph, directed=False, return_predecessors=True)
        return metres, before

    def _to_corners(self, points: Floats) -> Floats:
        """(n, k) metres from points (n, 2) straight to the corners; inf where a shortest way does not lead there so."""
        new = np.array(list({p.tobytes(): p for p in points if p.tobytes() not in self._sights}.values()))
        if len(new):
            of, begins = np.tile(np.arange(len(self._corners)), len(new)), np.repeat(new, len(self._corners), axis=0)
            way = self._corners[of] - begins
            led = self._touches(of, way)
            led[led] = self.sees(begins[led], self._corners[of[led]])
            rows = np.where(led, np.linalg.norm(way, axis=1), math.inf).reshape(len(new), -1)
            self._sights.update({point.tobytes(): row for point, row in zip(new, rows, strict=True)})
        return np.array([self._sights[point.tobytes()] for point in points])

    def _touches(self, corner: npt.NDArray[np.int64], way: Floats) -> npt.NDArray[np.bool_]:
        """(n) whether both sides of a corner are on one side of a line through it: shortest ways bend nowhere else."""
        _, comes, goes = self._bending
        sides = -_cross(way, comes[corner]) * _cross(way, goes[corner])
        sizes = np.linalg.norm(way, axis=1) ** 2 * np.linalg.norm(comes[corner], axis=1)
        found: npt.NDArray[np.bool_] = sides >= -_ALONG * sizes * np.linalg.norm(goes[corner], axis=1)
        return found


def _cross(a: Floats, b: Floats) -> Floats:
    found: Floats = a[..., 0] * b[..., 1] - a[..., 1] * b[..., 0]
    return found
