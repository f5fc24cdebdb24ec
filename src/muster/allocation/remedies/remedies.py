"""Remedies: the least changes with which a robot can do a task in addition to all tasks of a plan."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Sequence
from dataclasses import replace

from muster import core
from muster.allocation.allocator import Routes
from muster.allocation.bounds.feasibility import impossible
from muster.allocation.bounds.usage_bounds import FEW, UsageBounds
from muster.allocation.remedies.changed_problem import changed
from muster.allocation.remedies.remedy import Before, Remedy, as_they_are
from muster.allocation.remedies.timed_remedies import timed_remedy
from muster.allocation.search.witness_plans import Judge, attempt, bare_plan
from muster.model.problem import Problem
from muster.model.rules.rule import ROUNDING

_NARROWINGS = 6  # of what is known of the least capacity: each halves what is not known
_MOST_SEARCHED = 6  # robots, those that need least with the rest of the plan as it is, for which plans are searched
_NEAR_ENOUGH = 1e-3  # relative


def remedies(
    problem: Problem, routes: Routes, j: int, judge: Judge, due: Callable[[], bool] = lambda: False
) -> tuple[Remedy, ...]:
    """For every robot, in mission order, the remedy with which it can do task j.

    From when `due` says so remedies are no longer searched for.
    """
    if problem.core.is_timed:
        order = [problem.robot_index[robot.id] for robot in problem.mission.robots]
        return tuple(timed_remedy(problem, routes, i, j, judge, due=due) for i in order)
    first = dict(_needs_as_is(problem, routes, j))
    able = [i for i, remedy in first.items() if not remedy.unable]
    searched = set(sorted(able, key=lambda i: first[i].size)[:_MOST_SEARCHED])
    found = {
        i: _not_found(replace(remedy, impossible=True))
        if remedy.unable
        else replace(_not_found(remedy), searched=False)
        if due()
        else _searched_for(problem, routes, i, j, remedy, judge)
        if i in searched
        else replace(_as_is(problem, routes, i, j, remedy, judge), searched=False)
        for i, remedy in first.items()
    }
    return tuple(found[problem.robot_index[robot.id]] for robot in problem.mission.robots)


def smallest_as_is(
    problem: Problem, routes: Routes, j: int, judge: Judge, due: Callable[[], bool] = lambda: False
) -> Remedy | None:
    """The smallest change for task j at any robot with the rest of the plan as it is; None if none was found.

    From when `due` says so it is not looked for any more.
    Where prerequisites are left out they would have to be done first: such a change is never said to be enough.
    """
    if problem.core.is_timed:
        robots = range(len(problem.robots))
        return smallest([timed_remedy(problem, routes, i, j, judge, searched=False, due=due) for i in robots])
    first = dict(_needs_as_is(problem, routes, j))
    order = sorted((i for i, remedy in first.items() if not remedy.unable), key=lambda i: first[i].size)
    if order and first[order[0]].before:
        return first[order[0]]
    for i in order:
        if due():
            break
        if first[i].capacity.as_is is not None:
            remedy = _as_is(problem, routes, i, j, first[i], judge)
            if remedy.enough:
                return remedy
    return None


def smallest(found: Sequence[Remedy]) -> Remedy | None:
    """The smallest of the changes that are enough, the first if several are."""
    return min((remedy for remedy in found if remedy.enough), key=lambda remedy: remedy.size, default=None)


# --- what stands between a robot and a task --------------------------------------------------------------------------


def _needs_as_is(problem: Problem, routes: Routes, j: int) -> Iterator[tuple[int, Remedy]]:
    """For each robot the changes that it needs, and the capacity with which its route has room; not judged yet."""
    inspection = core.Inspection(problem.core, _without(routes, j))
    for i, first in enumerate(as_they_are(problem, routes, j, range(len(problem.robots)))):
        place = None if first.before else _cheapest_place(inspection, i, j)
        room = None if place is None else problem.capacity_for(place[1])
        now = first.capacity.now
        enough = room if room is None or now is None else max(room, now)
        yield i, replace(first, capacity=replace(first.capacity, as_is=room, enough=enough))


def _cheapest_place(inspection: core.Inspection, i: int, j: int) -> tuple[int, float] | None:
    """Where in the route of robot i task j adds least usage and nothing deadlocks, and the usage; None if nowhere."""
    place = inspection.cheapest_insertion(i, j)
    return None if place is None or math.isinf(place.usage) else (place.at, place.usage)


def _put(rest: Routes, i: int, j: int, at: int) -> Routes:
    """Routes with task j at a place of the route of robot i."""
    return [[*route[:at], j, *route[at:]] if k == i else list(route) for k, route in enumerate(rest)]


def _without(routes: Routes, j: int) -> Routes:
    return [[k for k in route if k != j] for route in routes]


# --- what is enough, and what is needed ------------------------------------------------------------------------------


def _as_is(problem: Problem, routes: Routes, i: int, j: int, remedy: Remedy, judge: Judge) -> Remedy:
    """The remedy with which the task fits into the robot's route, the rest of the plan as it is."""
    if remedy.capacity.as_is is None:
        return _not_found(remedy)
    return _fitted(changed(problem, remedy, i, j), _without(routes, j), i, j, remedy, judge)


def _fitted(problem: Problem, rest: Routes, i: int, j: int, remedy: Remedy, judge: Judge) -> Remedy:
    """The remedy, enough if the judge admits the plan with the task in the robot's route, of the changed problem."""
    place = _cheapest_place(core.Inspection(problem.core, rest), i, j)
    return _not_found(remedy) if place is None else _judged(problem, _put(rest, i, j, place[0]), remedy, judge)


def _judged(problem: Problem, routes: Routes, remedy: Remedy, judge: Judge) -> Remedy:
    plan = bare_plan(problem, routes)
    if judge(problem.mission, plan, problem.ignored):
        return replace(remedy, enough=True, routes=plan.routes)
    return _not_found(remedy)


def _not_found(remedy: Remedy) -> Remedy:
    return replace(remedy, capacity=replace(remedy.capacity, enough=None))


def _searched_for(problem: Problem, routes: Routes, i: int, j: int, remedy: Remedy, judge: Judge) -> Remedy:
    """The remedy with the capacity that is enough, and the one that is needed at least."""
    rest = _without(routes, j)
    now, as_is = remedy.capacity.now, remedy.capacity.as_is
    remedy = replace(remedy, capacity=replace(remedy.capacity, enough=now))
    base = changed(problem, remedy, i, j)
    if remedy.before:
        never = {item.task for item in impossible(base)}
        remedy = replace(remedy, before=tuple(Before(name.task, name.task not in never) for name in remedy.before))
    only = base.tasks[j].only_for(remedy.robot)
    sole = replace(base, tasks=tuple(only if k == j else task for k, task in enumerate(base.tasks)))
    bounds = UsageBounds(sole.with_capacities({i: None}))
    if not bounds.possible[i, j]:
        return _not_found(replace(remedy, unreachable=True, impossible=True))
    if as_is is not None and (now is None or as_is <= now * (1 + ROUNDING)):
        fitted = _fitted(base, rest, i, j, remedy, judge)
        if fitted.enough:
            return fitted
    needed = problem.closed([j, *(k for route in rest for k in route)])
    least = problem.capacity_for(least_beside(bounds, i, j, needed))
    if math.isinf(least):
        return _not_found(replace(remedy, impossible=True))
    remedy = replace(remedy, capacity=replace(remedy.capacity, at_least=None if now is None else least))
    found = _narrowed(sole, rest, needed, i, j, remedy)
    if found is None:
        return _not_found(remedy)
    if now is not None:
        used = problem.capacity_for(core.Inspection(sole.core, found).usages[i])
        remedy = replace(remedy, capacity=replace(remedy.capacity, enough=max(used, now)))
    return _judged(changed(problem, remedy, i, j), found, remedy, judge)


def _narrowed(sole: Problem, rest: Routes, needed: list[int], i: int, j: int, remedy: Remedy) -> Routes | None:
    """Routes with all needed tasks, j by robot i, with the least usage of robot i that was found."""
    now, low = remedy.capacity.now, remedy.capacity.at_least or 0.0
    if now is None or low <= now * (1 + ROUNDING):
        first = _rearranged(sole, rest, needed, i, now) or _rearranged(sole, None, needed, i, now)
        if first is not None or now is None:
            return first
    best = _with_task(sole, rest, i, j) or _rearranged(sole, rest, needed, i, None)
    if best is None:
        return None
    low = tried = max(low, now)
    for _ in range(_NARROWINGS):
        used = sole.capacity_for(core.Inspection(sole.core, best).usages[i])
        if used - low <= _NEAR_ENOUGH * used:
            break
        found = _rearranged(sole, rest, needed, i, tried)
        if found is None:
            low = tried
        else:
            best, used = found, sole.capacity_for(core.Inspection(sole.core, found).usages[i])
        tried = (low + used) / 2
    return best


def _with_task(sole: Problem, rest: Routes, i: int, j: int) -> Routes | None:
    """The routes with task j in that of robot i, if they are admissible with unlimited capacity of the robot."""
    problem = sole.with_capacities({i: None})
    place = _cheapest_place(core.Inspection(problem.core, rest), i, j)
    routes = None if place is None else _put(rest, i, j, place[0])
    return routes if routes is not None and _admissible(problem, routes) else None


def _rearranged(sole: Problem, rest: Routes | None, needed: list[int], i: int, capacity: float | None) -> Routes | None:
    """Routes with all needed tasks with this work capacity of robot i, if a short search finds some.

    The search begins with the rest of the plan, if that is given and admissible.
    """
    problem = sole.with_capacities({i: capacity})
    start = rest if rest is not None and _admissible(problem, rest) else None
    routes = attempt(problem, needed, start=start)
    return routes if not set(needed).difference(*routes) else None


def _admissible(problem: Problem, routes: Routes) -> bool:
    allowed = all(problem.allowed[i, j] for i, route in enumerate(routes) for j in route)
    return allowed and core.Inspection(problem.core, routes).admissible


def least_beside(bounds: UsageBounds, i: int, j: int, tasks: Sequence[int]) -> float:
    """A lower bound of the usage of robot i, of unlimited capacity, in a plan of all the tasks; only it may do j."""
    problem = bounds.problem
    others = [k for k in range(len(problem.robots)) if k != i]
    few, reached = list(tasks), [0]
    if len(few) <= FEW:
        reached = bounds.shares(others, few)
    else:
        own = [k for k in tasks if k != j and not bounds.possible[others, k].any()]
        few = [j, *sorted(own, key=lambda k: -bounds.least[i, k])[: FEW - 1]]
    usages, bit = bounds.subset_usages(i, few), 1 << few.index(j)
    least = min(float(usages[(len(usages) - 1) & ~share | bit]) for share in reached)
    spare = float(problem.capacity[others].sum()) * (1 + ROUNDING)
    if math.isfinite(spare):
        least = max(least, bounds.least_together(range(len(problem.robots)), tasks) * (1 - ROUNDING) - spare)
    return max(least, float(bounds.least[i, j]))
