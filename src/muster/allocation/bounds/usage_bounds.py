"""Lower bounds on the usage and times of robots that do certain tasks; one above a limit proves that they cannot.

For few tasks they are each robot's least usage and earliest end for every subset ([held-karp1962]) and all ways to
share the tasks out, as many times as they have members; for many a spanning forest from the starts of the robots that
can do them. Neither sees that robots may wait for each other in a circle, or for each other's teams: where that alone
forbids a plan, nothing is proven.
"""

from __future__ import annotations

import itertools
import math
from collections.abc import Iterable, Iterator, Sequence
from functools import cached_property

import numpy as np

from muster.allocation.bounds.feasibility import least_usages, limits_beside
from muster.allocation.bounds.limits import Limits
from muster.allocation.bounds.spanning import spanning_tree
from muster.allocation.bounds.subset_times import (
    followers,
    keep_relations,
    least_ways,
    sizes_that_differ,
    subset_ends,
    ways_of,
)
from muster.model.problem import Bools, Floats, Problem
from muster.model.rules.rule import ROUNDING

FEW = 10  # tasks, up to which all subsets are looked at
_MOST_IN_FOREST, _MOST_SHORTCUTS = 1500, 300  # tasks; beyond, the bound is not worth its time
_MOST_KINDS = 6  # of tasks by who can do them, up to which two kinds are looked at together


class UsageBounds:
    """Lower bounds on usage, over all admissible plans of a problem, whatever else is in them."""

    def __init__(self, problem: Problem) -> None:
        self.problem = problem

    @cached_property
    def least(self) -> Floats:
        """(m, n) the least usage of any route of a robot with a task in it, or less."""
        return least_usages(self.problem)

    @cached_property
    def possible(self) -> Bools:
        """(m, n) whether a robot can do a task, as far as single robots tell."""
        return self.limits.usable

    @cached_property
    def limits(self) -> Limits:
        """Lower bounds of usage and times."""
        return limits_beside(self.problem, self.least)

    @cached_property
    def hardness(self) -> Floats:
        """(n,) least usage of any robot that can do a task; inf where none can."""
        return np.asarray(np.where(self.possible, self.least, math.inf).min(axis=0))

    def groups(self, tasks: Sequence[int]) -> Iterator[tuple[list[int], list[int]]]:
        """Groups of robots, the smallest first, each with those of the tasks that no other robot can do."""
        kinds = {frozenset(np.flatnonzero(self.possible[:, j]).tolist()) for j in tasks}
        everyone = frozenset[int]().union(*kinds)
        unions = {a | b for a, b in itertools.combinations(kinds, 2)} if len(kinds) <= _MOST_KINDS else set()
        chosen = {everyone} if len(tasks) <= FEW else {*kinds, *unions, everyone}
        for group in sorted(chosen, key=lambda group: (len(group), sorted(group))):
            others = [i for i in range(len(self.problem.robots)) if i not in group]
            open_to_others = self.possible[others][:, tasks].any(axis=0)
            yield sorted(group), np.asarray(tasks, np.int64)[~open_to_others].tolist()

    def forbid(self, tasks: Iterable[int]) -> bool:
        """Whether it is proven that no admissible plan does all these tasks."""
        return any(self.exceed(robots, own) for robots, own in self.groups(self.problem.closed(tasks)))

    def exceed(self, robots: list[int], tasks: list[int]) -> bool:
        """Whether it is proven that robots cannot do all the tasks, which no other robot does."""
        if sizes_that_differ(self.problem, tasks) is not None:
            return True
        if self.is_few(tasks):
            return self.every_place(tasks) not in self.shares(robots, tasks)
        capacity = float(self.problem.capacity[robots].sum())
        return math.isfinite(capacity) and self.least_together(robots, tasks) > capacity * (1 + ROUNDING)

    def is_few(self, tasks: Sequence[int]) -> bool:
        """Whether all ways to share tasks out can be looked at."""
        return sum(map(self.problem.model.least_members, tasks)) <= FEW

    def every_place(self, tasks: Sequence[int]) -> int:
        """All places of tasks, as bits: of each as many as it has members at least."""
        return (1 << sum(map(self.problem.model.least_members, tasks))) - 1

    def shares(self, robots: Iterable[int], tasks: Sequence[int]) -> list[int]:
        """The largest sets of places of few tasks, as bits, that robots may be able to fill between them."""
        everything, reached, known = self.every_place(tasks), [0], dict[bytes, list[int]]()
        places = _places(self.problem, tasks)
        for i in robots:
            if everything in reached:
                break
            key = self._share_key(i, tasks)
            if key not in known:
                known[key] = _largest(np.flatnonzero(self.may_do(i, tasks)).tolist())
            reached = _largest(_filled(places, before, share) for before in reached for share in known[key])
        return reached

    def _share_key(self, i: int, tasks: Sequence[int]) -> bytes:
        """Robots with the same key can do the same sets of tasks."""
        if self.limits.is_timed:
            return str(i).encode()
        ways, capacity = self._ways_of(i, tasks), self.problem.capacity[i]
        return b"".join((ways.tobytes(), self.problem.work_usage(i)[list(tasks)].tobytes(), capacity.tobytes()))

    def may_do(self, i: int, tasks: Sequence[int]) -> Bools:
        """(2**k,) whether robot i may be able to do each set of k tasks: by usage, by time, by relations."""
        usages = self.subset_usages(i, tasks)
        able = usages <= self.problem.capacity[i] * (1 + ROUNDING)
        if self.limits.is_timed:
            able &= np.isfinite(subset_ends(self.limits, i, tasks)) & keep_relations(self.problem, tasks)
        return np.asarray(able)

    def subset_usages(self, i: int, tasks: Sequence[int]) -> Floats:
        """(2**k,) least usage of robot i for each set of k tasks, bit by bit; inf where it may not do one of them.

        Tasks of one route keep the order of prerequisites; nothing is waited for.
        """
        count, ways = len(tasks), self._ways_of(i, tasks)
        work = self.problem.work_usage(i)[list(tasks)]
        after = followers(self.problem, tasks)
        usage = np.full((1 << count, count), math.inf)  # by tasks done and the last of them
        for k in range(count):
            usage[1 << k, k] = ways[0, k + 1] + work[k]
        for done in range(1, 1 << count):
            onward = (usage[done][:, None] + ways[1:-1, 1:-1]).min(axis=0) + work
            for k in range(count):
                if not done >> k & 1 and not done & after[k]:
                    usage[done | 1 << k, k] = onward[k]
        least = np.asarray((usage + ways[1:-1, -1]).min(axis=1, initial=math.inf))
        least[0] = 0.0
        return least

    def _ways_of(self, i: int, tasks: Sequence[int]) -> Floats:
        """(k + 2, k + 2) least travel of robot i between its start, k tasks and its end."""
        return ways_of(self.problem, i, tasks, self.problem.legs, self.problem.work_usage(i))

    def least_together(self, robots: Sequence[int], tasks: Sequence[int]) -> float:
        """What robots use at least, together, to do tasks that no other robot does.

        The least work of each task, and the least forest that joins all of them to the robots' starts: routes are one.
        """
        if self._near is None or not len(tasks):
            return 0.0
        root, near = self._from_start[robots][:, tasks].min(axis=0), self._near[np.ix_(tasks, tasks)]
        allowed = self.problem.allowed[np.ix_(robots, tasks)]
        work = np.array([self.problem.work_usage(i)[list(tasks)] for i in robots])
        joined, _ = spanning_tree(near, root)
        return float(joined.sum()) + float(np.where(allowed, work, math.inf).min(axis=0).sum())

    @cached_property
    def _near(self) -> Floats | None:
        """(n, n) the shorter of the two ways between tasks, for the best robot; None where there are many tasks."""
        problem, count = self.problem, len(self.problem.tasks)
        if count > _MOST_IN_FOREST or len(problem.shortcuts()) > _MOST_SHORTCUTS:
            return None
        near, known = np.full((count, count), math.inf), set[object]()
        for i in range(len(problem.robots)):
            pace, through = problem.leg_times[i] if problem.in_time else None, problem.shortcuts()
            table = int(problem.travel[1][i]) if len(problem.travel[0]) else 0
            kind = pace, table, problem.allowed[i, through].tobytes(), problem.work_usage(i)[through].tobytes()
            if kind not in known:
                known.add(kind)
                near = np.minimum(near, least_ways(problem, i, range(count), problem.legs, problem.work_usage(i)))
        return np.asarray(np.minimum(near, near.T))

    @cached_property
    def _from_start(self) -> Floats:
        """(m, n) least travel from each robot's start to each task."""
        problem, count = self.problem, len(self.problem.tasks)
        if not len(problem.shortcuts()):
            return np.array([problem.legs(i, [problem.start(i)], range(count))[0] for i in range(len(problem.robots))])
        places = [[problem.start(i), *range(count)] for i in range(len(problem.robots))]
        ways = (least_ways(problem, i, near, problem.legs, problem.work_usage(i)) for i, near in enumerate(places))
        return np.array([way[0, 1:] for way in ways])


def _places(problem: Problem, tasks: Sequence[int]) -> list[int]:
    """For each task its places, as bits."""
    places, first = [], 0
    for j in tasks:
        count = problem.model.least_members(j)
        places.append(((1 << count) - 1) << first)
        first += count
    return places


def _filled(places: Sequence[int], before: int, share: int) -> int:
    """The places that are filled once one more robot does a set of tasks: of each the first free one."""
    for k, of_task in enumerate(places):
        if share >> k & 1 and of_task & ~before:
            free = of_task & ~before
            before |= free & -free
    return before


def _largest(sets: Iterable[int]) -> list[int]:
    """The sets, as bits, that are in no other."""
    kept: list[int] = []
    for one in sorted(set(sets), key=int.bit_count, reverse=True):
        if all(one & ~other for other in kept):
            kept.append(one)
    return kept
