"""Lower bounds of the greatest usage, by weighed means over robots and by the tasks that are far away."""

from __future__ import annotations

import math
from collections.abc import Callable

import numpy as np

from muster.allocation.bounds.spanning import Ways, never, route_bounds
from muster.allocation.bounds.team_copies import of_tasks
from muster.model.problem import Bools, Floats, Problem

_MOST_KINDS = 10  # of task, by the robots that can do them, for which robots are weighed
_MOST_TASKS = 300
_LEAST_USAGE = 1e-9  # for a task, that robots are weighed by
_AT_HAND = (0.03, 0.06, 0.1, 0.15, 0.2, 0.3, 0.5)  # of all tasks, that are left out
_EFFORT = 8e7  # as in `route_bounds`, for each kind and share of tasks


def weighed_shares(problem: Problem, usable: Bools, due: Callable[[], bool] = never) -> Floats:
    """(k,) bounds of the greatest usage in plans with 1, 2, ..., k routes, by weighed means over robots.

    Theorem. The greatest usage of the robots that have a route is at least any weighed mean of theirs. Whatever they
    are, k robots weigh no more than the k heaviest, so that it is at least a bound of the total cost in which usages
    are weighed, over the weight of these. Weights are here as many tasks as a robot does in a time, about, for then the
    slow do not seem to help more than they can; and nothing for robots that cannot do a kind of task: the others have
    to share it.
    """
    everyone = usable.any(axis=1)
    kinds = np.unique(np.column_stack([everyone, usable]), axis=1).T
    if len(kinds) > _MOST_KINDS or usable.shape[1] > _MOST_TASKS:
        return np.zeros(1)
    pace = _paces(problem)
    shares = [
        _weighed_share(problem, usable, weights, due)
        for weights in kinds * pace / (kinds @ pace)[:, None]
        if np.ptp(weights[everyone])  # else it is the even share
    ]
    return np.asarray(np.max(shares, axis=0)) if shares else np.zeros(1)


def far_shares(problem: Problem, usable: Bools, due: Callable[[], bool] = never) -> Floats:
    """(k,) bounds of the greatest usage in plans with 1, 2, ..., k routes, by the tasks farthest from all starts.

    Theorem. Where no way through a task is shorter than the direct one, a plan that leaves tasks out costs no robot
    more. It may leave robots without a route; so the greatest usage of plans with k routes is at least the least
    weighed share, as in `weighed_shares`, of plans of some tasks with k routes or fewer. The tasks far away can tell
    more than all: with tasks at hand each robot seems to have a route, and one of them does all the rest.
    """
    if len(problem.shortcuts()) or usable.shape[1] > _MOST_TASKS:
        return np.zeros(1)
    tasks, everyone = range(usable.shape[1]), usable.any(axis=1)
    starts = np.array([problem.legs(i, [problem.start(i)], tasks)[0] for i in range(len(problem.robots))])
    nearest_first = np.where(usable, starts, math.inf).min(axis=0).argsort(kind="stable")
    weights = everyone * _paces(problem)
    best = np.zeros(min(len(tasks), int(everyone.sum())))
    for left_out in {math.floor(share * len(tasks)) for share in _AT_HAND} - {0}:
        far = nearest_first[left_out:]
        bounds = _weighed_share(of_tasks(problem, far.tolist()), usable[:, far], weights / weights.sum(), due)
        fewer = np.minimum.accumulate(bounds)
        best = np.maximum(best, np.pad(fewer, (0, len(best) - len(fewer)), mode="edge"))
    return best


def _paces(problem: Problem) -> Floats:
    """(m,) how many tasks robots do for their usage, about."""
    return np.array([1.0 / _usual_usage(problem, i) for i in range(len(problem.robots))])


def _usual_usage(problem: Problem, i: int) -> float:
    """What a task takes of robot i, about: its work and the leg from the nearest other."""
    tasks = range(len(problem.tasks))
    legs = problem.legs(i, tasks, tasks)
    np.fill_diagonal(legs, math.inf)
    usages = problem.work_usage(i) + legs.min(axis=0)
    return max(_LEAST_USAGE, float(np.where(np.isfinite(usages), usages, 0.0).mean()))


def _weighed_share(problem: Problem, usable: Bools, weights: Floats, due: Callable[[], bool]) -> Floats:
    """The bounds of `weighed_shares` by some weights."""
    count = min(usable.shape[1], int(usable.any(axis=1).sum()))
    heaviest = np.cumsum(np.sort(weights)[::-1])[:count]

    def shared(totals: Floats) -> Floats:
        return totals / heaviest

    return shared(route_bounds(Ways.of(problem, usable, weights), shared, due, _EFFORT))
