"""Why no plan does some tasks together, in plain numbers."""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np

from muster.allocation.bounds.limits import Limits, late_task
from muster.allocation.bounds.subset_times import sizes_that_differ, tied_pairs, ways_of
from muster.allocation.bounds.usage_bounds import FEW, UsageBounds
from muster.mission.model import Robot, Task
from muster.mission.texts.counting import counted
from muster.model.rules.rule import ROUNDING
from muster.model.rules.times import moments

_MOST_REASONS = 2  # why others cannot do the tasks


def in_mission_order(items: Sequence[Robot] | Sequence[Task], names: Sequence[str]) -> tuple[str, ...]:
    """The names in the order of the mission."""
    chosen = set(names)
    return tuple(item.id for item in items if item.id in chosen)


def conflict_text(bounds: UsageBounds, robots: list[int], tasks: list[int]) -> str:
    """Why robots, all that can do any of the tasks, cannot do them all."""
    problem = bounds.problem
    names = ", ".join(in_mission_order(problem.mission.robots, [problem.robots[i].id for i in robots]))
    said = (
        _too_much_together(bounds, robots, tasks, names)
        or _tied(bounds, tasks)
        or _too_late_for_one(bounds, robots, tasks)
        or _however(bounds, robots, tasks, names)
    )
    others = bounds.limits.why_no_others(robots, tasks)
    return f"{said} (others: {'; '.join(others)})" if 0 < len(others) <= _MOST_REASONS else said


def _too_much_together(bounds: UsageBounds, robots: list[int], tasks: list[int], names: str) -> str:
    """That all robots together have too little capacity."""
    problem, unit = bounds.problem, bounds.problem.usage_unit
    capacity = float(problem.capacity[robots].sum())
    least = bounds.least_together(robots, tasks)
    if len(robots) == 1 and len(tasks) <= FEW:
        least = float(bounds.subset_usages(robots[0], tasks)[-1])
    if math.isinf(least) or least <= capacity * (1 + ROUNDING):
        return ""
    who = f"only {names} can do them, and would use" if len(robots) == 1 else f"together {names} would use"
    digits = next((d for d in (2, 4, 6) if f"{least:.{d}f}" != f"{capacity:.{d}f}"), 9)
    return f"{who} at least {least:.{digits}f} {unit}, of {capacity:.{digits}f} {unit}"


def _tied(bounds: UsageBounds, tasks: list[int]) -> str:
    """That two tasks must have the same robots, or others, and there are none."""
    problem, rules = bounds.problem, bounds.problem.model
    if (pair := sizes_that_differ(problem, tasks)) is not None:
        (a, few), (b, many) = ((problem.tasks[j].id, rules.least_members(j)) for j in pair)
        return f"the same robots must do {a} and {b}; {a} needs {counted(few, 'robot')}, {b} {counted(many, 'robot')}"
    for j, k in tied_pairs(problem, tasks):
        first, then = (np.flatnonzero(bounds.possible[:, t]).tolist() for t in (j, k))
        who = [", ".join(problem.robots[i].id for i in some) or "nobody" for some in (first, then)]
        a, b = problem.tasks[j].id, problem.tasks[k].id
        if k in rules.same_crew[j] and not set(first) & set(then):
            return f"the same robot must do {a} and {b}; {a} only {who[0]} can do, {b} only {who[1]}"
        if k not in rules.same_crew[j] and len(first) == 1 and first == then:
            return f"different robots must do {a} and {b}, and only {who[0]} can do them"
    return ""


def _too_late_for_one(bounds: UsageBounds, robots: list[int], tasks: list[int]) -> str:
    """That one robot alone is too late for one of two tasks, in both orders."""
    if len(robots) != 1 or len(tasks) != 2 or not bounds.limits.is_timed:
        return ""
    i, (a, b) = robots[0], tasks
    both = [_after(bounds.limits, i, first, then) for first, then in ((a, b), (b, a))]
    found = [text for text in both if text]
    name = bounds.problem.robots[i].id
    return f"only {name} can do them: {'; '.join(found)}" if len(found) == 2 else ""


def _after(limits: Limits, i: int, a: int, b: int) -> str:
    """What is too late when robot i does task b after task a; empty: nothing is."""
    problem, rules = limits.problem, limits.rules
    first, then = problem.tasks[a].id, problem.tasks[b].id
    if b in problem.prerequisites[a]:
        return f"{then} comes before {first}"
    way = ways_of(problem, i, [a, b], problem.travel_seconds, problem.work_seconds(i))[1, 2]
    ready = max(float(limits.pair_end[i, a] + way), float(limits.ready[b]))
    begin = float(rules.next_begin(b, np.array([ready]))[0])
    end = begin + max(float(limits.work[i, b]), float(limits.shortest_work[b]))
    if late := late_task(problem, b, ready, end):
        return f"with {first} first, {then} {late}"
    over = float(rules.busy_until(i, np.array(end), limits.home[i, b]))
    back = next((text for rule in problem.rules if (text := rule.over_late(problem, i, over))), "")
    return f"with {first} first and then {then}, {back}" if back else ""


def _however(bounds: UsageBounds, robots: list[int], tasks: list[int], names: str) -> str:
    """That every way to share the tasks out breaks a limit."""
    limits, problem = bounds.limits, bounds.problem
    if not limits.is_timed:
        return f"however {names} share them out, one of the robots would need more than its capacity"
    limited = np.isfinite(problem.capacity[robots]).any()
    breaks = "be too late or need more than its capacity" if limited else "be too late"
    openings = (limits.rules.openings[j] for j in tasks)
    closes = np.array([spans[-1][1] if spans else math.inf for spans in openings])
    last = float(np.minimum(closes, limits.rules.ends_by[tasks]).max())
    until = f"; all must begin or end by {moments(problem, last)[0]}" if math.isfinite(last) else ""
    if len(robots) == 1:
        return f"only {names} can do them, and in every order it would {breaks}{until}"
    return f"however {names} share them out, one of the robots would {breaks}{until}"
