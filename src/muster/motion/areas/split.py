"""The lanes of an area shared among several robots: consecutive parts of one way, of equal length.

The length of a part is that of its lanes and of the ways between them; the way from one part to the next is nobody's.
The least length of the longest part is found by bisection; for a given length each part takes as much as it may, in
order. Parts end at the ends of lanes where that makes the longest hardly longer, else within lanes.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from muster.mission.values.arrays import Floats
from muster.motion.areas.coverage_path import CoveragePath

_LONGER = 1.03
"""Parts of whole lanes may be so much longer than parts that end within lanes."""
_BISECTIONS = 60
_NOTHING = 1e-9
"""Of the whole length: a rest so short is rounding."""


def parts_of(path: CoveragePath, count: int) -> list[Floats]:
    """The lanes (n, 2, 2) of each of so many parts, in order; metres in the map frame."""
    way = _Way.along(path, path.lanes)
    within, whole = way.least_m(count, whole=False), way.least_m(count, whole=True)
    ends_at_lanes = whole <= _LONGER * within
    parts = list(way.cut(whole if ends_at_lanes else within, whole=ends_at_lanes))
    return parts + [parts[-1][:0]] * (count - len(parts))


def way_m(path: CoveragePath, lanes: Floats) -> float:
    """Metres along lanes (n, 2, 2) of a path, the ways between them included."""
    return _Way.along(path, lanes).total_m


@dataclass(frozen=True, eq=False)
class _Way:
    """Lanes (n, 2, 2), the lengths (n) of them, and (n) of the ways to each from the one before."""

    lanes: Floats
    lengths: Floats
    links: Floats

    @classmethod
    def along(cls, path: CoveragePath, lanes: Floats) -> _Way:
        links = [path.link_m(*ends) for ends in zip(lanes[:-1, 1], lanes[1:, 0], strict=True)]
        return cls(lanes, np.linalg.norm(lanes[:, 1] - lanes[:, 0], axis=1), np.array([0.0, *links])[: len(lanes)])

    @property
    def total_m(self) -> float:
        return float(self.lengths.sum() + self.links.sum())

    def least_m(self, count: int, *, whole: bool) -> float:
        """The least length of the longest of so many parts."""
        low, high = 0.0, self.total_m
        for _ in range(_BISECTIONS):
            middle = (low + high) / 2
            fits = sum(1 for _ in self.cut(middle, whole=whole)) <= count
            fits = fits and not (whole and middle < self.lengths.max())
            low, high = (low, middle) if fits else (middle, high)
        return high

    def cut(self, most_m: float, *, whole: bool) -> Iterator[Floats]:
        """The lanes of parts none of which is longer than this; with `whole` no lane is cut."""
        part: list[Floats] = []
        room, nothing = most_m, _NOTHING * self.total_m
        for lane, length, link in zip(self.lanes, self.lengths, self.links, strict=True):
            begin, end = lane
            room -= link if part else 0.0
            if part and (room < length - nothing if whole else room <= nothing):
                yield np.array(part)
                part, room = [], most_m
            while not whole and length - room > nothing:
                at = begin + (end - begin) * (room / length)
                yield np.array([*part, (begin, at)])
                begin, length = at, length - room
                part, room = [], most_m
                if room <= nothing:
                    return
            part.append(np.array([begin, end]))
            room -= length
        yield np.array(part)
