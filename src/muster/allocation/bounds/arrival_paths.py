"""Lower bounds of the sum of usages on arrival, by paths that may come back to a task but pay for it each time."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass

import numpy as np

from muster.allocation.bounds.spanning import never
from muster.model.problem import Bools, Floats, Indices, Problem

_EFFORT = 2e9  # of all rounds: kinds of robot times levels times tasks squared
_ROUNDS, _LEAST_ROUNDS = 120, 30  # with fewer the prices are worth nothing
_LEVELS = 4  # how many times its even share of the tasks a route is followed, or so
_FIRST_AIM, _LAST_AIM = 0.1, 0.002  # how far above the best bound so far steps aim, relative

_ROUNDING = 1e-12  # of sums, relative to prices

_Follower = tuple[Indices, Indices]  # of each task the best that may follow, and the second best


@dataclass(frozen=True)
class _Kind:
    """Robots that differ in nothing but where they start.

    Parameters
    ----------
    steps
        (n, n) what the leg from a task to another takes, with the work of the former; inf where there is none.
    starts
        (d, n) the leg from a start to a task.
    robots
        (d,) how many robots each start stands for.
    """

    steps: Floats
    starts: Floats
    robots: Indices

    def entering(self) -> Floats:
        """(n,) the least that goes before each task."""
        return np.asarray(np.minimum(self.steps.min(axis=0), self.starts.min(axis=0)))


@dataclass(frozen=True)
class _Cheapest:
    """For each start the cheapest paths of a kind by their first task: (d, n) cost and number of tasks.

    `followers`: for each number of tasks from here to the end of a path.
    """

    costs: Floats
    sizes: Indices
    followers: Sequence[_Follower]

    def least(self) -> Floats:
        """(d,) what a robot pays at least; nothing if it stays."""
        return np.asarray(np.minimum(0.0, self.costs.min(axis=1)))

    def visits(self, robots: Indices) -> Indices:
        """(n,) how often tasks are on paths, if like robots begin with different ones."""
        seen = [
            task
            for costs, sizes, count in zip(self.costs, self.sizes, robots, strict=True)
            for first in np.argsort(costs, kind="stable")[:count]
            if costs[first] < 0.0
            for task in self._path(int(first), int(sizes[first]))
        ]
        return np.bincount(np.array(seen, np.int64), minlength=self.costs.shape[1])

    def _path(self, task: int, size: int) -> Iterator[int]:
        before = -1
        yield task
        for best, second in reversed(self.followers[1:size]):
            after = best[task] if best[task] != before else second[task]
            before, task = task, int(after)
            yield task


def least_arrivals_on_paths(problem: Problem, usable: Bools, known: float, due: Callable[[], bool] = never) -> float:
    """A lower bound of the sum over all tasks of the usage on arrival, of plans that do each with one robot.

    Theorem. Let tasks have any prices p_j. The r-th task from the end of a route is entered by a leg that counts r
    times, with the work before it. A plan's sum of arrivals is that of its routes less the prices of their tasks, plus
    all prices; so it is at least the sum of the prices and, for each robot, the lesser of 0 and what the cheapest path
    from its start costs less its prices. All routes are among the paths that may come back to a task, but not by way of
    one other alone [houck1980]: of these the cheapest is found level by level from the end, r = 1, 2, ...
    [picard-queyranne1978]. Paths of more than r tasks need not be looked at once it is known that they are dearer:
    they have an end of r tasks, which costs what was found, and before it only tasks that each take at least their
    least leg r + 1 times, less their price. No triangle inequality is used. The prices ascend by subgradients, by steps
    that aim a little above the best bound so far, or the one that is `known` [held-wolfe-crowder1974].

    The bound is 0 where there are too many tasks for the effort.
    """
    n, robots = usable.shape[1], int(usable.any(axis=1).sum())
    per_round = n * n * min(n, _LEVELS * -(-n // robots))
    if per_round * _LEAST_ROUNDS > _EFFORT:
        return 0.0
    kinds = _kinds(problem, usable)
    if per_round * _LEAST_ROUNDS * len(kinds) > _EFFORT:
        kinds = [_merged(kinds)]
    rounds = int(min(_ROUNDS, _EFFORT / (per_round * len(kinds))))
    entering = np.min([kind.entering() for kind in kinds], axis=0)
    prices: Floats = np.full(n, entering.mean() * n / robots)
    if not np.isfinite(prices).all():
        return math.inf  # nobody gets to one of them
    best = 0.0
    memory: Floats = np.zeros(0)
    for aim in np.geomspace(_FIRST_AIM, _LAST_AIM, rounds).tolist():
        found = [_cheapest(kind, prices) for kind in kinds]
        if due():
            break
        paid = sum(float(kind.robots @ paths.least()) for kind, paths in zip(kinds, found, strict=True))
        bound = float(prices.sum()) + paid - _ROUNDING * float(np.abs(prices).sum())
        best = max(best, bound)
        visits = np.sum([paths.visits(kind.robots) for kind, paths in zip(kinds, found, strict=True)], axis=0)
        slope = np.asarray(1.0 - visits)
        memory = 0.5 * slope + 0.5 * (memory if len(memory) else slope)
        if not slope.any():
            break  # the paths are a plan: no prices are better
        prices = prices + ((1 + aim) * max(best, known) - bound) / max(1.0, memory @ memory) * memory
    return best


def _kinds(problem: Problem, usable: Bools) -> list[_Kind]:
    """The robots that can do some task, by kind."""
    tasks = range(usable.shape[1])
    kinds = dict[bytes, tuple[Floats, list[Floats]]]()
    for i in np.flatnonzero(usable.any(axis=1)).tolist():
        steps = problem.legs(i, tasks, tasks) + problem.work_usage(i)[:, None]
        steps[~(usable[i][:, None] & usable[i])] = math.inf
        np.fill_diagonal(steps, math.inf)
        start = np.where(usable[i], problem.legs(i, [problem.start(i)], tasks)[0], math.inf)
        kinds.setdefault(steps.tobytes(), (steps, []))[1].append(start)
    return [_Kind(steps, *np.unique(starts, axis=0, return_counts=True)) for steps, starts in kinds.values()]


def _merged(kinds: Sequence[_Kind]) -> _Kind:
    """Robots that take each leg as the best of them do."""
    steps = np.min([kind.steps for kind in kinds], axis=0)
    return _Kind(steps, np.vstack([kind.starts for kind in kinds]), np.concatenate([kind.robots for kind in kinds]))


def _cheapest(kind: _Kind, prices: Floats) -> _Cheapest:
    """The cheapest paths, from the end, until longer ones are known to be dearer."""
    tasks, entering = np.arange(len(prices)), kind.entering()
    costs, sizes = np.full(kind.starts.shape, math.inf), np.zeros(kind.starts.shape, np.int64)
    best, second, follower = -prices, np.full(len(prices), math.inf), tasks
    followers: list[_Follower] = [(tasks, tasks)]
    for size in range(1, len(prices) + 1):
        paths = size * kind.starts + best
        better = paths < costs
        costs[better], sizes[better] = paths[better], size
        before = np.minimum(0.0, (size + 1) * entering - prices).sum()
        if best.min() + before >= min(0.0, float(costs.min(axis=1).max())):
            break
        onward = size * kind.steps + best
        onward[follower, tasks] = size * kind.steps[follower, tasks] + second  # not at once back to where it came from
        follower = onward.argmin(axis=1)
        best = onward[tasks, follower] - prices
        onward[tasks, follower] = math.inf
        next_best = onward.argmin(axis=1)
        second = onward[tasks, next_best] - prices
        followers.append((follower, next_best))
    return _Cheapest(costs, sizes, followers)
