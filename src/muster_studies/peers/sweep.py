"""A solver that minimises the total, used for other objectives: solved repeatedly with lower and lower caps on routes.

Each run minimises the total under a cap on the route length. What counts is the best of all runs by the objective; the
time limit, in processor time, is split over them.
"""

from __future__ import annotations

import time
from collections.abc import Callable, Sequence
from dataclasses import dataclass

from muster_studies.peers.instance import Instance, Routes
from muster_studies.peers.peer import Answer

OBJECTIVES = ("total", "max", "total+max")
"""What a sweep can minimise."""
RUNS = 8
"""The time limit is split over so many runs; a solver that ends by itself has as many more as fit."""
_GRID = 4
"""Caps tried first, in equal ratios: a run without a cap may have routes ten times too long; then beside the best."""
_CLOSE = 1e-4


@dataclass(frozen=True)
class Routed:
    """What one run came to: each robot's route, and how long the solver says it is."""

    routes: Routes
    lengths: Sequence[int]

    def value(self, objective: str) -> int:
        total, greatest = sum(self.lengths), max(self.lengths)
        return {"total": total, "max": greatest, "total+max": total + greatest}[objective]


Run = Callable[[int | None, float], Routed | None]
"""Minimise the total under a cap on the route length, in so many seconds; None: found no plan."""


@dataclass(frozen=True)
class _Found:
    """A run beside others; `cap` is the greatest route's length where there was none."""

    rank: tuple[int, int]
    cap: int
    routed: Routed

    @property
    def greatest(self) -> int:
        return max(self.routed.lengths)


def answered(instance: Instance, make: Callable[[], Run], seconds: float) -> Answer:
    """The answer of a solver: `make` hands it the model, and gives its runs."""
    begin = time.perf_counter()
    run = make()
    build_s = time.perf_counter() - begin
    routed = swept(instance, run, seconds)
    if routed is None:
        return Answer(None, build_s=build_s)
    return Answer(routed.routes, routed.value(instance.objective) / instance.usage.scale, build_s)


def swept(instance: Instance, run: Run, seconds: float) -> Routed | None:
    """The best of all runs: one without a cap, then with caps."""
    end = time.process_time() + seconds
    each = seconds if instance.objective == "total" else seconds / RUNS
    best: _Found | None = None
    while best is None and time.process_time() < end - 0.1 * each:
        best = _found(instance, None, run(None, min(each, end - time.process_time())))
        if instance.objective == "total":
            return None if best is None else best.routed
    if best is None:
        return None
    caps = _Caps(least_greatest(instance, best.routed), best, instance.objective)
    while (cap := caps.next()) is not None and (left := end - time.process_time()) > 0.1 * each:
        caps.tried(cap, _found(instance, cap, run(cap, min(each, left))))
    return caps.best.routed


def least_greatest(instance: Instance, routed: Routed) -> int:
    """No cap below this is worth a try: the mean of usages, or the nearest robot's way to the farthest task."""
    mean = sum(routed.lengths) // instance.robot_count
    costs, nearest = instance.usage, []
    for j in sorted(j for route in routed.routes for j in route):
        direct = [
            int(costs.legs[costs.kinds[i], instance.starts[i], j])
            + int(costs.work[costs.kinds[i], j])
            + int(costs.legs[costs.kinds[i], j, instance.ends_or_anywhere[i]])
            for i in instance.allowed_robots(j)
        ]
        nearest.append(min(direct))
    return max(mean, *nearest) if nearest else mean


def _found(instance: Instance, cap: int | None, routed: Routed | None) -> _Found | None:
    if routed is None:
        return None
    rank = -instance.weight(routed.routes), routed.value(instance.objective)
    return _Found(rank, max(routed.lengths) if cap is None else cap, routed)


class _Caps:
    """Which cap to try next: halving for `max`; else a grid, then the middle of the gaps beside the best."""

    def __init__(self, low: int, first: _Found, objective: str) -> None:
        self.best = first
        self._low, self._high = low, first.greatest
        self._halving = objective == "max"
        self._known = [low, first.greatest]
        ratio = (max(1, low) / max(1, first.greatest)) ** (1 / (_GRID + 1))
        self._grid: list[int] = [] if self._halving else [round(first.greatest * ratio**k) for k in range(1, _GRID + 1)]

    def next(self) -> int | None:
        """A cap; None where all that are left are close to known ones."""
        if self._grid:
            return self._grid.pop(0)
        below, above = (self._low, self._high) if self._halving else self._wider_gap()
        return (below + above) // 2 if above - below > _CLOSE * above else None

    def _wider_gap(self) -> tuple[int, int]:
        """The wider of the gaps beside the best cap."""
        known = sorted({*self._known})
        at = known.index(self.best.cap)
        gaps = [(known[k], known[k + 1]) for k in (at - 1, at) if 0 <= k < len(known) - 1]
        return max(gaps, key=lambda gap: gap[1] - gap[0], default=(self.best.cap, self.best.cap))

    def tried(self, cap: int, found: _Found | None) -> None:
        """Note what a cap came to; without as many tasks it is too low, as far as the solver can tell."""
        self._known.append(cap)
        if found is None or found.rank[0] > self.best.rank[0]:
            self._low = cap
        else:
            self._high = min(self._high, found.greatest)
        if found is not None and found.rank < self.best.rank:
            self.best = found
            # Where the run without a cap was poor, its mean is no bound.
            self._known.append(sum(found.routed.lengths) // len(found.routed.lengths))
