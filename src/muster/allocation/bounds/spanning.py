"""Lower bounds by spanning trees: no set of routes costs less than the least tree over its places."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from muster import core
from muster.model.problem import Bools, Floats, Indices, Problem

_DENSE = 1500  # tasks up to which all legs are held at once
_EFFORT = 2e8  # of all trees: nodes times nodes and calls
_CALLS = 2000  # how many nodes of a row cost as much as calling NumPy
_MOST_ROUNDS = 300
_FIRST_STEP = 0.3  # of multipliers, in legs of the first tree
_LAST_STEP = 0.003  # in first steps
_MOST_GROUPS = 16  # of robots by travel table and surplus work, up to which legs know the surplus
_MOST_KINDS = 600  # kinds of task, by the robots that can do them, up to which legs know who can do both ends


class Legs:
    """The least leg between two tasks over the robots that can do both, in the unit of usage; inf where there is none.

    A robot's leg has half its `surplus` (m, n) of work at both ends. Where the tasks differ in too many ways in who can
    do them, the least over all robots.
    """

    def __init__(self, problem: Problem, usable: Bools, weights: Floats, surplus: Floats) -> None:
        self._problem = problem
        self._tasks = np.arange(len(problem.tasks))
        self.symmetric = not len(problem.shortcuts())
        kinds, kind_of = np.unique(usable, axis=1, return_inverse=True)
        if kinds.shape[1] > _MOST_KINDS:
            kinds, kind_of = np.ones((len(usable), 1), np.bool_), np.zeros(len(self._tasks), np.int64)
        self._kind_of = kind_of.reshape(-1)
        self._groups = _groups(problem, kinds, weights, surplus)
        self._dense = self._between(self._tasks) if len(self._tasks) <= _DENSE else None

    def tree(self, root: Floats, p: Floats, due: Callable[[], bool]) -> tuple[Floats, Indices]:
        """The least spanning tree of a root and all tasks, of which edges cost the multipliers p (n,) of both tasks.

        For each task the cost of the edge that joins it to its parent, and the parent, -1: the root. `root` (n,) are
        the edges from the root. From when it is `due` the tree is not finished.
        """
        if self._dense is not None:
            return spanning_tree(self._dense, root, p)
        return _tree_of_rows(lambda task: self._between(self._tasks[task : task + 1])[0], root, p, due)

    def _between(self, some: Indices) -> Floats:
        legs = self.directed(some)
        return legs if self.symmetric else np.asarray(np.minimum(legs, self.directed(some, reverse=True)))

    def directed(self, some: Indices, *, reverse: bool = False) -> Floats:
        """(len(some), n) the least legs from some tasks to all, or from all to some."""
        least = np.full((len(some), len(self._tasks)), math.inf)
        for i, pace, half in self._groups:
            for at in range(0, len(some), 100):
                few = some[at : at + 100]
                legs = (
                    self._problem.metres(i, self._tasks, few).T
                    if reverse
                    else self._problem.metres(i, few, self._tasks)
                )
                factor = pace[self._kind_of[few][:, None], self._kind_of[None]]
                scaled = np.full(legs.shape, math.inf)
                np.multiply(legs, factor, out=scaled, where=np.isfinite(factor) & np.isfinite(legs))
                scaled += half[few][:, None] + half
                np.minimum(least[at : at + 100], scaled, out=least[at : at + 100])
        least[np.arange(len(some)), some] = math.inf
        return least


def _groups(problem: Problem, kinds: Bools, weights: Floats, surplus: Floats) -> list[tuple[int, Floats, Floats]]:
    """One robot of each group with a travel table and surplus work in common, and what its legs are made of.

    (kinds, kinds) is the least that a metre takes of the robots for both kinds of task; (n,) is half the surplus.
    """
    _, classes = problem.travel
    tables = classes if len(classes) else np.zeros(len(problem.robots), np.int32)
    metre = weights / np.array([robot.speed_mps if problem.in_time else 1.0 for robot in problem.robots])
    alike = np.column_stack([tables, surplus])
    if len(np.unique(alike, axis=0)) > _MOST_GROUPS:
        alike = np.column_stack([tables, np.zeros_like(surplus)])
    like, group_of = np.unique(alike, axis=0, return_inverse=True)
    groups = []
    for k, (_, *common) in enumerate(like):
        members = np.flatnonzero(group_of.reshape(-1) == k)
        costs = np.where(kinds[members], metre[members, None], math.inf)
        pace = np.array([np.maximum(costs, row[:, None]).min(axis=0) for row in costs.T])
        groups.append((int(members[0]), pace, np.array(common) / 2))
    return groups


@dataclass(frozen=True)
class Ways:
    """What the legs and tasks of routes cost at least.

    Parameters
    ----------
    legs
        between tasks.
    work
        (n,) the least work usage of each task.
    starts
        (d, n) the leg from a robot's start to a task; like robots are one row.
    ends
        (d, n) the leg from a task to where the robot must end; 0 where it may end anywhere.
    robots
        (d,) how many robots each row stands for.
    """

    legs: Legs
    work: Floats
    starts: Floats
    ends: Floats
    robots: Indices

    @classmethod
    def of(cls, problem: Problem, usable: Bools, weights: Floats | None = None, *, with_surplus: bool = True) -> Ways:
        """The costs of a problem of which only some pairs (m, n) of robot and task are usable.

        With (m,) `weights` every robot's usage counts so many times. `with_surplus`: what a robot's work on a task is
        above the least counts half with the leg before it, and half with the leg or end after it.
        """
        weights = np.ones(len(problem.robots)) if weights is None else weights
        tasks = np.arange(len(problem.tasks))
        work = weights[:, None] * np.array([problem.work_usage(i) for i in range(len(problem.robots))])
        least = np.where(usable, work, math.inf).min(axis=0)
        surplus = np.where(usable & with_surplus, work - least, 0.0)
        rows = []
        for i, robot in enumerate(problem.robots):
            start = problem.legs(i, [problem.start(i)], tasks)[0]
            is_open = robot.place_at_end(problem.mission.rules) is None
            end = np.zeros(len(tasks)) if is_open else problem.legs(i, tasks, [problem.end(i)])[:, 0]
            legs = np.array([_times(weights[i], start), _times(weights[i], end)]) + surplus[i] / 2
            rows.append(np.where(usable[i], legs, math.inf).ravel())
        like, robots = np.unique(np.array(rows)[usable.any(axis=1)], axis=0, return_counts=True)
        starts, ends = np.hsplit(like, 2)
        return cls(Legs(problem, usable, weights, surplus), least, starts, ends, robots)

    def entering(self, *, after_work: bool = False) -> Floats:
        """(n,) the least leg into each task, from another or a start; `after_work`: with the work of the other."""
        before = self.work if after_work else np.zeros(len(self.work))
        return np.asarray(np.minimum(self.starts.min(axis=0), self._least(before, reverse=True)))

    def leaving(self) -> Floats:
        """(n,) the least leg out of each task, to another or an end."""
        return np.asarray(np.minimum(self.ends.min(axis=0), self._least(np.zeros(len(self.work)))))

    def _least(self, added: Floats, *, reverse: bool = False) -> Floats:
        n = len(self.work)
        blocks = (np.arange(at, min(n, at + 100)) for at in range(0, n, 100))
        return np.concatenate([(self.legs.directed(few, reverse=reverse) + added).min(axis=1) for few in blocks])


def _times(weight: float, legs: Floats) -> Floats:
    """Weighted legs; one that does not exist stays so if it weighs nothing."""
    return np.where(np.isfinite(legs), weight * np.where(np.isfinite(legs), legs, 0.0), math.inf)


def never() -> bool:
    """It is never time to stop."""
    return False


def route_bounds(
    ways: Ways,
    worth: Callable[[Floats], Floats],
    due: Callable[[], bool] = never,
    effort: float = _EFFORT,
) -> Floats:
    """(K,) lower bounds of the total cost of plans that do every task with 1, 2, ..., K routes; inf: no such plan.

    Theorem. Let a plan with k routes do every task. A leg between tasks costs no less than the lesser of both
    directions, over the robots that can do both tasks. With a root for all starts, the legs from starts and between
    tasks are a spanning tree of root and tasks, and k tasks are last in a route. Each task has degree 2, if being last
    counts; no start is left more than once; and of like robots as many routes end as start. For any multipliers p_j of
    tasks, a_d >= 0 and b_d of groups d of r_d like robots the plan's cost is therefore at least

        sum_j (w_j - 2 p_j) - sum_d r_d a_d
        + least spanning tree of legs c(i, j) + p_i + p_j and first legs min_d (c(d, j) + a_d - b_d) + p_j
        + sum of the k least min_d (c(j, d) + b_d) + p_j,

    where w_j is the least work, and legs hold half of what the robot's work on their tasks is above it; c(j, d) does,
    too. This is the bound of
    [held-karp1970], for several paths from several depots. No triangle inequality is used. The multipliers ascend by
    the subgradients of the k that is worth least, with the memory of [volgenant1982]; for every k the best bound is
    kept. Where travel is asymmetric the sums of the least legs into tasks, and out of them, can be better. From when
    it is `due` no more multipliers are tried. `effort` is that of all trees: nodes times nodes and calls.

    Where each robot has a route every start is left just r_d times, and the a_d of either sign will do. If such plans
    are worth least the multipliers ascend for them once more.
    """
    n, count = len(ways.work), min(len(ways.work), int(ways.robots.sum()))
    rounds = int(min(_MOST_ROUNDS, max(2, effort / (n * (n + _CALLS)))))
    best = _ascended(ways, worth, due, _by_degrees(ways, count), rounds)
    if count == ways.robots.sum() and int(worth(best).argmin()) == count - 1 and not due():
        best[-1] = max(best[-1], _ascended(ways, worth, due, best, rounds, all_leave=True)[-1])
    return best


def _ascended(
    ways: Ways,
    worth: Callable[[Floats], Floats],
    due: Callable[[], bool],
    best: Floats,
    rounds: int,
    *,
    all_leave: bool = False,
) -> Floats:
    """The bounds of `route_bounds` after so many steps; `all_leave`: of plans in which each robot has a route alone."""
    n, count = len(ways.work), len(best)
    p, a, b = np.zeros(n), np.zeros(len(ways.robots)), np.zeros(len(ways.robots))
    least = np.full(len(a), -math.inf if all_leave else 0.0)
    if all_leave:
        a -= ways.starts.min(axis=1)  # the way out of each start then costs nothing
    step, memory = math.nan, np.zeros(0)
    for _ in range(rounds):
        first, group = _least_rows(ways.starts + (a - b)[:, None])
        last, end_group = _least_rows(ways.ends + b[:, None])
        joined, parent = ways.legs.tree(first + p, p, due)
        if due():
            break
        tree = float(joined.sum())
        if math.isinf(tree):
            return np.full(count, math.inf)
        roots = np.flatnonzero(parent < 0)
        degree = np.bincount(parent[parent >= 0], minlength=n) + 1
        order = np.argsort(last + p, kind="stable")[:count]
        fixed = (ways.work - 2 * p).sum() - (ways.robots * a).sum()
        best = np.maximum(best, tree + fixed + np.cumsum((last + p)[order]))
        k = count if all_leave else int(worth(best).argmin()) + 1
        degree[order[:k]] += 1
        left = np.bincount(group[roots], minlength=len(a))
        reached = np.bincount(end_group[order[:k]], minlength=len(a))
        slope = np.concatenate((degree - 2, left - ways.robots, reached - left))
        memory = 0.6 * slope + 0.4 * (memory if len(memory) else slope)
        step = _FIRST_STEP * tree / n if math.isnan(step) else step * _LAST_STEP ** (1 / rounds)
        move = step * memory
        p, a, b = p + move[:n], np.maximum(least, a + move[n : n + len(a)]), b + move[n + len(a) :]
    return best


def _by_degrees(ways: Ways, count: int) -> Floats:
    """(count,) the bounds by the least legs into tasks, and out of them, for 1, 2, ... routes."""
    work = ways.work.sum()
    if ways.legs.symmetric:
        return np.full(count, work)
    into = ways.entering().sum() + np.cumsum(np.sort(ways.ends.min(axis=0))[:count])
    out = ways.leaving().sum() + np.cumsum(np.sort(ways.starts.min(axis=0))[:count])
    return np.asarray(work + np.maximum(into, out))


def _least_rows(costs: Floats) -> tuple[Floats, Indices]:
    """For each column the least cost, and its row."""
    row = costs.argmin(axis=0)
    return costs[row, np.arange(costs.shape[1])], row


def spanning_tree(legs: Floats, root: Floats, p: Floats | None = None) -> tuple[Floats, Indices]:
    """The least spanning tree of a root and n tasks, of legs (n, n), symmetric; else as `Legs.tree` [prim1957]."""
    n = len(root)
    joined, parent = np.empty(n), np.empty(n, np.int64)
    core.spanning_tree(np.ascontiguousarray(legs), root, np.zeros(n) if p is None else p, joined, parent)
    return joined, parent


def _tree_of_rows(
    row: Callable[[int], Floats], root: Floats, p: Floats, due: Callable[[], bool]
) -> tuple[Floats, Indices]:
    """The same, with one `row` of the legs at a time."""
    n = len(root)
    reach, outside, parent = root.copy(), np.ones(n, np.bool_), np.full(n, -1)
    joined = np.zeros(n)
    for _ in range(n):
        if due():
            break
        task = int(reach.argmin())
        joined[task] = reach[task]
        reach[task], outside[task] = math.inf, False
        legs = row(task) + p
        nearer = (legs < reach - p[task]) & outside
        np.copyto(reach, legs + p[task], where=nearer)
        parent[nearer] = task
    return joined, parent
