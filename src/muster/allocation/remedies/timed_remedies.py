"""Remedies where times, teams and relations matter: longer windows, later deadlines and shifts, more robots.

What stands between a robot and a task is lifted first; the place that needs least of it is then what the remedy gives,
no more: the mission so changed has an admissible plan with the task, which was found, and judged.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Sequence
from dataclasses import replace

from muster import core
from muster.allocation.allocator import Routes
from muster.allocation.bounds.feasibility import impossible, limits_of
from muster.allocation.reasons.timed_places import TimedPlaces
from muster.allocation.reasons.timed_teams import stop_of
from muster.allocation.remedies.changed_problem import changed, pair_changes, with_capacity
from muster.allocation.remedies.remedy import Before, Remedy, more_calls
from muster.allocation.search.witness_plans import Judge, attempt, bare_plan
from muster.model.problem import Problem
from muster.model.rules import Change, all_rules
from muster.model.rules.battery import LargerBattery
from muster.model.rules.capacity import CapacityChange
from muster.model.rules.deadline import LaterDeadline
from muster.model.rules.relation import Untied
from muster.model.rules.rule import ROUNDING
from muster.model.rules.shift import LongerShift
from muster.model.rules.team import missing_robots
from muster.model.rules.times import moments
from muster.model.rules.window import LongerWindow

_RELATIONS = ("same_robot_as", "other_robot_than", "starts_with")


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
    first = _first(problem, routes, i, j)
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


def _first(problem: Problem, routes: Routes, i: int, j: int) -> Remedy:
    """What stands between the robot and the task by themselves, and the prerequisites that are left out."""
    robot, done = problem.robots[i], {k for route in routes for k in route}
    own = problem.with_partner(j)
    awaited = problem.closed([before for k in own for before in problem.prerequisites[k]])
    missing = [k for k in awaited if k not in done and k not in own]
    never = {item.task for item in impossible(problem)} if missing else set()
    now = None if math.isinf(problem.capacity[i]) else robot.work_capacity
    return Remedy(
        robot=robot.id,
        changes=pair_changes(problem, robot, problem.tasks[j]),
        before=tuple(Before(problem.tasks[k].id, problem.tasks[k].id not in never) for k in missing),
        unable=problem.action_refusal(i, j) or "",
        capacity=CapacityChange(now=now),
    )


def _wider(problem: Problem, first: Remedy, rest: Routes, i: int, j: int) -> Iterator[Remedy]:
    """The remedy as it is; without a rule that binds the robot; with robots that a team lacks; free of relations."""
    task, robot = problem.tasks[j], problem.robots[i]
    yield first
    for rule in all_rules():
        change = rule.lifted(problem, i) if problem.holds(rule.word) else None
        if change is not None:
            yield _with(first, rule.word, change)
    names = {*problem.robot_index, *problem.task_index}
    base = changed(problem, first, i, j)
    more = missing_robots(base, base.robot_index[robot.id], base.task_index[task.id], names)
    if more is not None:
        yield _with(first, "team", more)
    untied = _untied(problem, rest, j)
    if untied is not None:
        yield _with(first, "relation", untied)


def _with(remedy: Remedy, word: str, change: Change) -> Remedy:
    return replace(remedy, changes={**remedy.changes, word: change})


def _untied(problem: Problem, rest: Routes, j: int) -> Untied | None:
    """The relations of a task to tasks of the plan, or to tasks that begin with it; None: it has none."""
    task, rules = problem.tasks[j], problem.model
    done = {k for route in rest for k in route} | set(rules.beginning_with(j))
    names = {problem.tasks[k].id for k in done}
    found = [(key, name) for key in _RELATIONS for name in getattr(task, key) if name in names]
    found += [
        (key, other.id)
        for other in problem.mission.tasks
        for key in _RELATIONS
        if other.id in names and task.id in getattr(other, key)
    ]
    return Untied(tuple(dict.fromkeys(found))) if found and problem.holds("relation") else None


# --- what is lifted, and how much of it is needed --------------------------------------------------------------------


def _lifted_and_tried(
    problem: Problem, rest: Routes, i: int, j: int, remedy: Remedy, judge: Judge, *, searched: bool
) -> Remedy | None:
    """The remedy with the times and the capacity that it needs; None: no plan was found."""
    lifted = replace(remedy, changes={**remedy.changes, **_without_limits(problem, i, j)})
    opened = changed(problem, lifted, i, j)
    at, of = opened.robot_index[remedy.robot], opened.task_index[problem.tasks[j].id]
    opened = with_capacity(opened, at, None)
    routes = _as_named(problem, opened, rest)
    found = _searched(opened, routes, at, of) if searched else _placed(problem, opened, routes, i, j, at, of)
    if found is None:
        return None
    needed = _needed(problem, opened, found, i, j, remedy, as_is=not searched)
    target = changed(problem, needed, i, j)
    target_routes = _as_named(opened, target, found)
    plan = bare_plan(target, target_routes)
    if not judge(target.mission, plan, target.ignored):
        return None
    calls = more_calls(problem, rest, plan, i)
    return replace(needed, enough=True, routes=plan.routes, calls=calls)


def _without_limits(problem: Problem, i: int, j: int) -> dict[str, Change]:
    """The window and the deadline of the task and the shift of the robot without ends, as far as they have one."""
    rules, found = problem.model, dict[str, Change]()
    if rules.openings[j] and math.isfinite(rules.openings[j][-1][1]):
        found["window"] = LongerWindow(rules.openings[j][-1][1], None)
    if math.isfinite(rules.ends_by[j]):
        found["deadline"] = LaterDeadline(float(rules.ends_by[j]), None)
    if math.isfinite(rules.over_by[i]):
        found["shift"] = LongerShift(float(rules.over_by[i]), None)
    return found


def _as_named(problem: Problem, other: Problem, routes: Sequence[Sequence[int]]) -> Routes:
    """Routes of one problem as those of another with the same tasks, and maybe more robots."""
    named: Routes = [[] for _ in other.robots]
    for robot, route in zip(problem.robots, routes, strict=True):
        named[other.robot_index[robot.id]] = [other.task_index[problem.tasks[k].id] for k in route]
    return named


def _placed(problem: Problem, opened: Problem, rest: Routes, i: int, j: int, at: int, of: int) -> Routes | None:
    """The place beside the rest of the plan that needs least."""
    plan = TimedPlaces(opened, rest)
    done = {k for route in rest for k in route}
    own = opened.with_partner(of)
    if not done.union(own).issuperset(before for k in own for before in opened.prerequisites[k]):
        return None
    tried = ((place, core.Inspection(opened.core, place.routes)) for place in plan.places(at, of))
    admissible = [(place, found) for place, found in tried if found.admissible]
    best = min(admissible, key=lambda one: _lack(problem, opened, one[0].routes, one[1], i, j, at, of), default=None)
    return None if best is None else best[0].routes


def _searched(opened: Problem, rest: Routes, at: int, of: int) -> Routes | None:
    """Routes with the task, done by the robot, and all tasks of the plan, if a short search finds some."""
    needed = opened.closed([of, *(k for route in rest for k in route)])
    routes = attempt(opened, needed)
    if set(needed).difference(*routes) or of not in routes[at]:
        return None
    return routes if core.Inspection(opened.core, routes).admissible else None


def _lack(
    problem: Problem, opened: Problem, routes: Routes, found: core.Inspection, i: int, j: int, at: int, of: int
) -> tuple[int, float, float]:
    """What a plan needs beyond the limits of task and robot, kinds of change and seconds, then its robot's usage."""
    begin, end, over = _times(opened, routes, found, at, of)
    rules = problem.model
    close = rules.openings[j][-1][1] if rules.openings[j] else math.inf
    beyond = [
        time - limit
        for time, limit in ((begin, close), (end, float(rules.ends_by[j])), (over, float(rules.over_by[i])))
        if time > limit * (1 + ROUNDING)
    ]
    used = found.usages[at]
    return len(beyond) + (used > problem.capacity[i]), sum(beyond), used


def _times(opened: Problem, routes: Routes, found: core.Inspection, at: int, of: int) -> tuple[float, float, float]:
    """When work on a task begins and ends, and when its robot's route does."""
    route = routes[at]
    _, begin, end = stop_of(found, at, route.index(of))
    over = stop_of(found, at, len(route) - 1)[2]
    if opened.robots[at].place_at_end(opened.mission.rules) is not None:
        over += float(opened.travel_seconds(at, [route[-1]], [opened.end(at)])[0, 0])
    return begin, end, over


def _needed(
    problem: Problem, opened: Problem, routes: Routes, i: int, j: int, remedy: Remedy, *, as_is: bool
) -> Remedy:
    """The remedy with the times and the capacity that routes need, and what is proven to be needed.

    `as_is` tells whether these are the routes of the plan as it is, with the task.
    """
    at, of = opened.robot_index[remedy.robot], opened.task_index[problem.tasks[j].id]
    inspection = core.Inspection(opened.core, routes)
    begin, end, over = _times(opened, routes, inspection, at, of)
    limits, rules = limits_of(opened, timed=True), problem.model
    narrowed = {word: change.narrowed(len(routes[at])) for word, change in remedy.changes.items()}
    if isinstance(battery := narrowed.get("battery"), LargerBattery):
        narrowed["battery"] = battery.for_usage(problem.robots[i], inspection.usages[at])
    changes = {word: change for word, change in narrowed.items() if change is not None}
    if rules.openings[j] and begin > rules.openings[j][-1][1] * (1 + ROUNDING):
        changes["window"] = LongerWindow(rules.openings[j][-1][1], begin, float(limits.pair_begin[at, of]))
    if end > rules.ends_by[j] * (1 + ROUNDING):
        changes["deadline"] = LaterDeadline(float(rules.ends_by[j]), end, float(limits.pair_end[at, of]))
    if over > rules.over_by[i] * (1 + ROUNDING):
        least = float(limits.pair_end[at, of] + limits.home[at, of])
        changes["shift"] = LongerShift(float(rules.over_by[i]), over, least, moments(problem, over)[0])
    now = remedy.capacity.now
    used = inspection.usages[at] / (1.0 - problem.mission.rules.capacity_reserve)
    enough = None if now is None else max(used, now)
    capacity = CapacityChange(now=now, as_is=used if as_is else None, enough=enough)
    return replace(remedy, changes=changes, capacity=capacity)
