"""Travel and work as whole numbers, the input of other solvers."""

from __future__ import annotations

import math
from collections.abc import Hashable, Sequence
from dataclasses import dataclass

import numpy as np

from muster.mission.values.arrays import Integers
from muster.model.problem import Floats, Problem

_DIGITS = 7
"""The longest way or work has so many: rounding is far below 1e-4 of any value, and sums fit all solvers."""
_NEVER = 100
"""A leg that does not exist takes so many times the longest."""


@dataclass(frozen=True, eq=False)
class Costs:
    """Travel and work, rounded up: who keeps a capacity here keeps it in truth.

    Parameters
    ----------
    scale
        what one unit (metre or second) is here.
    kinds
        for each robot the first index of the tables that holds for it.
    legs
        (kinds, places + 1, places + 1) travel from place to place; nothing to the last place, which is anywhere.
    work
        (kinds, n) work at each task; tasks are the first places.
    """

    scale: float
    kinds: tuple[int, ...]
    legs: Integers
    work: Integers

    def arriving(self, kind: int) -> Integers:
        """(places + 1, places + 1) travel, and the work at the place arrived at."""
        table: Integers = self.legs[kind].copy()
        table[:, : self.work.shape[1]] += self.work[kind][None, :]
        np.fill_diagonal(table, 0)
        return table

    def departing(self, kind: int) -> Integers:
        """(places + 1, places + 1) the work at the place left, and travel."""
        table: Integers = self.legs[kind].copy()
        table[: self.work.shape[1]] += self.work[kind][:, None]
        np.fill_diagonal(table, 0)
        return table

    @property
    def bound(self) -> int:
        """More than all routes of any plan together take, legs that do not exist left out."""
        return int(2 * 10**_DIGITS * (self.legs.shape[1] + len(self.kinds)))


def usage_costs(problem: Problem, places: list[int], tasks: int) -> Costs:
    """Usage between some places of the problem, the first of which are the tasks."""
    own = [(r.speed_mps, r.efficiency) if problem.in_time else () for r in problem.robots]
    keys = _keys(problem, own)
    first = _first_of_each(keys)
    legs = [problem.legs(i, places, places) for i in first]
    work = [problem.work_usage(i)[places[:tasks]] for i in first]
    return _rounded(keys, legs, work)


def time_costs(problem: Problem, places: list[int], tasks: int, *, to_ends: bool) -> Costs:
    """Seconds between some places of the problem, the first of which are the tasks; `to_ends`: to ends too."""
    keys = _keys(problem, [(r.speed_mps, r.efficiency) for r in problem.robots])
    first = _first_of_each(keys)
    speeds = [1.0 if problem.in_time else problem.robots[i].speed_mps for i in first]
    legs = [problem.legs(i, places, places) / speed for i, speed in zip(first, speeds, strict=True)]
    work = [problem.work_seconds(i)[places[:tasks]] for i in first]
    if not to_ends:
        for table in legs:
            table[:, tasks:] = 0
    return _rounded(keys, legs, work)


def _keys(problem: Problem, own: Sequence[Hashable]) -> list[Hashable]:
    """What the costs of each robot depend on."""
    classes = problem.travel[1].tolist() or [0] * len(problem.robots)
    return list(zip(classes, problem.work_classes.tolist(), own, strict=True))


def _first_of_each(keys: Sequence[Hashable]) -> list[int]:
    return [keys.index(key) for key in dict.fromkeys(keys)]


def _rounded(keys: Sequence[Hashable], legs: Sequence[Floats], work: Sequence[Floats]) -> Costs:
    longest = max((float(a[np.isfinite(a)].max(initial=0)) for a in (*legs, *work)), default=0.0)
    scale = 10.0 ** (_DIGITS - math.ceil(math.log10(longest))) if longest > 0 else 1.0
    kinds = list(dict.fromkeys(keys))
    tables = np.zeros((len(legs), len(legs[0]) + 1, len(legs[0]) + 1), dtype=np.int64)
    for table, metres in zip(tables, legs, strict=True):
        table[:-1, :-1] = _up(np.where(np.isfinite(metres), metres, _NEVER * longest), scale)
        np.fill_diagonal(table, 0)
    tasks = work[0].size
    tables[:, tasks:, tasks:] = 0  # a robot without tasks stays
    return Costs(scale, tuple(kinds.index(key) for key in keys), tables, np.array([_up(w, scale) for w in work]))


def _up(values: Floats, scale: float) -> Integers:
    return np.ceil(values * scale - 1e-6).astype(np.int64)
