"""Whether robots that are at their ends can close others out of theirs: in free traffic nobody makes room then."""

from __future__ import annotations

from collections import deque
from itertools import product

import numpy as np
from numpy.typing import NDArray

from muster.mission.model import Mission
from muster.motion.grid import Floats
from muster.traffic.mission_roadmap import task_motions
from muster.traffic.names import drives


def can_close_out(mission: Mission) -> bool:
    """Whether robots at rest, one fewer than drive, can stand in a ring around a place where one more is to end.

    Walls are not looked at.
    """
    robots = [robot for robot in mission.all_robots if drives(robot)]
    ends = _ends(mission)
    if len(robots) < 2 or not len(ends):
        return False
    gap_m = 4 * max(robot.radius_m for robot in robots)  # between two at rest, through which none of them gets
    beside = _Beside(ends, gap_m)
    inner_first = np.argsort(np.hypot(*(ends - ends.mean(axis=0)).T), kind="stable")
    return any(beside.rings(int(k), len(robots) - 1) for k in inner_first)


def _ends(mission: Mission) -> Floats:
    """Where robots that drive may come to rest, (n, 2) metres: their own ends, or where their last task leaves them."""
    robots = list(filter(drives, mission.all_robots))
    own = [robot.place_at_end(mission.rules) for robot in robots]
    anywhere = [robot for robot, end in zip(robots, own, strict=True) if end is None]
    exits = [motion.exit for motion in task_motions(mission, anywhere)]
    ends = sorted({(end[0], end[1]) for end in [*own, *exits] if end is not None})
    return np.array(ends).reshape(-1, 2)


class _Beside:
    """Which ends, (n, 2) metres, are so close that nobody gets through between robots that stand there."""

    def __init__(self, ends: Floats, gap_m: float) -> None:
        self._ends = ends
        near = [np.flatnonzero(np.hypot(*(ends - end).T) < gap_m) for end in ends]
        pairs = [(a, b) for a, others in enumerate(near) for b in others.tolist() if a < b]
        self._pairs: NDArray[np.int_] = np.array(pairs, dtype=int).reshape(-1, 2)
        self._of: list[list[tuple[int, int]]] = [[] for _ in ends]
        """Of each end the others beside it, and the number of the pair."""
        for number, (a, b) in enumerate(pairs):
            self._of[a].append((b, number))
            self._of[b].append((a, number))

    def rings(self, place: int, most: int) -> bool:
        """Whether at most so many of the other ends make a closed ring around one: all rays from there cross it."""
        crossed = min((self._crossed(place, axis, sign) for axis, sign in product((0, 1), (1, -1))), key=np.sum)
        return any(self._ring_from(int(start), place, crossed, most) for start in set(self._pairs[crossed, 0].tolist()))

    def _crossed(self, place: int, axis: int, sign: int) -> NDArray[np.bool_]:
        """Which pairs the ray from a place along an axis crosses; none of which the place is one."""
        along, across = sign * (self._ends - self._ends[place])[:, [axis, 1 - axis]].T
        a, b = self._pairs.T
        spans = (across[a] > 0) != (across[b] > 0)
        with np.errstate(divide="ignore", invalid="ignore"):
            meets = along[a] - across[a] / (across[b] - across[a]) * (along[b] - along[a])
        crossed: NDArray[np.bool_] = spans & (meets > 0) & (a != place) & (b != place)
        return crossed

    def _ring_from(self, start: int, place: int, crossed: NDArray[np.bool_], most: int) -> bool:
        """Whether a ring of at most so many goes through a start: it crosses the ray an odd number of times."""
        steps = {(start, False): 0}
        queue = deque(steps)
        while queue:
            at, odd = node = queue.popleft()
            if node == (start, True):
                return True
            if steps[node] < most:
                for other, pair in self._of[at]:
                    after = (other, odd != bool(crossed[pair]))
                    if other != place and after not in steps:
                        steps[after] = steps[node] + 1
                        queue.append(after)
        return False
