"""Tasks that can never be done, whatever the plan, and why."""

from __future__ import annotations

import heapq
import itertools
import math
from collections.abc import Callable, Collection, Sequence
from typing import Any

import numpy as np

from muster.allocation.bounds.exclusions import Cause
from muster.allocation.bounds.limits import Limits, narrowed, untimed
from muster.mission.plan import Reason, Unassigned
from muster.model.plan_model import ROUNDING
from muster.model.problem import Bools, Floats, Indices, Problem
from muster.model.rules import Outlook

Legs = Callable[[int, Any, Any], Floats]

_MOST_WAYS = 5_000_000  # robots times tasks squared, up to which ways through short cuts are looked at


def impossible(problem: Problem) -> tuple[Unassigned, ...]:
    """Tasks that no robot can do in any admissible plan, in mission order, each with a reason for every robot.

    These are the tasks that no robot may do, those out of every robot's reach or too late for it by themselves, those
    without a team, and those whose prerequisites, or tasks that begin with them, are impossible. There can be others,
    such as a chain of prerequisites too long for the robots.
    """
    limits = _limits(problem)
    lost = _lost_tasks(problem, limits)
    robots = [problem.robot_index[robot.id] for robot in problem.mission.robots]
    order = [problem.task_index[task.id] for task in problem.mission.tasks]

    def lost_before(j: int) -> str:
        """The first lost task that must be done before it, or begins with it."""
        named = (*problem.prerequisites[j], *problem.model.beginning_with(j))
        return next((problem.tasks[k].id for k in named if k in lost), "")

    def reasons(j: int) -> tuple[Reason, ...]:
        befores = (lost[j], lost_before(j))  # a bound may have held only until what comes before it was lost
        return tuple(_reason(problem, limits, i, j, befores) for i in robots)

    return tuple(Unassigned(problem.tasks[j].id, reasons(j)) for j in order if j in lost)


def lost_tasks(problem: Problem) -> Collection[int]:
    """Tasks that no robot can do, as far as limits tell, and those that wait for them."""
    return _lost_tasks(problem, _limits(problem)).keys()


def _limits(problem: Problem) -> Limits:
    return limits_of(problem) if problem.has_timed_rules else untimed(problem)


def _lost_tasks(problem: Problem, limits: Limits) -> dict[int, str]:
    """Each lost task with the lost one that it waits for, or ""."""
    alone = ~limits.usable.any(axis=0) if problem.has_timed_rules else _out_of_reach(problem)
    lost = dict.fromkeys(np.flatnonzero(alone).tolist(), "")
    waiting = list(lost)
    while waiting:
        before = waiting.pop()
        for j in (*problem.dependants[before], *problem.model.beginning_with(before)):
            if j not in lost:
                lost[j] = problem.tasks[before].id
                waiting.append(j)
    return lost


def _out_of_reach(problem: Problem) -> Bools:
    """(n,) the tasks that no robot can do, where nothing is timed.

    The robots are tried one by one, on the tasks that none before them can do: a table of all pairs would not fit into
    memory for a city, and the first robots leave few tasks to the others.
    """
    out = np.ones(len(problem.tasks), dtype=np.bool_)
    capacity = problem.capacity * (1 + ROUNDING)
    for i in np.argsort(-problem.capacity, kind="stable").tolist():
        left = np.flatnonzero(out & problem.allowed_by_kind[problem.kinds[i]])
        least = _least_usage_with(problem, i, left)
        out[left] = ~(np.isfinite(least) & (least <= capacity[i]))
        if not out.any():
            break
    return out


def _least_usage_with(problem: Problem, i: int, tasks: Sequence[int] | Indices) -> Floats:
    """The least usage of any route of robot i that holds a task, for each of some tasks; inf where there is none."""
    if len(problem.shortcuts()):
        return np.asarray(least_usage(problem, i)[tasks])
    there = np.asarray(problem.legs(i, [problem.start(i)], tasks)[0] + problem.work_usage(i)[tasks])
    if problem.robots[i].place_at_end(problem.mission.rules) is None:
        return there
    return np.asarray(there + problem.legs(i, tasks, [problem.end(i)])[:, 0])


def _reason(problem: Problem, limits: Limits, i: int, j: int, befores: Sequence[str]) -> Reason:
    """Why robot i can never do task j, which nobody can: what refuses or excluded the pair, else what comes before it.

    Where the rule that excluded it has no words for that it is named alone.
    """
    robot = problem.robots[i].id
    if (refused := problem.refusal(i, j)) is not None:
        return Reason(robot, *refused)
    least = float(limits.usage[i, j] if limits.is_timed else _least_usage_with(problem, i, [j])[0])
    if (cause := limits.exclusions.cause(i, j)) is not None:
        return _excluded(problem, cause, i, j, least, befores)
    for before, rule in itertools.product(befores, problem.rules):
        if (detail := rule.never(problem, i, j, Outlook(limits, least, before))) is not None:
            return Reason(robot, rule.word, detail)
    return Reason(robot, "not-chosen", "no plan does the task, whoever might")


def _excluded(problem: Problem, cause: Cause, i: int, j: int, least: float, befores: Sequence[str]) -> Reason:
    """What excluded a pair, as the rule says it that gave the bound, or the one that did.

    Of a rule that looks at teams it may be no more than that what comes before the task is lost: that is said first.
    """
    robot, rule = problem.robots[i].id, cause.rule
    lost = [] if rule.about_one else list(filter(None, befores))
    for before, other in itertools.product(lost, problem.rules):
        if other.about_one and (detail := other.never(problem, i, j, Outlook(cause.limits, least, before))) is not None:
            return Reason(robot, other.word, detail)
    word = rule.blamed(cause.limits, i, j)
    giver = next((one for one in problem.rules if one.word == word), rule)
    tried = itertools.product((giver, rule), befores)
    found = (one.never(problem, i, j, Outlook(cause.limits, least, before)) for one, before in tried)
    detail = next((text for text in found if text is not None), "no plan in which it does the task keeps the rule")
    return Reason(robot, word, detail)


def usable_pairs(problem: Problem, least: Floats | None = None) -> Bools:
    """(m, n) the pairs of robot and task that may be in an admissible plan, as far as lower bounds tell."""
    return limits_beside(problem, least_usages(problem) if least is None else least).usable


def limits_of(problem: Problem, *, timed: bool = False) -> Limits:
    """Lower bounds of usage, and of times if these matter or are wanted, and the pairs that they leave."""
    least = np.array([least_usage(problem, i) for i in range(len(problem.robots))])
    return narrowed(problem, least, _least_times, timed=timed)


def limits_beside(problem: Problem, least: Floats) -> Limits:
    """Lower bounds of times beside those of usage, and the pairs that they leave."""
    return narrowed(problem, least, _least_times)


def least_usages(problem: Problem) -> Floats:
    """(m, n) a lower bound of the usage of any route of a robot with a task in it.

    That is `least_usage`; where too many paths through short cuts would have to be compared, the work alone.
    """
    robots = range(len(problem.robots))
    if _few_ways(problem):
        return np.array([least_usage(problem, i) for i in robots])
    return np.array([problem.work_usage(i) for i in robots])


def least_usage(problem: Problem, i: int) -> Floats:
    """(n,) the least usage of any route of robot i that holds the task; inf where there is none."""
    there, back = _least_ways(problem, i, problem.legs, problem.work_usage(i))
    return np.asarray(there + problem.work_usage(i) + back)


def _few_ways(problem: Problem) -> bool:
    return len(problem.robots) * len(problem.shortcuts()) * len(problem.tasks) <= _MOST_WAYS


def _least_times(problem: Problem, i: int) -> tuple[Floats, Floats]:
    """(n,) seconds from the start of robot i to each task, and (n,) from there to the end of its route; or less."""
    if not _few_ways(problem):
        nothing = np.zeros(len(problem.tasks))
        return nothing, nothing
    return _least_ways(problem, i, problem.travel_seconds, problem.work_seconds(i))


def _least_ways(problem: Problem, i: int, legs: Legs, work: Floats) -> tuple[Floats, Floats]:
    """(n,) the least ways of robot i from its start to each task, and from there to the end of its route.

    Where travel keeps the triangle inequality those are the straight ways. It does not where a travel table says
    otherwise or a task is left elsewhere than entered: ways through such tasks are looked at too.
    """
    tasks = np.arange(len(problem.tasks))
    through = [int(j) for j in problem.shortcuts() if problem.may(i, int(j))]
    there = legs(i, [problem.start(i)], tasks)[0]
    between = legs(i, through, tasks)
    arrival = _shortest(there[through], between[:, through] + work[through, None])
    there = np.minimum(there, _via(arrival + work[through], between))
    if problem.robots[i].place_at_end(problem.mission.rules) is None:
        return there, np.zeros_like(there)
    back = legs(i, tasks, [problem.end(i)])[:, 0]
    between = legs(i, tasks, through)
    departure = _shortest(back[through], (between[through] + work[through]).T)
    return there, np.minimum(back, _via(departure + work[through], between.T))


def _via(first: Floats, then: Floats) -> Floats:
    """(n,) least of first[k] + then[k, j] over k; inf if there is no k."""
    return np.asarray((first[:, None] + then).min(axis=0, initial=math.inf))


def _shortest(first: Floats, steps: Floats) -> Floats:
    """Dijkstra: least cost to each node, entering at node k for first[k] and going on from a to b for steps[a, b]."""
    best = first.copy()
    queue = [(cost, k) for k, cost in enumerate(first.tolist()) if math.isfinite(cost)]
    heapq.heapify(queue)
    while queue:
        cost, k = heapq.heappop(queue)
        if cost > best[k]:
            continue
        onward = cost + steps[k]
        for j in np.flatnonzero(onward < best).tolist():
            best[j] = onward[j]
            heapq.heappush(queue, (float(onward[j]), j))
    return best
