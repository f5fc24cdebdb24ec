"""Lower bounds of the objective over all plans that do every task, at once and without a solver.

What every such plan pays is bounded by relaxing its routes to a spanning tree: see `route_bounds`. The bounds hold
for all that a mission may ask: several speeds and travel tables, travel that is asymmetric or breaks the triangle
inequality, closed and open routes, capacities, waiting. They are worked out in float64, and are true up to its
rounding, some 1e-12 relative.
"""

from __future__ import annotations

import itertools
import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace

import numpy as np

from muster.allocation.bounds.arrival_bounds import least_arrivals
from muster.allocation.bounds.arrival_paths import least_arrivals_on_paths
from muster.allocation.bounds.earliest_times import EarliestTimes, in_time, kth_least, opened
from muster.allocation.bounds.feasibility import least_usages, usable_pairs
from muster.allocation.bounds.spanning import Ways, never, route_bounds
from muster.allocation.bounds.team_copies import with_copies
from muster.allocation.bounds.weighed_shares import far_shares, weighed_shares
from muster.mission.errors import MusterError
from muster.model.problem import Bools, Floats, Problem
from muster.model.rules.rule import ROUNDING

_HELD_KARP = "Held and Karp, Operations Research 18, 1970"
_TREES, _FARTHEST = "spanning trees with multipliers", "the farthest task"
_WEIGHED, _SHARE, _FAR = "a weighed share", "an even share", "the tasks far away"
_LEAST_WAYS, _IN_TURN, _CRITICAL = "the least way to each task", "tasks in turn", "the critical path"
_FORESTS, _PATHS = "forests of beginnings", "paths by the number of tasks behind"
_MOST_CHOICES = 32  # of one of each set of alternatives, up to which bounds of each choice are compared
_CHOSEN_AMONG = 1e5  # choices times tasks squared
_NO_TASKS, _NOBODY = "no tasks", "a task that nobody can do"
WHY = {
    _TREES: f"starts and tasks joined by routes are spanning trees, and every task has two neighbours ({_HELD_KARP})",
    _FARTHEST: "some robot must get to it, do it and go to its end, by the shortest way (Dijkstra, Num. Math. 1, 1959)",
    _WEIGHED: f"robots that are fast, or that alone can do a kind of task, count more; spanning trees ({_HELD_KARP})",
    _FAR: f"to do them alone would take no robot more, and they are shared at best; spanning trees ({_HELD_KARP})",
    _SHARE: f"at best all robots use the same, together no less than spanning trees with multipliers ({_HELD_KARP})",
    _LEAST_WAYS: "no robot arrives anywhere with less usage than by the shortest way (Dijkstra, Num. Math. 1, 1959)",
    _IN_TURN: "robots do one task after the other, at best the shortest first"
    " (Conway, Maxwell and Miller, Theory of Scheduling, 1967)",
    _FORESTS: "the beginnings of routes that have a number of tasks behind them are forests, at best the least"
    " (Kruskal, Proceedings of the American Mathematical Society 7, 1956)",
    _PATHS: "each task has a price, and robots take the cheapest paths, whose legs count once for each task behind them"
    " (Picard and Queyranne, Operations Research 26, 1978)",
    _CRITICAL: "a task waits for its robots, its prerequisites and its windows, and they for theirs"
    " (Kelley and Walker, Eastern Joint Computer Conference, 1959)",
    _NO_TASKS: "there is nothing to do",
    _NOBODY: "no plan does it",
}
"""What each argument says, and whose it is."""


@dataclass(frozen=True)
class Bound:
    """A lower bound of the objective, and the arguments that gave it; inf where no plan does every task.

    `cut_short`: whether it was worked out as far as there was time, and might be better.
    """

    value: float
    arguments: tuple[str, ...]
    cut_short: bool = False

    @property
    def why(self) -> str:
        """The arguments in words, with their sources."""
        words = "; ".join(f"{name}: {WHY[name]}" for name in self.arguments)
        return f"{words}; cut short by the time limit" if self.cut_short else words


def sound_bound(bound: float, value: float, why: str) -> float:
    """The bound of the objective of a plan, cut down to its value where rounding alone has put it above.

    Raises
    ------
    MusterError
        if it is above the value by more than that: the argument for the bound is wrong.
    """
    if bound > value and not math.isclose(bound, value, rel_tol=ROUNDING, abs_tol=ROUNDING):
        raise MusterError(f"internal error: a lower bound of {bound!r} for a plan whose objective is {value!r}: {why}")
    return min(bound, value)


def lower_bound(problem: Problem) -> float:
    """A number that no plan that does every task can have a lower objective than; inf where there is no such plan."""
    return best_bound(problem).value


def best_bound(problem: Problem, due: Callable[[], bool] = never) -> Bound:
    """The best of the bounds of the problem's objective, with its arguments, as far as found when `due` says stop."""
    bound = _best_bound(problem, due)
    return replace(bound, cut_short=due())


def _best_bound(problem: Problem, due: Callable[[], bool]) -> Bound:
    if not problem.tasks:
        return Bound(0.0, (_NO_TASKS,))
    choices = _choices(problem)
    if choices:
        bounds = [_best_bound(problem.part(range(len(problem.robots)), tasks), due) for tasks in choices]
        return min(bounds, key=lambda bound: bound.value)
    least = least_usages(problem)
    usable = usable_pairs(problem, least)
    if not _of_each(problem, np.asarray(usable.any(axis=0), np.float64), best=np.max).all():
        return Bound(math.inf, (_NOBODY,))
    if problem.objective == "average":
        return _average(problem, usable, due)
    if problem.objective == "makespan":
        return _makespan(problem, usable, due)
    if problem.objective == "lateness":
        return _lateness(problem, usable)
    return _usage(problem, usable, least, due)


def _choices(problem: Problem) -> list[list[int]]:
    """The tasks of plans that do one of each set of alternatives, where these are few; none: they are not.

    What only plans with another alternative could do is in none of them.
    """
    sets, tasks = problem.model.alternatives, range(len(problem.tasks))
    if not sets or math.prod(map(len, sets)) > min(_MOST_CHOICES, _CHOSEN_AMONG / len(tasks) ** 2):
        return []
    begun = {j for route in problem.fixed for j in route}
    found = []
    for chosen in itertools.product(*sets):
        out = {j for alike in sets for j in alike}.difference(chosen)
        if out.isdisjoint(begun) and out.isdisjoint(problem.closed(j for j in tasks if j not in out)):
            found.append([j for j in tasks if j not in out])
    return found


def _of_each(problem: Problem, values: Floats, best: Callable[[Floats], float] = np.min) -> Floats:
    """(k,) of the values of tasks (n,) those of tasks in whose place no other is done, then of each set the least."""
    sets = problem.model.alternatives
    sure = np.ones(len(values), np.bool_)
    sure[[j for alike in sets for j in alike]] = False
    return np.concatenate([values[sure], [best(values[alike]) for alike in sets]])


def _usage(problem: Problem, usable: Bools, least: Floats, due: Callable[[], bool]) -> Bound:
    """Bound `total`, `max` and `total+max`.

    Theorem. Let L_k bound the total cost of the plans with k routes that do every task. Then (1) the greatest usage of
    such a plan is at least the least U for which the k greatest capacities, each cut down to U, sum up to L_k; for
    unlimited robots that is L_k / k. There is no such plan if they do not sum up to L_k at all. (2) It is at least what
    the task that is farthest away takes by itself, the maximum over tasks of the minimum over robots of `least_usage`,
    and what `weighed_shares` and `far_shares` tell. (3) Total and greatest usage together are at least the sum of their
    bounds, for the same k. The bound is the least over k.
    """
    members = [problem.model.least_members(j) for j in range(len(problem.tasks))]
    alone = float(_of_each(problem, kth_least(np.where(usable, least, math.inf), members)).max())
    copied = with_copies(problem, usable)
    if copied is None:
        return _by_tasks_alone(problem, np.where(usable, least, math.inf), members)
    capacity = np.sort(problem.capacity[copied.usable.any(axis=1)])[::-1]
    problem, usable = copied.problem, copied.usable
    shares = {} if problem.objective == "total" else _shares(problem, usable, due)

    def worth(totals: Floats) -> Floats:
        greatest = np.max([_evened(totals, capacity), *shares.values(), np.full(len(totals), alone)], axis=0)
        values = {"total": totals, "max": greatest, "total+max": totals + greatest}[problem.objective]
        return np.where(np.isfinite(greatest), values, math.inf)

    totals = route_bounds(Ways.of(problem, usable), worth, due)
    values = worth(totals)
    k = int(values.argmin())
    greatest = {
        _FARTHEST: alone,
        **{name: float(bounds[k]) for name, bounds in shares.items()},
        _SHARE: float(_evened(totals, capacity)[k]),
    }
    best = max(greatest, key=lambda name: greatest[name])
    return Bound(float(values[k]), {"total": (_TREES,), "max": (best,)}.get(problem.objective, (_TREES, best)))


def _shares(problem: Problem, usable: Bools, due: Callable[[], bool]) -> dict[str, Floats]:
    """The bounds (k,) of the greatest usage in plans with 1, 2, ..., k routes that are not by their total cost."""
    routes = min(usable.shape[1], int(usable.any(axis=1).sum()))
    return {
        _WEIGHED: np.broadcast_to(weighed_shares(problem, usable, due), routes),
        _FAR: np.broadcast_to(far_shares(problem, usable, due), routes),
    }


def _by_tasks_alone(problem: Problem, least: Floats, members: Sequence[int]) -> Bound:
    """Bound `total`, `max` and `total+max` by the task that takes most, for each robot that it needs at least."""
    greatest = float(_of_each(problem, kth_least(least, members)).max())
    totals = np.array([np.sort(column)[:k].sum() for column, k in zip(least.T, members, strict=True)])
    total = float(_of_each(problem, totals).max())
    return Bound({"total": total, "max": greatest, "total+max": total + greatest}[problem.objective], (_FARTHEST,))


def _evened(totals: Floats, capacity: Floats) -> Floats:
    """(k,) the least U for which the first k capacities (descending), cut down to U, sum up to totals[k]; inf if none.

    Of k robots the q with the least capacity take at most that, so that the others take (total - theirs) / (k - q):
    the maximum over q is U.
    """
    if np.isinf(capacity).all():
        return totals / np.arange(1, len(totals) + 1)
    evened = []
    for k, total in enumerate(totals.tolist(), 1):
        held = np.concatenate(([0.0], np.cumsum(capacity[:k][::-1])))
        if math.isinf(total) or total > held[k] * (1 + ROUNDING):
            evened.append(math.inf)
        else:
            shares = (total - held[:k]) / (k - np.arange(k))
            evened.append(float(shares.max()))
    return np.array(evened)


def _average(problem: Problem, usable: Bools, due: Callable[[], bool]) -> Bound:
    """Bound the mean usage on arrival.

    Theorem. (1) A robot arrives at a task with no less than the least way there, over all ways. (2) Let e_j be the
    least that arriving at j adds to what its robot had on arrival at the task before, or at its start: the leg into
    j, and the work of the task before. The sum of arrivals is at least that of e_j times the number of tasks from j to
    the end of its route; no more than m tasks have the same number. So it is at least the sum of the e in descending
    order times 1 (m of them), 2 (m of them), and so on, by the rearrangement inequality: the rule of the shortest
    processing time first on parallel machines [conway1967]. A team arrives with the last of its k robots: in (1) no
    earlier than the k-th least, in (2) no earlier than any one of them, whose route may go through more tasks. (3)
    Without teams, see `least_arrivals` and `least_arrivals_on_paths`.
    """
    n, m = problem.model.most_done, int(usable.any(axis=1).sum())
    open_ended = opened(problem)
    work = np.array([problem.work_usage(i) for i in range(len(problem.robots))])
    arrivals = np.where(usable, least_usages(open_ended) - work, math.inf)
    members = [problem.model.least_members(j) for j in range(len(problem.tasks))]
    alone = float(_of_each(problem, kth_least(arrivals, members)).mean())
    ways = Ways.of(open_ended, usable, with_surplus=False)
    steps = np.sort(_of_each(problem, ways.entering(after_work=True)))[::-1]
    in_turn = float((steps * (np.arange(n) // m + 1)).sum()) / n
    named = {_LEAST_WAYS: alone, _IN_TURN: in_turn}
    if not problem.model.with_teams and not problem.model.alternatives:
        named[_FORESTS] = least_arrivals(ways, m, due) / n
        named[_PATHS] = least_arrivals_on_paths(open_ended, usable, n * max(named.values()), due) / n
    best = max(named, key=lambda name: named[name])
    return Bound(named[best], (best,))


def _makespan(problem: Problem, usable: Bools, due: Callable[[], bool]) -> Bound:
    """Bound the time at which the last task ends.

    Theorem. (1) Critical path: no task begins earlier than `EarliestTimes` tells, by its robots, its prerequisites and
    its openings. (2) The robots of k routes are on their way or at work for no longer than from when they are available
    to the last end: k times that is at least the least total time of k routes, the tasks of teams counted for each
    member, plus the k least times of availability. The bound is the least over k, and at least (1). Routes are open,
    unless the way to the robots' ends counts. (3) The last end is not before what `weighed_shares` and `far_shares`
    tell.
    """
    timed, earliest = in_time(problem), EarliestTimes.of(problem, usable)
    with_return = problem.mission.rules.makespan_includes_return
    critical = float(_of_each(problem, earliest.homes if with_return else earliest.ends).max())
    copied = with_copies(timed if with_return else opened(timed), usable)
    if copied is None or math.isinf(critical):
        return Bound(critical, (_CRITICAL,))
    available = np.array([robot.available_from_s for robot in problem.robots])
    waits = np.cumsum(np.sort(available[usable.any(axis=1)]))

    shares = _shares(copied.problem, copied.usable, due)

    def evened(totals: Floats) -> Floats:
        routes = len(totals)
        return np.asarray((totals + waits[:routes]) / np.arange(1, routes + 1))

    def worth(totals: Floats) -> Floats:
        return np.asarray(np.max([evened(totals), *shares.values(), np.full(len(totals), critical)], axis=0))

    totals = route_bounds(Ways.of(copied.problem, copied.usable), worth, due)
    values = worth(totals)
    k = int(values.argmin())
    named = {
        _CRITICAL: critical,
        _SHARE: float(evened(totals)[k]),
        **{name: float(bounds[k]) for name, bounds in shares.items()},
    }
    return Bound(float(values[k]), (max(named, key=lambda name: named[name]),))


def _lateness(problem: Problem, usable: Bools) -> Bound:
    """Bound the weighted sum of what tasks end after they are due: none ends earlier than `EarliestTimes` tells."""
    ends = EarliestTimes.of(problem, usable).ends
    done = np.isfinite(ends)
    priority = np.array([task.priority for task in problem.tasks])
    late = priority * np.maximum(0.0, np.where(done, ends, 0.0) - problem.model.due)
    return Bound(float(_of_each(problem, np.where(done, late, math.inf)).sum()), (_CRITICAL,))
