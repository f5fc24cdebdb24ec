"""Which tasks a robot's energy allows in any plan, as far as the robot and the task alone tell: a proof, not a trial.

A robot sets out with what its battery holds, and leaves each station that it reaches with a full battery at best. Ways
are the least, by way of any other places. What no such way allows no plan allows, whatever else is in it.
"""

from __future__ import annotations

import math
from typing import Protocol

import numpy as np
import numpy.typing as npt

from muster.mission.model import Station
from muster.model.rules.rule import Bools, Floats, Question

_ROUNDING = 1e-9
_MOST_WAYS = 5_000_000  # of one robot that are compared, beyond which nothing is excluded


class Travelled(Question, Protocol):
    """What is looked at: a `Problem`."""

    @property
    def stations(self) -> tuple[Station, ...]: ...

    def shortcuts(self) -> npt.NDArray[np.int64]: ...

    def start(self, i: int) -> int: ...

    def end(self, i: int) -> int: ...

    def legs(self, i: int, places: npt.NDArray[np.int64], to: npt.NDArray[np.int64]) -> Floats: ...

    def work_usage(self, i: int) -> Floats: ...

    def beginning(self, i: int) -> tuple[int, ...]: ...


def energy_reaches(problem: Travelled) -> Bools:
    """Return (m, n) whether the energy of a robot may last for a task, with the other task of its transport."""
    reaches = np.ones((len(problem.robots), len(problem.tasks)), dtype=np.bool_)
    hubs = 2 + len(problem.stations) + len(problem.shortcuts())
    if hubs * hubs * len(problem.tasks) > _MOST_WAYS:
        return reaches
    pickup = problem.model.pickups
    delivery = {k: j for j, k in enumerate(pickup) if k >= 0}
    for i in problem.model.parts.energy:
        reach = _Reach(problem, i)
        for j in (j for j in range(len(problem.tasks)) if j not in problem.model.parts.over):
            first, then = (pickup[j], j) if pickup[j] >= 0 else (j, delivery.get(j))
            reaches[i, j] = reach.allows(first, then)
    return reaches


class _Reach:
    """The least ways of one robot by way of hubs, and the stations that it can get to and from.

    Hubs are its start, its end, the stations, and tasks through which a way may be shorter than the direct one.
    """

    def __init__(self, problem: Travelled, i: int) -> None:
        self._problem, self._i = problem, i
        n, m = len(problem.tasks), len(problem.robots)
        tasks, stations = np.arange(n), np.arange(n + 2 * m, n + 2 * m + len(problem.stations))
        hubs = np.array([problem.start(i), problem.end(i), *stations, *problem.shortcuts()], dtype=np.int64)
        between = problem.legs(i, hubs, hubs)
        for k in range(2, len(hubs)):
            between = np.minimum(between, between[:, k, None] + between[None, k, :])
        self._out, back = problem.legs(i, hubs, tasks), problem.legs(i, tasks, hubs)
        self._between = np.minimum(between, np.where(np.eye(len(hubs), dtype=np.bool_), 0.0, math.inf))
        self._there = np.min(self._between[:, :, None] + self._out[None], axis=1)  # (hubs, n)
        self._back = np.min(back[:, :, None] + self._between[None], axis=1)  # (n, hubs)
        self._full = float(problem.model.energy[i])
        self._slack = _ROUNDING * (1 + self._full)
        self._work = problem.work_usage(i)
        self._filling = [
            k + 2 for k, s in enumerate(problem.stations) if s.gives_energy and problem.model.may_call(i, k)
        ]
        done = [j for j in problem.beginning(i) if j in problem.model.parts.over]  # before it can call at any station
        at_start = float(problem.model.energy_at_start[i] - self._work[done].sum())
        self._levels = self._with_stations({0: at_start}, self._between[0], at_start)
        self._ends = self._to_end() if problem.robots[i].place_at_end(problem.mission.rules) is not None else None

    def _with_stations(self, levels: dict[int, float], ways: Floats, level: float) -> dict[int, float]:
        """Where the robot can set out from, with how much energy at most: hubs, with stations that it gets to."""
        near = [k for k in self._filling if ways[k] <= level + self._slack]
        for at in near:
            levels[at] = self._full
            near += [k for k in self._filling if k not in near and self._between[at, k] <= self._full + self._slack]
        return levels

    def _to_end(self) -> list[int]:
        """Where it is enough to arrive: at the end, and at stations from which a full battery leads there."""
        able = [1]
        for hub in able:
            able += [k for k in self._filling if k not in able and self._between[k, hub] <= self._full + self._slack]
        return able

    def _after(self, levels: dict[int, float], j: int) -> float:
        """The most energy after work on a task, come to from hubs with these levels; -inf: none is enough."""
        arrives = max((level - float(self._there[hub, j]) for hub, level in levels.items()), default=-math.inf)
        return arrives - float(self._work[j])

    def allows(self, first: int, then: int | None) -> bool:
        """Return whether the robot can do a task, and another one after it."""
        level, last = self._after(self._levels, first), first
        if then is not None and level >= -self._slack:
            onward = level - self._way(first, then) - float(self._work[then])
            level, last = max(onward, self._after(self._with_stations({}, self._back[first], level), then)), then
        if level < -self._slack:
            return False
        return self._ends is None or any(float(self._back[last, hub]) <= level + self._slack for hub in self._ends)

    def _way(self, j: int, k: int) -> float:
        """The least way from a task to another."""
        direct = self._problem.legs(self._i, np.array([j]), np.array([k]))[0, 0]
        return float(min(direct, np.min(self._back[j] + self._out[:, k])))
