"""Sections of lanes on which only so many robots may be: a planner keeps each for one robot.

So as many robots as may be on a lane find room on it, and no more, wherever on it they are to stop.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from muster.mission.values.arrays import Bools, Floats, Indices

ON_LANE_M = 0.05
"""Who is no farther from the middle of a lane is on it, and who is no farther from its end is at its node."""
_AT_NODE_M = 1e-3
"""Who stands no farther from the end of a lane is at its node."""


@dataclass(frozen=True, eq=False)
class Section:
    """A part of a lane.

    Parameters
    ----------
    ends
        (2, 2) metres, in the direction of the lane.
    both_ways
        whether robots come along the lane from either side.
    """

    ends: Floats
    both_ways: bool

    def holds(self, points: Floats) -> Bools:
        """Which points (n, 2) are on it."""
        begin, along = self.ends[0], self.ends[1] - self.ends[0]
        unit = along / np.hypot(*along)
        off = points - begin
        forward, aside = off @ unit, off @ np.array([-unit[1], unit[0]])
        return np.asarray((forward > 0) & (forward <= np.hypot(*along)) & (np.abs(aside) <= ON_LANE_M))

    def entered(self, points: Floats, edges: Indices, inside: Bools) -> Indices:
        """The edges (m, 2) that lead into it, but not against the lane; `inside`: which points are on it."""
        into = np.flatnonzero(inside[edges[:, 1]] & ~inside[edges[:, 0]])
        along = self.ends[1] - self.ends[0]
        forward = (points[edges[into, 1]] - points[edges[into, 0]]) @ along
        return into if self.both_ways else into[forward >= 0]


def sections(start: Floats, end: Floats, shares: Sequence[float], capacity: int, *, both_ways: bool) -> list[Section]:
    """The sections of a lane with points at these shares of its length, in order: at most one for each robot."""
    along = end - start
    at_node = _AT_NODE_M / float(np.hypot(*along))
    count = min(capacity, max(1, len(shares)))
    groups = [group for group in np.array_split(np.array(shares), count) if len(group)]
    between = [(one[-1] + next_[0]) / 2 for one, next_ in pairwise(groups)]
    cuts = [at_node, *between, 1 - at_node]
    return [Section(start + np.array([[a], [b]]) * along, both_ways) for a, b in pairwise(cuts)]


def held_back(points: Floats, edges: Indices, parts: Sequence[Section]) -> Indices:
    """(k, 2): edges, and points at which nobody may be when a robot sets out on them: they lead into one section."""
    found = [np.zeros((0, 2), dtype=np.int64)]
    for part in parts:
        inside = part.holds(points)
        if np.count_nonzero(inside) > 1:
            edge, point = np.meshgrid(part.entered(points, edges, inside), np.flatnonzero(inside), indexing="ij")
            found.append(np.stack([edge.ravel(), point.ravel()], axis=1))
    return np.concatenate(found)
