"""Conflicts: sets of tasks that can each be done, but not all in one plan, with a proof.

That no admissible plan does a set of tasks is proven by lower bounds on usage and times (`usage_bounds`); that a set of
tasks can be done is shown by a plan that was found and judged (`witness_plans`).
"""

from __future__ import annotations

import itertools
from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import dataclass, replace

import numpy as np

from muster.allocation.allocator import Routes
from muster.allocation.bounds.feasibility import impossible
from muster.allocation.bounds.subset_times import tied_pairs
from muster.allocation.bounds.usage_bounds import UsageBounds
from muster.allocation.bounds.work_shortfall import Shortfall, shortfalls
from muster.allocation.remedies.conflict_texts import conflict_text, in_mission_order
from muster.allocation.remedies.mission_remedies import MissionRemedy, mission_remedies
from muster.allocation.search.witness_plans import Judge, attempt, can_do, does_all, least_seconds
from muster.mission.system.clock import Clock, SystemClock
from muster.model.problem import Problem

_LEFT_OUT_TRIED = 5
_OVERTIME_S = 0.2
_LEAST_SEARCH_S = 0.05  # for a plan with a remedy
_MOST_PAIRS = 2_000_000  # of robot and task, up to which sums of work are taken without a time limit
_BEFORE_PROOFS = 1  # seed of the last search before proofs are tried


@dataclass(frozen=True, kw_only=True)
class Conflict:
    """Tasks of which no admissible plan does all, as bounds prove; all but one of them can be done.

    `prerequisites` are the further tasks that must come before them. `robots` are those that can do any of these tasks.
    `minimal` tells whether for each task a plan of all the others was found; else the conflict may have a smaller one
    in it.
    """

    tasks: tuple[str, ...]
    prerequisites: tuple[str, ...]
    robots: tuple[str, ...]
    detail: str
    minimal: bool
    proven: bool = True


@dataclass(frozen=True)
class Together:
    """Whether one plan can do all tasks that are possible by themselves: it can if nothing here says otherwise.

    `unknown` tells that no plan of them all was found, and none was proven impossible. `shortfalls` are the proofs that
    their work is too much for the robots; `remedies` are changes of the mission that lift all of these.
    """

    conflict: Conflict | None = None
    unknown: bool = False
    shortfalls: tuple[Shortfall, ...] = ()
    remedies: tuple[MissionRemedy, ...] = ()

    @property
    def proven(self) -> bool:
        """Whether no plan can do them all."""
        return self.conflict is not None or bool(self.shortfalls)


def together(problem: Problem, judge: Judge, *, time_limit: float = 2.0, clock: Clock | None = None) -> Together:
    """Look for a plan of all tasks, and where there seems to be none for a minimal conflict.

    Nothing is begun that is known to take longer than the time limit by more than `_OVERTIME_S`.
    """
    clock = clock or SystemClock()
    begin = clock.now()

    def left() -> float:
        return max(0.0, begin + time_limit - clock.now())

    if least_seconds(problem) > time_limit + _OVERTIME_S:
        return Together(unknown=True)
    tasks = _possible(problem)
    sure, bounds = _in_every_plan(problem, tasks), UsageBounds(problem)
    if short := shortfalls(problem, tasks, bounds):
        lifted = _lifted(problem, tasks, short, judge, left, clock)
        proven = _proven(bounds, sure, (), left)
        conflict = None if proven is None else _minimal(bounds, proven, judge, left, clock)
        return Together(conflict, shortfalls=short, remedies=lifted)
    for seed in itertools.count():
        share = left() if seed > _BEFORE_PROOFS else left() / 3
        routes = attempt(problem, tasks, seed=seed, time_limit=share, clock=clock)
        if does_all(problem, routes, _one_of_each(problem, tasks, routes), judge):
            return Together()
        if seed == _BEFORE_PROOFS:
            proven = _proven(bounds, sure, set(sure).difference(*routes), left)
            if proven is not None:
                return Together(_minimal(bounds, proven, judge, left, clock))
        if left() == 0.0:
            break
    return Together(unknown=True)


def _lifted(
    problem: Problem,
    tasks: Sequence[int],
    short: Sequence[Shortfall],
    judge: Judge,
    left: Callable[[], float],
    clock: Clock,
) -> tuple[MissionRemedy, ...]:
    """The remedies of a mission that are found in time, and in half of what is left of it maybe a plan with each."""
    found = list(mission_remedies(problem, tasks, short, lambda: left() == 0.0))
    until, remedies = left() / 2, []
    for number, one in enumerate(found):
        share = max(0.0, left() - until) / (len(found) - number)
        does = False
        if share > max(_LEAST_SEARCH_S, least_seconds(one.problem)):
            other = Problem.compile(one.problem.mission, problem.objective, problem.ignored)
            routes = attempt(other, tasks, time_limit=share, clock=clock)
            does = does_all(other, routes, _one_of_each(other, tasks, routes), judge)
        remedies.append(replace(one.remedy, plan_found=does))
    return tuple(remedies)


def without_search(problem: Problem) -> Together:
    """Return what sums of work alone prove, at once; in a very large problem that is not looked at."""
    if len(problem.robots) * len(problem.tasks) > _MOST_PAIRS:
        return Together(unknown=True)
    short = shortfalls(problem, _possible(problem))
    return Together(unknown=not short, shortfalls=short)


def _possible(problem: Problem) -> list[int]:
    """The tasks of which none is known to be impossible."""
    lost = {item.task for item in impossible(problem)}
    return [j for j, task in enumerate(problem.tasks) if task.id not in lost]


def _in_every_plan(problem: Problem, tasks: Sequence[int]) -> list[int]:
    """Those of the tasks in whose place no other can be done."""
    return [j for j in tasks if not problem.model.exclusive[j]]


def _one_of_each(problem: Problem, tasks: Sequence[int], routes: Routes) -> list[int]:
    """The tasks without those in whose place the routes do another."""
    done = {j for route in routes for j in route}
    return [j for j in tasks if not done.intersection(problem.model.exclusive[j])]


def _proven(
    bounds: UsageBounds, tasks: Sequence[int], missing: Iterable[int], left: Callable[[], float]
) -> list[int] | None:
    """Tasks that are proven to be too many, if time is left to find some."""
    for robots, own in _candidates(bounds, tasks, missing):
        if left() == 0.0:
            return None
        if bounds.exceed(robots, own):
            return own
    return None


def _candidates(
    bounds: UsageBounds, tasks: Sequence[int], missing: Iterable[int]
) -> Iterator[tuple[list[int], list[int]]]:
    """Tasks that may conflict and all robots that can do any.

    Those tied by who does them, few robots' own, then few around each task left out.
    """
    for pair in tied_pairs(bounds.problem, tasks):
        yield from bounds.groups(bounds.problem.closed(pair))
    yield from bounds.groups(tasks)
    hardest = sorted(tasks, key=lambda j: -bounds.hardness[j])
    for j in sorted(missing, key=lambda j: -bounds.hardness[j])[:_LEFT_OUT_TRIED]:
        mates = bounds.possible[:, j]
        rivals = sorted(hardest, key=lambda k: bool((bounds.possible[:, k] & ~mates).any()))
        for order in (rivals, hardest):
            few = {j}
            for k in order:
                if bounds.is_few(bounds.problem.closed({*few, k})):
                    few.add(k)
            yield from bounds.groups(bounds.problem.closed(few))


def _minimal(bounds: UsageBounds, tasks: list[int], judge: Judge, left: Callable[[], float], clock: Clock) -> Conflict:
    """Take tasks out of a proven conflict, the easiest first, while the rest is one; then try to do all but one."""
    problem, core = bounds.problem, list(tasks)
    for j in sorted(tasks, key=lambda j: float(bounds.hardness[j])):
        fewer = [k for k in core if k != j]
        if left() > 0.0 and bounds.forbid(fewer):
            core = fewer
    minimal = all(
        can_do(problem, problem.closed([k for k in core if k != j]), judge, time_limit=left(), clock=clock)
        for j in core
    )
    needed = problem.closed(core)
    robots = np.flatnonzero(bounds.possible[:, needed].any(axis=1)).tolist()
    return Conflict(
        tasks=in_mission_order(problem.mission.tasks, [problem.tasks[j].id for j in core]),
        prerequisites=in_mission_order(problem.mission.tasks, [problem.tasks[j].id for j in needed if j not in core]),
        robots=in_mission_order(problem.mission.robots, [problem.robots[i].id for i in robots]),
        detail=conflict_text(bounds, robots, needed),
        minimal=minimal,
    )
