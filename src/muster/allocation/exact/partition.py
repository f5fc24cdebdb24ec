"""The least `average` over all partitions of the tasks among the robots, by dynamic programming over sets of tasks.

Routes are by [held-karp1962]. A
set of tasks is a number, with one bit for each task.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from muster.allocation.exact.costs import ancestors, real_costs
from muster.model.problem import Bools, Floats, Indices, Problem

_MOST_PARTINGS = 300_000_000
_ROUNDING = 1e-9


@dataclass(frozen=True)
class Parting:
    """The least average, and routes that have it; they may deadlock or be above a capacity."""

    value: float
    routes: list[list[int]]


def few_partings(problem: Problem) -> bool:
    """Whether there are so few ways to part the tasks between two robots that some seconds do for all robots."""
    return len(problem.robots) * 3.0 ** len(problem.tasks) <= _MOST_PARTINGS


def least_average(problem: Problem, usable: Bools, weights: Sequence[int], weight: int) -> Parting:
    """The least average of plans of this weight, where deadlocks do not count and capacities hold for some order.

    Every admissible plan of the weight is one of these, so that the value is a bound of theirs. A route with arrivals
    a_1, a_2, ... is built from its end: a task put before a set S of tasks makes all their arrivals later by its work
    and the leg to the next, which is |S| times that. The best of the sets that have the weight and hold all their
    prerequisites is taken.
    """
    n, before = len(problem.tasks), [sum(1 << k for k in some) for some in ancestors(problem)]
    sets = np.arange(1 << n)
    bits = (sets[:, None] >> np.arange(n)) & 1
    sizes = bits.sum(axis=1)
    costs = [_Robot(problem, usable, i, before, sizes) for i in range(len(usable))]
    costs.sort(key=lambda robot: -int(usable[robot.index].sum()))
    teams = [np.where(sizes == 0, 0.0, math.inf)]
    for robot in costs:
        teams.append(_with_robot(teams[-1], robot.values, n))
    fits = bits @ np.array(weights) == weight
    for j, needed in enumerate(before):
        fits &= (bits[:, j] == 0) | (sets & needed == needed)
    means = np.where(fits & (sets > 0), teams[-1] / np.maximum(sizes, 1), math.inf)
    best = int(means.argmin())
    if math.isinf(means[best]):
        return Parting(math.inf, [[] for _ in usable])
    return Parting(float(means[best]), _routes(costs, teams, best, n))


def _with_robot(team: Floats, values: Floats, n: int) -> Floats:
    """For each set of tasks the least sum if one more robot does some of them."""
    if np.isinf(team[1:]).all():
        return values
    larger = team.copy()
    shape = (2,) * n
    cube, out = team.reshape(shape), larger.reshape(shape)
    for some in np.flatnonzero(np.isfinite(values)).tolist():
        if some:
            axes = [some >> (n - 1 - axis) & 1 for axis in range(n)]  # the first axis is the highest bit
            inside = tuple(1 if held else slice(None) for held in axes)
            outside = tuple(0 if held else slice(None) for held in axes)
            out[inside] = np.minimum(out[inside], cube[outside] + values[some])
    return larger


def _routes(robots: Sequence[_Robot], teams: Sequence[Floats], tasks: int, n: int) -> list[list[int]]:
    """The routes behind the sum of a team of all robots for a set of tasks."""
    routes: list[list[int]] = [[] for _ in robots]
    for robot, team in zip(reversed(robots), reversed(teams[:-1]), strict=True):
        some = _subsets(tasks, n)
        mine = int(some[(robot.values[some] + team[tasks ^ some]).argmin()])
        routes[robot.index] = robot.route(mine)
        tasks ^= mine
    return routes


def _subsets(tasks: int, n: int) -> Indices:
    some = np.zeros(1, np.int64)
    for j in range(n):
        if tasks >> j & 1:
            some = np.concatenate((some, some | (1 << j)))
    return some


class _Robot:
    """The best routes of one robot: `values[S]` is the least sum of arrivals at the tasks of S; inf where it cannot."""

    def __init__(self, problem: Problem, usable: Bools, index: int, before: Sequence[int], sizes: Indices) -> None:
        self.index = index
        first, between, work, last = (some[index] for some in real_costs(problem))
        self._mine = np.flatnonzero(usable[index]).tolist()
        self._before, self._sizes = before, sizes
        self._first, self._steps = first, work[:, None] + between
        self._sums = self._suffixes(np.zeros(len(work)), late=True)
        self.values = self._closed(self._sums, first, sizes)
        if math.isfinite(problem.capacity[index]):
            usage = self._closed(self._suffixes(work + last, late=False), first, np.ones_like(sizes))
            self.values[usage > problem.capacity[index] * (1 + _ROUNDING)] = math.inf
        self.values[0] = 0.0

    def _suffixes(self, last: Floats, *, late: bool) -> Floats:
        """(tasks, sets) the least of the rest of a route that is at a task and has a set to do, the task in it.

        `late`: the sum of arrivals after that at the task; else the usage from there.
        """
        rest = np.full((len(last), len(self._sizes)), math.inf)
        for j in self._mine:
            rest[j, 1 << j] = last[j]
        mine = sum(1 << j for j in self._mine)
        sets = np.flatnonzero((np.arange(len(self._sizes)) & ~mine) == 0)
        for size in range(2, len(self._mine) + 1):
            layer = sets[self._sizes[sets] == size]
            for j in self._mine:
                some = layer[(layer >> j & 1 == 1) & (layer & self._before[j] == 0)]
                left = some ^ (1 << j)
                for k in self._mine:
                    if k != j:
                        onward = self._steps[j, k] * (size - 1 if late else 1) + rest[k, left]
                        rest[j, some] = np.minimum(rest[j, some], onward)
        return rest

    def _closed(self, rest: Floats, first: Floats, times: Indices) -> Floats:
        """(sets,) the least over the tasks that a route can begin with."""
        return np.asarray((first[:, None] * np.maximum(times, 1) + rest).min(axis=0))

    def route(self, tasks: int) -> list[int]:
        """The order of the tasks of a set with the least sum of arrivals."""
        route: list[int] = []
        while tasks:
            size = int(self._sizes[tasks])
            leg = self._steps[route[-1]] * size if route else self._first * size
            sums = np.where(np.isfinite(self._sums[:, tasks]), leg + self._sums[:, tasks], math.inf)
            route.append(int(sums.argmin()))
            tasks ^= 1 << route[-1]
        return route
