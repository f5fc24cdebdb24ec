"""Which tasks a robot's energy allows in any plan, as far as the robot and the task alone tell: a proof, not a trial.

A robot sets out with what its battery holds, and leaves each station that it reaches with a full battery at best. Ways
are the least, by way of any other places. What no such way allows no plan allows, whatever else is in it.
"""

from __future__ import annotations

import math
from typing import Protocol

import numpy as np
import numpy.typing as npt

from muster.allocation.rules.battery import energy_at_start, energy_room
from muster.allocation.rules.load import pickups
from muster.allocation.rules.rule import Bools, Floats, Question
from muster.mission.model import Station

_ROUNDING = 1e-9
_MOST_THROUGH = 300  # places through which a way may be shorter than the direct one, up to which all ways are known


class Travelled(Question, Protocol):
    """What is looked at: a `Problem`."""

    @property
    def stations(self) -> tuple[Station, ...]: ...

    def shortcuts(self) -> npt.NDArray[np.int64]: ...

    def start(self, i: int) -> int: ...

    def end(self, i: int) -> int: ...

    def legs(self, i: int, places: npt.NDArray[np.int64], to: npt.NDArray[np.int64]) -> Floats: ...

    def work_usage(self, i: int) -> Floats: ...


def energy_reaches(problem: Travelled) -> Bools:
    """Return (m, n) whether the energy of a robot may last for a task, with the other task of its transport."""
    reaches = np.ones((len(problem.robots), len(problem.tasks)), dtype=np.bool_)
    through = [*problem.shortcuts().tolist(), *_stations(problem)]
    if len(through) > _MOST_THROUGH:
        return reaches
    pickup = pickups(problem)
    delivery = {k: j for j, k in enumerate(pickup) if k >= 0}
    for i, robot in enumerate(problem.robots):
        if robot.battery is None:
            continue
        reach = _Reach(problem, i, through)
        for j in range(len(problem.tasks)):
            first, then = (pickup[j], j) if pickup[j] >= 0 else (j, delivery.get(j))
            reaches[i, j] = reach.allows(first, then)
    return reaches


def _stations(problem: Travelled) -> range:
    first = len(problem.tasks) + 2 * len(problem.robots)
    return range(first, first + len(problem.stations))


class _Reach:
    """The ways of one robot, and the stations that it can get to and from."""

    def __init__(self, problem: Travelled, i: int, through: list[int]) -> None:
        self._full, self._slack = energy_room(problem.robots[i]), _ROUNDING * (1 + energy_room(problem.robots[i]))
        self._ways = _least_ways(problem, i, through)
        self._work = problem.work_usage(i)
        stations = zip(_stations(problem), problem.stations, strict=True)
        self._filling = [place for place, station in stations if station.gives_energy]
        start, at_start = problem.start(i), energy_at_start(problem, i)
        self._levels = self._leaving(start, at_start)
        self._homeward = self._to_end(problem.end(i)) if _must_end(problem, i) else None

    def _leaving(self, place: int, level: float) -> dict[int, float]:
        """Where the robot can set out from, with how much energy at most: a place, and stations reached from it."""
        levels = {place: level}
        waiting = [place]
        while waiting:
            at = waiting.pop()
            for station in self._filling:
                near = self._ways[at, station] <= levels[at] + self._slack
                if near and levels.get(station, -math.inf) < self._full:
                    levels[station] = self._full
                    waiting.append(station)
        return levels

    def _to_end(self, end: int) -> list[int]:
        """Where it is enough to arrive: at the end, and at stations from which a full battery leads there."""
        able = [end]
        for place in able:
            able += [s for s in self._filling if s not in able and self._ways[s, place] <= self._full + self._slack]
        return able

    def _after(self, levels: dict[int, float], j: int) -> float:
        """The most energy after work on a task, come to from places with these levels; -inf: none is enough."""
        level = max(level - float(self._ways[place, j]) for place, level in levels.items()) - float(self._work[j])
        return level if level >= -self._slack else -math.inf

    def allows(self, first: int, then: int | None) -> bool:
        level, last = self._after(self._levels, first), first
        if then is not None and level > -math.inf:
            level, last = self._after(self._leaving(first, level), then), then
        if level == -math.inf:
            return False
        if self._homeward is None:
            return True
        return any(float(self._ways[last, place]) <= level + self._slack for place in self._homeward)


def _must_end(problem: Travelled, i: int) -> bool:
    return problem.robots[i].place_at_end(problem.mission.rules) is not None


def _least_ways(problem: Travelled, i: int, through: list[int]) -> Floats:
    """The least travel usage between all places, by way of some; work on the way counts nothing."""
    places = np.arange(len(problem.tasks) + 2 * len(problem.robots) + len(problem.stations))
    ways = problem.legs(i, places, places)
    for k in through:
        ways = np.minimum(ways, ways[:, k, None] + ways[None, k, :])
    return np.asarray(ways)
