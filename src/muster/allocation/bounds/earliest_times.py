"""The earliest times at which tasks can begin and end in any plan that does all of them.

Each task looked at alone is reached by the shortest way, and waits until it may begin and for the earliest ends of its
prerequisites [kelley1959]. A team of k robots has one that is no earlier than the k-th earliest of all.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from muster.allocation.bounds.feasibility import least_usages
from muster.model.problem import Bools, Floats, Problem
from muster.model.rules.rule import ROUNDING


@dataclass(frozen=True)
class EarliestTimes:
    """For each task (n,) when it can begin and end, and when its last robot can be at its end; inf: never."""

    begins: Floats
    ends: Floats
    homes: Floats

    @classmethod
    def of(cls, problem: Problem, usable: Bools) -> EarliestTimes:
        """The earliest times over all plans of the usable pairs (m, n) of robot and task that do every task."""
        return _Bounding(problem, usable).times()


def in_time(problem: Problem) -> Problem:
    """The problem whose usage is time; its capacities mean nothing."""
    return replace(problem, mission=replace(problem.mission, rules=replace(problem.mission.rules, usage="time")))


def opened(problem: Problem) -> Problem:
    """The problem whose routes may end anywhere."""
    robots = tuple(replace(robot, return_to_start=False, end_position=None) for robot in problem.robots)
    return replace(problem, robots=robots)


def kth_least(values: Floats, counts: Sequence[int]) -> Floats:
    """(n,) of each column of (m, n) the least value that so many are not above; inf where there are not so many."""
    ordered = np.sort(np.vstack([values, np.full(values.shape[1], math.inf)]), axis=0)
    return np.asarray(ordered[[min(k, len(values) + 1) - 1 for k in counts], np.arange(values.shape[1])])


class _Bounding:
    """Lower bounds of begins, raised one by the other until none is raised, or one can never be kept."""

    def __init__(self, problem: Problem, usable: Bools) -> None:
        self._rules, tasks = problem.model, range(len(problem.tasks))
        self._tasks = tasks
        timed = in_time(problem)
        self._work = np.where(usable, [timed.work_usage(i) for i in range(len(problem.robots))], math.inf)
        open_least = least_usages(opened(timed))
        available = np.array([robot.available_from_s for robot in problem.robots])
        self._there = np.where(usable, available[:, None] + open_least - np.where(usable, self._work, 0.0), math.inf)
        self._home = np.subtract(least_usages(timed), open_least, where=usable, out=np.full(usable.shape, math.inf))
        self._members = list(map(self._rules.least_members, tasks))
        self._longest = np.where(usable, self._work, 0.0).max(axis=0)
        self._begins = kth_least(self._there, self._members)

    def times(self) -> EarliestTimes:
        for _ in range(len(self._tasks) + 1):
            before = self._begins.copy()
            for j in self._tasks:
                self._raise(j)
            if np.array_equal(before, self._begins) or not np.isfinite(self._begins).all():
                break
        ends, homes = self._after(self._work), self._after(self._work + self._home)
        ends[ends > self._rules.ends_by * (1 + ROUNDING)] = math.inf
        return EarliestTimes(self._begins, ends, homes)

    def _after(self, seconds: Floats) -> Floats:
        """(n,) when a task can be over for all its robots, if it takes each so many seconds from its begin."""
        return kth_least(np.maximum(self._begins, self._there) + seconds, self._members)

    def _raise(self, j: int) -> None:
        """Raise the begin of a task by its prerequisites, when it may begin and the tasks that begin with it."""
        rules, begins = self._rules, self._begins
        for k, after, within in rules.gaps(j):
            begins[j] = max(begins[j], self._end(k) + after)
            if math.isfinite(within) and not rules.exclusive[j]:  # else another may be done in its place
                begins[k] = max(begins[k], begins[j] - within - self._longest[k])
        unit = rules.units[rules.unit[j]]
        begins[unit] = begins[unit].max()
        begins[j] = float(rules.next_begin(j, begins[j : j + 1])[0])

    def _end(self, j: int) -> float:
        ends = np.sort(np.maximum(self._begins[j], self._there[:, j]) + self._work[:, j])
        count = self._members[j]
        return float(ends[count - 1]) if count <= len(ends) else math.inf
