"""Remedies where times, teams and relations matter: the changes of all rules that stand in the way of a plan.

What stands between a robot and a task is lifted first; the place that needs least of it is then what the remedy gives,
no more: the mission so changed has an admissible plan with the task, which was found, and judged.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import replace

from muster import core
from muster.allocation.allocator import Routes
from muster.allocation.bounds.feasibility import limits_of
from muster.allocation.reasons.timed_places import Place, TimedPlaces
from muster.allocation.remedies.changed_problem import changed
from muster.allocation.remedies.remedy import Remedy, as_they_are, more_calls
from muster.allocation.search.witness_plans import Judge, attempt, bare_plan
from muster.model.problem import Problem
from muster.model.rules import Change
from muster.model.rules.rule import Found, Times, route_over, stop_of


def timed_remedy(
    problem: Problem,
    routes: Routes,
    i: int,
    j: int,
    judge: Judge,
    *,
    searched: bool = True,
    due: Callable[[], bool] = lambda: False,
) -> Remedy:
    """The remedy with which robot i can do task j: beside the rest of the plan as it is, else in another plan."""
    first = next(as_they_are(problem, routes, j, [i]))
    if first.unable:
        return replace(first, impossible=True)
    moved = problem.with_partner(j)
    rest = [[k for k in route if k not in moved] for route in routes]
    for wider in _wider(problem, first, rest, i, j):
        if due():
            return replace(first, searched=False)
        found = _lifted_and_tried(problem, rest, i, j, wider, judge, searched=False)
        if found is None and searched:
            found = _lifted_and_tried(problem, rest, i, j, wider, judge, searched=True)
        if found is not None:
            return found
    return replace(first, searched=searched)


def _wider(problem: Problem, first: Remedy, rest: Routes, i: int, j: int) -> Iterator[Remedy]:
    """The remedy as it is; then without one rule that binds the robot, then without one that ties it to others."""
    yield first
    base = changed(problem, first, i, j)
    done = {k for route in rest for k in route}
    for rule in sorted(base.rules, key=lambda rule: not rule.about_one):
        change = rule.lifted(base, i, j, done)
        if change is not None:
            yield replace(first, changes={**first.changes, rule.word: change})


# --- what is lifted, and how much of it is needed --------------------------------------------------------------------


def _lifted_and_tried(
    problem: Problem, rest: Routes, i: int, j: int, remedy: Remedy, judge: Judge, *, searched: bool
) -> Remedy | None:
    """The remedy with the times and the capacity that it needs; None: no plan was found."""
    unlimited = {rule.word: rule.unlimited(problem, i, j) for rule in problem.rules}
    limits = {word: change for word, change in unlimited.items() if change is not None}
    lifted = replace(remedy, changes={**remedy.changes, **limits})
    opened = changed(problem, lifted, i, j)
    at, of = opened.robot_index[remedy.robot], opened.task_index[problem.tasks[j].id]
    opened = opened.with_capacities({at: None})
    routes = _as_named(problem, opened, rest)
    found = _searched(opened, routes, at, of) if searched else _placed(problem, opened, routes, i, limits, at, of)
    if found is None:
        return None
    needed = _needed(problem, opened, found, at, of, lifted, as_is=not searched)
    target = changed(problem, needed, i, j)
    target_routes = _as_named(opened, target, found)
    plan = bare_plan(target, target_routes)
    if not judge(target.mission, plan, target.ignored):
        return None
    calls = more_calls(problem, rest, plan, i)
    return replace(needed, enough=True, routes=plan.routes, calls=calls)


def _as_named(problem: Problem, other: Problem, routes: Sequence[Sequence[int]]) -> Routes:
    """Routes of one problem as those of another with the same tasks, and maybe more robots."""
    named: Routes = [[] for _ in other.robots]
    for robot, route in zip(problem.robots, routes, strict=True):
        named[other.robot_index[robot.id]] = [other.task_index[problem.tasks[k].id] for k in route]
    return named


def _placed(
    problem: Problem, opened: Problem, rest: Routes, i: int, limits: Mapping[str, Change], at: int, of: int
) -> Routes | None:
    """The place beside the rest of the plan that needs least."""
    plan = TimedPlaces(opened, rest)
    done = {k for route in rest for k in route}
    own = opened.with_partner(of)
    if not done.union(own).issuperset(before for k in own for before in opened.prerequisites[k]):
        return None
    tried = ((place, core.Inspection(opened.core, place.routes)) for place in plan.places(at, of))
    admissible = [(place, found) for place, found in tried if found.admissible]

    def lack(one: tuple[Place, core.Inspection]) -> tuple[int, float, float]:
        """What is needed beyond the limits of task and robot, kinds of change and seconds, then the robot's usage."""
        found = _found(opened, one[0].routes, one[1], at, of)
        needed = [change.seconds for limit in limits.values() if (change := limit.narrowed(found)) is not None]
        return len(needed) + (found.usage > problem.capacity[i]), sum(needed), found.usage

    best = min(admissible, key=lack, default=None)
    return None if best is None else best[0].routes


def _searched(opened: Problem, rest: Routes, at: int, of: int) -> Routes | None:
    """Routes with the task, done by the robot, and all tasks of the plan, if a short search finds some."""
    needed = opened.closed([of, *(k for route in rest for k in route)])
    routes = attempt(opened, needed)
    if set(needed).difference(*routes) or of not in routes[at]:
        return None
    return routes if core.Inspection(opened.core, routes).admissible else None


def _found(opened: Problem, routes: Routes, inspection: core.Inspection, at: int, of: int) -> Found:
    """What routes come to for the robot and the task."""
    route = routes[at]
    _, begin, end = stop_of(inspection, at, route.index(of))
    times = Times(begin, end, route_over(opened, inspection, at, route))
    return Found(opened, len(route), inspection.usages[at], times)


def _needed(
    problem: Problem, opened: Problem, routes: Routes, at: int, of: int, lifted: Remedy, *, as_is: bool
) -> Remedy:
    """The remedy with as much of its changes as routes need, and what is proven to be needed.

    `as_is` tells whether these are the routes of the plan as it is, with the task.
    """
    limits, inspection = limits_of(opened, timed=True), core.Inspection(opened.core, routes)
    begin, end = float(limits.pair_begin[at, of]), float(limits.pair_end[at, of])
    least = Times(begin, end, float(limits.over[at, of]))
    found = replace(_found(opened, routes, inspection, at, of), least=least)
    narrowed = {word: change.narrowed(found) for word, change in lifted.changes.items()}
    now = lifted.capacity.now
    used = problem.capacity_for(found.usage)
    enough = None if now is None else max(used, now)
    return replace(
        lifted,
        changes={word: change for word, change in narrowed.items() if change is not None},
        capacity=replace(lifted.capacity, as_is=used if as_is else None, enough=enough),
    )
