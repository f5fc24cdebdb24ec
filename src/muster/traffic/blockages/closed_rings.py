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
    widest = _widest_at_ends(mission)
    if len(robots) < 2 or not widest:
        return False
    ends, radii_m = np.array(list(widest)), np.array(list(widest.values()))
    inner_first = np.argsort(np.hypot(*(ends - ends.mean(axis=0)).T), kind="stable")
    beside = {radius_m: _Beside(ends, radii_m, radius_m) for radius_m in np.unique(radii_m).tolist()}
    return any(beside[float(radii_m[k])].rings(int(k), len(robots) - 1) for k in inner_first)


def _widest_at_ends(mission: Mission) -> dict[tuple[float, float], float]:
    """Where robots that drive may come to rest: their ends, or where their last task leaves them.

    For each place, in metres, the radius of the widest robot that may rest there.
    """
    found: dict[tuple[float, float], float] = {}
    for robot in filter(drives, mission.all_robots):
        own = robot.place_at_end(mission.rules)
        ends = [motion.exit for motion in task_motions(mission, [robot])] if own is None else [own]
        for x, y, *_ in ends:
            found[x, y] = max(robot.radius_m, found.get((x, y), 0.0))
    return dict(sorted(found.items()))


class _Beside:
    """Which ends, (n, 2) metres, are so close that a robot does not get through between two that stand there.

    Those have radii (n,), and the robot has one.
    """

    def __init__(self, ends: Floats, radii_m: Floats, radius_m: float) -> None:
        self._ends = ends
        gaps_m = 2 * radius_m + radii_m
        near = [
            np.flatnonzero(np.hypot(*(ends - end).T) < gaps_m + own_m) for end, own_m in zip(ends, radii_m, strict=True)
        ]
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
