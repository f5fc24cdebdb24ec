"""Fixed beginnings of routes, for replanning: the tasks that robots have done, are doing, or must keep.

The fixed tasks are an admissible plan by themselves, so they can be done whatever is planned after them.
"""

from __future__ import annotations

import math
from collections import Counter
from collections.abc import Collection, Mapping, Sequence
from dataclasses import replace

from muster import core
from muster.allocation.allocator import Routes, admissible_routes
from muster.mission.model import Task
from muster.mission.plan import Plan
from muster.model.problem import Problem
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


def with_past(problem: Problem, past: Sequence[Sequence[int]]) -> Problem:
    """The same problem for plans whose routes begin with what robots have done or begun, be it admissible or not.

    Tasks done or begun have no prerequisites here, no times, and the robots that did them. The capacity of a robot that
    has used more than its capacity is what it has used, and its shift ends no earlier than all that was done. A robot
    whose past has a leg without a path is taken to be at its start; no task waits for its past.
    """
    free = _as_begun(problem, past)
    kept = replace(problem, tasks=free, fixed=tuple(map(tuple, past)), known=problem.measured)
    usages = core.Inspection(kept.core, [list(route) for route in past]).usages
    capacity = problem.capacity
    usable = 1.0 - problem.mission.rules.capacity_reserve
    robots = tuple(
        replace(robot, work_capacity=usage / usable) if math.isfinite(usage) and _too_much(usage, most) else robot
        for robot, usage, most in zip(problem.robots, usages, capacity, strict=True)
    )
    lost = {problem.tasks[j].id for route, usage in zip(past, usages, strict=True) if math.isinf(usage) for j in route}
    if robots == problem.robots and not lost:
        return _within_shifts(kept)
    bearable = replace(
        kept,
        robots=robots,
        tasks=tuple(t.waiting_for(p for p in t.prerequisites if p not in lost) for t in free),
        fixed=tuple(() if math.isinf(usage) else tuple(route) for route, usage in zip(past, usages, strict=True)),
    )
    return _within_shifts(bearable)


def _as_begun(problem: Problem, past: Sequence[Sequence[int]]) -> tuple[Task, ...]:
    """The tasks; those done or begun without what said when they begin, and who does them."""
    robots = Counter(j for route in past for j in set(route))
    names = {problem.tasks[j].id for j in robots}

    def freed(j: int, task: Task) -> Task:
        if j not in robots:
            return replace(task, starts_with=tuple(name for name in task.starts_with if name not in names))
        return replace(
            task.waiting_for(()),
            window_s=(),
            deadline_s=None,
            robots_needed=robots[j] if task.is_for_team else task.robots_needed,
            team=(),
            needs=None,
            same_robot_as=tuple(name for name in task.same_robot_as if name not in names),
            other_robot_than=tuple(name for name in task.other_robot_than if name not in names),
            starts_with=(),
        )

    return tuple(freed(j, task) for j, task in enumerate(problem.tasks))


def _within_shifts(problem: Problem) -> Problem:
    """The problem with shifts that end no earlier than the fixed tasks, if these end too late for some."""
    limited = problem.holds("shift") and any(robot.available_until_s is not None for robot in problem.robots)
    fixed = [list(route) for route in problem.fixed]
    if not limited or core.Inspection(problem.core, fixed).admissible:
        return problem
    rules = replace(problem.mission.rules, objective="makespan", makespan_includes_return=True)
    robots = tuple(replace(robot, available_until_s=None) for robot in problem.robots)
    endless = replace(problem, mission=replace(problem.mission, rules=rules), robots=robots)
    end_s = core.Inspection(endless.core, fixed).makespan
    if end_s is None:
        return problem
    longer = tuple(
        robot
        if robot.available_until_s is None
        else replace(robot, available_until_s=max(robot.available_until_s, end_s))
        for robot in problem.robots
    )
    return replace(problem, robots=longer)


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
    kept = {j for i, route in enumerate(routes) for j in route[: len(problem.beginning(i))]}
    place = {j: k for route in routes for k, j in enumerate(route)}
    units = {tuple(sorted(_unit(problem, j) - kept)) for j in place.keys() - kept}
    pending = sorted(units, key=lambda unit: (max(place.get(j, 0) for j in unit), unit))
    while pending:
        ready = next((unit for unit in pending if _is_whole(problem, unit, place, kept)), None)
        if ready is None:
            break
        pending.remove(ready)
        more = kept.union(ready)
        if core.Inspection(problem.core, [[j for j in route if j in more] for route in routes]).admissible:
            kept = more
    return [[j for j in route if j in kept] for route in routes]


def _unit(problem: Problem, j: int) -> set[int]:
    """A task with all that begin with it, and with those that pick up or deliver the same goods."""
    unit, waiting = {j}, [j]
    while waiting:
        k = waiting.pop()
        new = {*problem.model.beginning_with(k), *problem.with_partner(k)} - unit
        unit |= new
        waiting += new
    return unit


def _is_whole(problem: Problem, unit: Sequence[int], place: Mapping[int, int], kept: Collection[int]) -> bool:
    """Whether all tasks of a unit are there, and what must be done before them is kept."""
    before = {other for j in unit for other in problem.prerequisites[j]}
    return all(j in place for j in unit) and before <= {*kept, *unit}


def _too_much(usage: float, capacity: float) -> bool:
    return math.isinf(usage) or usage > capacity * (1 + ROUNDING)
