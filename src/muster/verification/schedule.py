"""The earliest schedule of routes, or the deadlock that forbids one (docs/design.md, Meaning).

[tcf-thesis] (3.25) compares the order within one route only. Here the graph of all routes and all prerequisites
is judged, which also finds robots that wait for each other for ever.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from graphlib import CycleError, TopologicalSorter
from itertools import groupby, pairwise

from muster.mission.plan import tie_order
from muster.verification.measure import MeasuredRoute

Awaited = Mapping[str, Sequence[str]]
"""For each task in the plan, those of its prerequisites that are in the plan."""


@dataclass(frozen=True)
class Times:
    """When the robot is at a task, seconds."""

    arrives: float
    starts: float
    ends: float


@dataclass(frozen=True)
class Deadlock:
    """There is no schedule: tasks wait for each other in a cycle, which `detail` names step by step."""

    detail: str


def awaited_in(routes: Sequence[MeasuredRoute], ignored: bool) -> Awaited:
    """Find what each task waits for, besides the task before it in its route."""
    tasks = [step.task for route in routes for step in route.steps]
    done = {task.id for task in tasks}
    return {task.id: [] if ignored else [name for name in task.prerequisites if name in done] for task in tasks}


def schedule(routes: Sequence[MeasuredRoute], awaited: Awaited) -> dict[str, Times] | Deadlock:
    """Find the times of every task, if each robot does its tasks in order, as early as it can.

    A robot leaves when it is available, and waits at a task until the last of the task's prerequisites has ended.
    """
    at = {step.task.id: (route, step) for route in routes for step in route.steps}
    before = _task_before(routes)
    graph = {task: [*awaited[task], *([] if last is None else [last])] for task, last in before.items()}
    try:
        order = list(TopologicalSorter(graph).static_order())
    except CycleError as error:
        cycle = error.args[1][:-1]  # graphlib repeats the first task at the end
        return Deadlock(_deadlock_text(cycle, before, {task: route.robot.id for task, (route, _) in at.items()}))
    times: dict[str, Times] = {}
    for task in order:
        route, step = at[task]
        last = before[task]
        leaves = route.robot.available_from_s if last is None else times[last].ends
        arrives = leaves + step.leg.seconds
        starts = max([arrives, *(times[name].ends for name in awaited[task])])
        times[task] = Times(arrives, starts, starts + step.work_s)
    return times


def _task_before(routes: Sequence[MeasuredRoute]) -> dict[str, str | None]:
    """Find for each task the one before it in its route; None for the first."""
    before: dict[str, str | None] = {}
    for route in routes:
        last = None
        for step in route.steps:
            before[step.task.id] = last
            last = step.task.id
    return before


def _deadlock_text(cycle: Sequence[str], before: Mapping[str, str | None], robots: Mapping[str, str]) -> str:
    """Describe the cycle step by step, and what makes each: `r_1: 2 -> 16; prerequisite: 16 -> 14; ...`."""
    in_route = [before[later] == task for task, later in pairwise([*cycle, cycle[0]])]
    # Prerequisites have no cycle and routes have none, so a route's step follows on a prerequisite somewhere.
    starts = [k for k in range(len(cycle)) if in_route[k] and not in_route[k - 1]]
    first = starts[tie_order([cycle[k] for k in starts])[0]]
    turned = [*cycle[first:], *cycle[: first + 1]]

    def reason(step: tuple[str, str]) -> str:
        task, later = step
        return robots[task] if before[later] == task else "prerequisite"

    parts = []
    for label, steps in groupby(pairwise(turned), key=reason):
        (task, later), *others = steps
        parts.append(f"{label}: {' -> '.join([task, later, *(other for _, other in others)])}")
    return "; ".join(parts)
