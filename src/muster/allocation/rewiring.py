"""Re-wiring: an improvement pass that fills waiting time with the robot's own later tasks.

[tcf-thesis], 6.3.1, (6.1) to (6.3): robot f waits `du = u_n(q) - u_f(p - 1)` for its p-th task, whose prerequisite
robot n does as its q-th. A task that f would do later is put before it, if that makes f's route longer by less than
`du`. The thesis takes usage for time; here all is time. A change is made only if robots wait less in all or the mission
ends earlier, and neither is more. It may cost usage: that is what it pays with.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from graphlib import CycleError, TopologicalSorter

import numpy as np

from muster.allocation.allocator import Outcome, Routes, admissible_routes, finished_plan
from muster.allocation.problem import Floats, Problem
from muster.allocation.rules.rule import ROUNDING
from muster.allocation.stop import Stop
from muster.mission.clock import VirtualClock
from muster.mission.errors import ParameterError
from muster.mission.plan import Plan

_LEAST_S = 1e-9  # by which waiting, or the makespan, has to become less


@dataclass(frozen=True)
class Rewired:
    """A plan after re-wiring, and for how many seconds robots wait at tasks before and after."""

    plan: Plan
    waiting_before_s: float
    waiting_after_s: float


def rewire(problem: Problem, plan: Plan) -> Rewired:
    """The plan with less waiting, each task with the robot that had it.

    Raises
    ------
    ParameterError
        if the plan is not admissible, or the mission has rules about time windows, deadlines, shifts, lags, teams or
        relations, which re-wiring does not look at.
    """
    if problem.has_timed_rules:
        rules = "time windows, deadlines, shifts, lags, teams, relations or the objective lateness"
        raise ParameterError(f"rewire: the mission has {rules}; expected one without, which alone can be re-wired")
    before = admissible_routes(problem, plan, "plan")
    after = rewired(problem, before)
    made = finished_plan(problem, Stop(clock=VirtualClock()), Outcome(after), allocator="", seed=0)
    own_history = ((plan.elapsed_s or 0.0, made.objective_value or 0.0),)  # of the search it tells no longer
    made = replace(
        made,
        allocator=plan.allocator,
        seed=plan.seed,
        elapsed_s=plan.elapsed_s,
        history=plan.history if made.objective_value == plan.objective_value else own_history,
        book=plan.book,
    )
    schedule = _Schedule(problem)
    return Rewired(made, schedule.waiting(before).total, schedule.waiting(after).total)


def rewired(problem: Problem, routes: Routes) -> Routes:
    """Admissible routes with less waiting; the fixed beginnings of routes stay.

    Routes of problems with time windows, deadlines, shifts, lags, teams or relations stay as they are.
    """
    if problem.has_timed_rules:
        return routes
    schedule = _Schedule(problem)
    routes, now = [list(route) for route in routes], schedule.waiting(routes)
    while True:
        better = _first_better(schedule, routes, now)
        if better is None:
            return routes
        routes, now = better


@dataclass(frozen=True)
class _Waiting:
    """How long robots wait: in all, and for each task; and when the last task ends. Seconds; inf if for ever."""

    total: float
    makespan: float
    at: dict[int, float]

    def is_less_than(self, other: _Waiting) -> bool:
        """Whether waiting or the makespan is less, and the other is not more."""
        longer = max(self.total - other.total, self.makespan - other.makespan)
        shorter = min(self.total - other.total, self.makespan - other.makespan)
        return longer <= 0 and shorter < -_LEAST_S


def _first_better(schedule: _Schedule, routes: Routes, now: _Waiting) -> tuple[Routes, _Waiting] | None:
    """Fill the longest waiting time that can be filled, with the task after which robots wait least."""
    where = {j: (f, p) for f, route in enumerate(routes) for p, j in enumerate(route)}
    for j in sorted((j for j, waits in now.at.items() if waits > _LEAST_S), key=lambda j: (-now.at[j], j)):
        f, p = where[j]
        tried = [_put_before(routes, f, p, q) for q in range(p + 1, len(routes[f]))]
        if p < len(schedule.problem.beginning(f)):
            continue
        fitting = [other for other in tried if schedule.fits(f, routes[f], other[f], now.at[j])]
        judged = [(other, schedule.waiting(other)) for other in fitting]
        less = [(other, then) for other, then in judged if then.is_less_than(now)]
        if less:
            return min(less, key=lambda pair: (pair[1].total, pair[1].makespan))
    return None


def _put_before(routes: Routes, f: int, p: int, q: int) -> Routes:
    """Routes in which robot f does its q-th task right before its p-th."""
    route = routes[f]
    return [*routes[:f], [*route[:p], route[q], *route[p:q], *route[q + 1 :]], *routes[f + 1 :]]


@dataclass(frozen=True)
class _Schedule:
    """Times of a problem's routes, every robot as early as it can."""

    problem: Problem

    def waiting(self, routes: Routes) -> _Waiting:
        """How long robots wait if they do these routes."""
        graph: dict[int, list[int]] = {}
        for route in routes:
            for k, j in enumerate(route):
                graph[j] = [*self.problem.prerequisites[j], *route[k - 1 : k]]
        robot = {j: (i, k) for i, route in enumerate(routes) for k, j in enumerate(route)}
        legs = [self._leg_seconds(i, route) for i, route in enumerate(routes)]
        try:
            order = list(TopologicalSorter(graph).static_order())
        except CycleError:
            return _Waiting(float("inf"), float("inf"), {})
        ends: dict[int, float] = {}
        at: dict[int, float] = {}
        for j in order:
            i, k = robot[j]
            leaves = ends[routes[i][k - 1]] if k else self.problem.robots[i].available_from_s
            arrives = leaves + legs[i][k]
            starts = max([arrives, *(ends[other] for other in self.problem.prerequisites[j])])
            ends[j], at[j] = starts + float(self._work_seconds[i, j]), starts - arrives
        return _Waiting(sum(at.values()), max(ends.values(), default=0.0), at)

    def fits(self, f: int, before: Sequence[int], after: Sequence[int], du: float) -> bool:
        """Whether a new order of robot f's route costs less than `du` seconds more, and is within its capacity."""
        old, new = self._travel_seconds(f, before), self._travel_seconds(f, after)
        usage = self._travel_usage(f, after) + float(self.problem.work_usage(f)[list(after)].sum())
        return new - old < du and usage <= self.problem.capacity[f] * (1 + ROUNDING)

    def _travel_usage(self, i: int, route: Sequence[int]) -> float:
        return float(np.trace(self.problem.legs(i, *self._ways(i, route))))

    def _travel_seconds(self, i: int, route: Sequence[int]) -> float:
        return float(np.trace(self.problem.travel_seconds(i, *self._ways(i, route))))

    def _ways(self, i: int, route: Sequence[int]) -> tuple[list[int], list[int]]:
        ends = [self.problem.end(i)] if self.problem.robots[i].place_at_end(self.problem.mission.rules) else []
        return [self.problem.start(i), *route], [*route, *ends]

    def _leg_seconds(self, i: int, route: Sequence[int]) -> list[float]:
        legs = np.diagonal(self.problem.travel_seconds(i, [self.problem.start(i), *route], route))
        return [float(leg) for leg in legs]

    @cached_property
    def _work_seconds(self) -> Floats:
        """(m, n) seconds that each task takes each robot."""
        rows = [self.problem.work_seconds(i) for i in range(len(self.problem.robots))]
        return np.array(rows).reshape(len(self.problem.robots), len(self.problem.tasks))
