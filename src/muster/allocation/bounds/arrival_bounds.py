"""Lower bounds of the sum of usages on arrival, by forests: what the beginnings of routes cost at least."""

from __future__ import annotations

import math
from collections.abc import Callable

import numpy as np

from muster.allocation.bounds.spanning import Ways, never
from muster.model.problem import Floats, Indices

_GROUPS = 4  # of levels, each with multipliers of its own
_ROUNDS = 50  # for each group
_EFFORT = 4e7  # of all trees: nodes times nodes and calls, as for routes
_CALLS = 2000
_FIRST_STEP, _LAST_STEP = 0.3, 0.01  # in legs of the tree; in first steps


def least_arrivals(ways: Ways, robots: int, due: Callable[[], bool] = never) -> float:
    """A lower bound of the sum over all tasks of the usage on arrival, of plans that do each with one robot.

    Theorem. A leg counts as often as tasks follow on it to the end of its route, and so does the work before it. The
    sum of arrivals is therefore the sum over levels p = 1, 2, ... of what the beginnings of routes cost that have p - 1
    tasks behind them. Those of level p have k = n - m (p - 1) legs or more with m robots. With half the work of a task
    put on each of its legs they cost what their legs cost, less half the work of their last tasks, of which there are m
    at most. The legs join tasks to a root for all starts without a cycle, and a task has two at most. So for any
    multipliers q_j >= 0 a level costs at least

        the k least edges of the least spanning tree of legs c(i, j) + (w_i + w_j) / 2 + q_i + q_j
        and first legs min_d c(d, j) + w_j / 2 + q_j  -  2 sum_j q_j  -  sum of the m greatest w_j / 2,

    as no forest with k edges costs less [kruskal1956]. The multipliers ascend by the subgradients of some levels
    together, and each level keeps the best of its bounds. No triangle inequality is used.
    """
    n, root = len(ways.work), ways.starts.min(axis=0)
    sizes = n - robots * np.arange(-(-n // robots))
    last_work = np.sort(ways.work)[::-1][:robots].sum() / 2
    best = np.zeros(len(sizes))
    rounds = int(min(_ROUNDS, max(1, _EFFORT / (_GROUPS * n * (n + _CALLS)))))
    for group in np.array_split(sizes, min(_GROUPS, len(sizes))):
        q, memory, step = np.zeros(n), np.zeros(0), math.nan
        for _ in range(rounds):
            p = ways.work / 2 + q
            joined, parent = ways.legs.tree(root + p, p, due)
            if due():
                return float(best.sum())
            tree = float(joined.sum())
            if math.isinf(tree):
                return math.inf
            order = np.argsort(joined, kind="stable")
            best = np.maximum(best, np.cumsum(joined[order])[sizes - 1] - 2 * q.sum() - last_work)
            slope = _degrees(order, parent, group) - 2
            memory = 0.6 * slope + 0.4 * (memory if len(memory) else slope)
            step = _FIRST_STEP * tree / n if math.isnan(step) else step * _LAST_STEP ** (1 / rounds)
            q = np.maximum(0.0, q + step * memory)
    return float(best.sum())


def _degrees(order: Indices, parent: Indices, sizes: Indices) -> Floats:
    """(n,) how many edges a task has in forests of so many of a tree's least edges, on average.

    `order` has the tasks by the cost of the edges to their parents.
    """
    share = np.empty(len(order))
    share[order] = (sizes[:, None] > np.arange(len(order))).mean(axis=0)
    inner = parent >= 0
    return np.asarray(share + np.bincount(parent[inner], weights=share[inner], minlength=len(order)))
