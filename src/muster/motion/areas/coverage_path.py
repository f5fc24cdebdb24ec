"""The way that covers an area: the best direction of lanes, the lanes in order, and the ways between them."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from functools import lru_cache

import numpy as np

from muster.mission.values.arrays import Floats
from muster.motion.areas.cells import Cell, cells_of
from muster.motion.areas.lanes import Lanes, strip_count
from muster.motion.areas.region import Region, Ring, turned_points
from muster.motion.areas.tour import tour
from muster.motion.areas.transit import Transit

MOST_LANES = 10_000
_MOST_DIRECTIONS = 8
"""Of lanes that are looked at; those of the longest edges."""
_MOST_TOURS = 2
"""Directions for which lanes are put in order."""
_SAME_RAD = math.radians(1.0)


@dataclass(frozen=True, eq=False)
class CoveragePath:
    """How an area is covered, in the map frame.

    Parameters
    ----------
    lanes
        (n, 2, 2) metres: begin and end of each straight lane, in the order in which they are driven.
    transit
        shortest ways between them, in the frame of the region about `middle`.
    middle
        (2) metres.
    heading
        radians from east, anticlockwise: of most lanes.
    """

    lanes: Floats
    transit: Transit
    middle: Floats
    heading: float

    def bends(self, begin: Floats, end: Floats) -> list[Floats]:
        """The places between two points (2) at which the shortest way bends."""
        return [bend + self.middle for bend in self.transit.bends(begin - self.middle, end - self.middle)]

    def link_m(self, begin: Floats, end: Floats) -> float:
        """Metres of the shortest way between two points (2)."""
        return self.transit.length(begin - self.middle, end - self.middle)

    @property
    def length_m(self) -> float:
        """Of the lanes and of the ways between them."""
        lanes = float(np.linalg.norm(self.lanes[:, 1] - self.lanes[:, 0], axis=1).sum())
        ways = zip(self.lanes[:-1, 1], self.lanes[1:, 0], strict=True)
        return lanes + sum(self.link_m(begin, end) for begin, end in ways)


class TooManyLanesError(ValueError):
    """The area needs more lanes than anybody flies; `count` of them."""

    def __init__(self, count: float) -> None:
        super().__init__(f"{count:.3g} lanes")
        self.count = count


@lru_cache(maxsize=256)
def coverage_path(
    area: Ring, holes: tuple[Ring, ...], width_m: float, heading: float | None, *, cross_holes: bool
) -> CoveragePath:
    """The way that covers an area.

    Parameters
    ----------
    area, holes
        simple polygons; metres in the map frame.
    width_m
        of what is seen, or done, to both sides of a lane together.
    heading
        of the lanes, radians from east, anticlockwise; None: the one whose way is shortest.
    cross_holes
        whether holes may be crossed; they need not be seen in any case.

    Raises
    ------
    TooManyLanesError
        if there would be more than `MOST_LANES`.
    """
    whole = Region.of(area, holes, width_m, cross_holes=cross_holes)
    middle = whole.middle
    region = whole.moved(-middle)
    transit = Transit(region)
    headings = [heading] if heading is not None else _directions(region)
    ways = [_Direction.of(region, one, width_m) for one in headings]
    ways.sort(key=lambda way: way.estimate_m)
    paths = [way.path(transit, middle) for way in ways[:_MOST_TOURS]]
    return min(paths, key=lambda path: path.length_m)


@dataclass(frozen=True, eq=False)
class _Direction:
    """Lanes of one direction, in the frame in which they run along x."""

    heading: float
    lanes: Lanes
    cells: list[Cell]

    @classmethod
    def of(cls, region: Region, heading: float, width_m: float) -> _Direction:
        turned = region.turned(-heading)
        count = strip_count(turned, width_m)
        if count > MOST_LANES:
            raise TooManyLanesError(count)
        lanes = Lanes.over(turned, width_m)
        return cls(heading, lanes, cells_of(lanes.rows, lanes.numbers))

    @property
    def estimate_m(self) -> float:
        return self.lanes.estimate_m(len(self.cells))

    def path(self, transit: Transit, middle: Floats) -> CoveragePath:
        cells = [Cell(turned_points(cell.rows, self.heading)) for cell in self.cells]
        lanes = tour(cells, turned_points(self.lanes.short(), self.heading), transit)
        return CoveragePath(lanes + middle, transit, middle, self.heading)


def _directions(region: Region) -> Sequence[float]:
    """The directions of the longest edges, and of the longest side of the smallest rectangle around: in [0, pi).

    Edges that differ by a degree or so count together, in the direction of the longest of them.
    """
    import shapely

    box = shapely.get_coordinates(shapely.minimum_rotated_rectangle(region.seen))
    steps = np.vstack([region.edges, np.diff(box, axis=0)])
    angles, lengths = np.arctan2(steps[:, 1], steps[:, 0]) % math.pi, np.linalg.norm(steps, axis=1)
    groups = np.round(angles / _SAME_RAD).astype(int) % round(math.pi / _SAME_RAD)
    whole = np.bincount(groups, weights=lengths)
    longest = np.argsort(-whole, kind="stable")[: min(_MOST_DIRECTIONS, len(np.unique(groups)))]
    return [float(angles[np.argmax(np.where(groups == group, lengths, -1.0))]) for group in longest]
