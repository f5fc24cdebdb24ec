"""Fixed beginnings of routes, for replanning: the tasks that robots have done, are doing, or must keep.

The fixed tasks are an admissible plan by themselves, so they can be done whatever is planned after them.
"""

from __future__ import annotations

import math
from collections import Counter
from collections.abc import Collection, Iterable, Sequence
from dataclasses import dataclass, replace
from functools import reduce

from muster import core
from muster.allocation.allocator import Routes, admissible_routes
from muster.mission.model import Task
from muster.mission.plan import Plan
from muster.model.parts import Begun
from muster.model.problem import Problem
from muster.model.rules import all_rules
from muster.model.rules.rule import ROUNDING


def with_fixed_routes(problem: Problem, plan: Plan) -> Problem:
    """The same problem for plans whose routes begin with the routes of this one.

    Raises
    ------
    ParameterError
        if the plan is not admissible, or names robots or tasks that the problem does not have.
    """
    routes = admissible_routes(problem, plan, "fixed")
    return replace(problem, fixed=tuple(tuple(route) for route in routes))


def admissible_alone(problem: Problem, i: int, route: Sequence[int]) -> bool:
    """Whether a plan is admissible in which robot i does these tasks, and nobody else anything."""
    routes: Routes = [[] for _ in problem.robots]
    routes[i] = list(route)
    return bool(core.Inspection(problem.core, routes).admissible)


@dataclass(frozen=True)
class RoutesValue:
    """What routes come to: whether they are admissible, the weight that they complete, and their objective."""

    admissible: bool
    weight: float
    objective: float


def value_of(problem: Problem, routes: Routes) -> RoutesValue:
    """Return the value of routes, which may deadlock: they are not admissible then, and have no objective."""
    inspection = core.Inspection(problem.core, routes)
    admissible = inspection.admissible and inspection.objective is not None
    return RoutesValue(admissible, problem.weight(routes), inspection.objective or 0.0)


def with_past(problem: Problem, past: Sequence[Sequence[int]]) -> Problem:
    """The same problem for plans whose routes begin with what robots have done or begun, be it admissible or not.

    Of tasks done or begun nothing holds here but who did them, see `Rule.begun`. The capacity of a robot that has used
    more than its capacity is what it has used, and it can be at work until all that was done is over. A robot
    whose past has a leg without a path is taken to be at its start; no task waits for its past.
    """
    free = _as_begun(problem, past)
    kept = replace(problem, tasks=free, fixed=tuple(map(tuple, past)), known=problem.measured)
    usages = core.Inspection(kept.core, [list(route) for route in past]).usages
    above = [i for i, most in enumerate(problem.capacity) if math.isfinite(usages[i]) and _too_much(usages[i], most)]
    lost = {problem.tasks[j].id for route, usage in zip(past, usages, strict=True) if math.isinf(usage) for j in route}
    if not above and not lost:
        return _outlasting(kept)
    bearable = replace(
        kept.with_capacities({i: problem.capacity_for(usages[i]) for i in above}),
        tasks=tuple(t.waiting_for(p for p in t.prerequisites if p not in lost) for t in free),
        fixed=tuple(() if math.isinf(usage) else tuple(route) for route, usage in zip(past, usages, strict=True)),
    )
    return _outlasting(bearable)


def _as_begun(problem: Problem, past: Sequence[Sequence[int]]) -> tuple[Task, ...]:
    """The tasks; those done or begun without what said when they begin, and who does them."""
    begun = Counter(problem.tasks[j].id for route in past for j in set(route))
    return tuple(reduce(lambda free, rule: rule.begun(free, begun), all_rules(), task) for task in problem.tasks)


def _outlasting(problem: Problem) -> Problem:
    """The problem with robots that can be at work until the fixed tasks are over, if these are so too late for some."""
    fixed = [list(route) for route in problem.fixed]
    if not problem.model.parts.over_by or core.Inspection(problem.core, fixed).admissible:
        return problem
    rules = replace(problem.mission.rules, objective="makespan", makespan_includes_return=True)
    endless = _at_work(replace(problem, mission=replace(problem.mission, rules=rules)), math.inf)
    end_s = core.Inspection(endless.core, fixed).makespan
    if end_s is None:
        return problem
    return _at_work(problem, end_s)


def _at_work(problem: Problem, end_s: float) -> Problem:
    """The problem with robots that can be at work until a time; inf: however long."""
    begun = problem.begun or (Begun(),) * len(problem.robots)
    return replace(problem, begun=tuple(replace(one, over_s=end_s) for one in begun))


def admissible_part(problem: Problem, routes: Routes) -> Routes:
    """The admissible part of routes that begin with the fixed tasks of their robots.

    Removed are tasks that their robot may not do, tasks with a prerequisite that is missing, and tasks at the end of a
    route above its capacity. If routes deadlock, only the fixed tasks are left. With rules about time, teams or
    relations tasks are removed with which there is no schedule, those of a unit (`_unit`) all at once.
    """
    if problem.has_timed_rules:
        return _timed_part(problem, routes)
    least = [len(problem.beginning(i)) for i in range(len(problem.robots))]
    part = [[j for k, j in enumerate(route) if k < least[i] or problem.may(i, j)] for i, route in enumerate(routes)]
    while True:
        there = {j for route in part for j in route}
        part = [[j for j in route if there.issuperset(problem.prerequisites[j])] for route in part]
        inspection = core.Inspection(problem.core, part)
        if inspection.admissible:
            return part
        shortened = [
            route[:-1] if _too_much(usage, problem.capacity[i]) and len(route) > least[i] else route
            for i, (route, usage) in enumerate(zip(part, inspection.usages, strict=True))
        ]
        if shortened == part and there == {j for route in part for j in route}:
            return [list(problem.beginning(i)) for i in range(len(problem.robots))]
        part = shortened


def _timed_part(problem: Problem, routes: Routes) -> Routes:
    """The part of routes that has a schedule: unit after unit is kept that fits with those before it."""
    if _is_untied(problem) and core.Inspection(problem.core, routes).admissible:
        return [list(route) for route in routes]
    kept = {j for i, route in enumerate(routes) for j in route[: len(problem.beginning(i))]}
    place = dict(sorted((j, k) for route in routes for k, j in enumerate(route)))  # the last of a team's places
    units = {tuple(sorted(_unit(problem, j) - kept)) for j in place.keys() - kept}
    pending = sorted(units, key=lambda unit: (max(place.get(j, 0) for j in unit), unit))
    kept = _fitting(problem, routes, kept, _whole(problem, pending, place, kept))
    return [[j for j in route if j in kept] for route in routes]


def _is_untied(problem: Problem) -> bool:
    """Whether each task is a unit of its own that waits for no other."""
    model = problem.model
    return len(model.units) == model.tasks and not any(model.awaited) and not model.parts.taken_on_by


def _fitting(problem: Problem, routes: Routes, kept: set[int], units: Sequence[Sequence[int]]) -> set[int]:
    """The tasks kept, with those of units that fit: tried all at once, and in halves where these do not fit.

    Where all fit, or all but a few, that takes few inspections of the routes, however many units there are.
    """
    whole = _whole(problem, units, (), kept)
    more = kept.union(*whole)
    if not whole or core.Inspection(problem.core, [[j for j in route if j in more] for route in routes]).admissible:
        return more
    if len(whole) == 1:
        return kept
    half = len(whole) // 2
    return _fitting(problem, routes, _fitting(problem, routes, kept, whole[:half]), whole[half:])


def _whole(
    problem: Problem, units: Iterable[Sequence[int]], there: Collection[int], kept: Collection[int]
) -> list[Sequence[int]]:
    """The units of which all tasks are there, if any are given, each after those that must be done before it."""
    found, waiting, sure = [], [], set(kept)
    for unit in units:
        waiting.append(unit)
        while (ready := next((one for one in waiting if _is_ready(problem, one, sure)), None)) is not None:
            waiting.remove(ready)
            if not there or all(j in there for j in ready):
                found.append(ready)
                sure.update(ready)
    return found


def _unit(problem: Problem, j: int) -> set[int]:
    """A task with all that begin with it, and with those that pick up or deliver the same goods."""
    unit, waiting = {j}, [j]
    while waiting:
        k = waiting.pop()
        new = {*problem.model.beginning_with(k), *problem.with_partner(k)} - unit
        unit |= new
        waiting += new
    return unit


def _is_ready(problem: Problem, unit: Sequence[int], kept: Collection[int]) -> bool:
    """Whether what must be done before a unit is kept, or of the unit itself."""
    return all(before in kept or before in unit for j in unit for before in problem.prerequisites[j])


def _too_much(usage: float, capacity: float) -> bool:
    return math.isinf(usage) or usage > capacity * (1 + ROUNDING)
