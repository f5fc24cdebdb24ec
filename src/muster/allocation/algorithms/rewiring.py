"""Re-wiring: an improvement pass that fills waiting time with the robot's own later tasks.

[tcf-thesis], 6.3.1, (6.1) to (6.3): robot f waits `du = u_n(q) - u_f(p - 1)` for its p-th task, whose prerequisite
robot n does as its q-th. A task that f would do later is put before it, if that makes f's route longer by less than
`du`. The thesis takes usage for time; here all is time. A change is made only if robots wait less in all or the mission
ends earlier, and neither is more. It may cost usage: that is what it pays with.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from muster import core
from muster.allocation.allocator import Outcome, Routes, admissible_routes, finished_plan
from muster.allocation.stop import Stop
from muster.mission.plan import Plan
from muster.mission.system.clock import VirtualClock
from muster.model.problem import Problem

_LEAST_S = 1e-9  # by which waiting, or the makespan, has to become less


@dataclass(frozen=True)
class Rewired:
    """A plan after re-wiring, and for how many seconds robots wait at tasks before and after."""

    plan: Plan
    waiting_before_s: float
    waiting_after_s: float


def rewire(problem: Problem, plan: Plan) -> Rewired:
    """The plan with less waiting, each task with the robots that had it.

    Raises
    ------
    ParameterError
        if the plan is not admissible.
    """
    before = admissible_routes(problem, plan, "plan")
    after = rewired(problem, before)
    made = finished_plan(problem, Stop(clock=VirtualClock()), Outcome(after), allocator="", seed=0)
    own_history = ((plan.elapsed_s or 0.0, made.objective_value or 0.0),)  # of the search it tells no longer
    made = replace(
        made,
        allocator=plan.allocator,
        seed=plan.seed,
        elapsed_s=plan.elapsed_s,
        cut_short=plan.cut_short,
        history=plan.history if made.objective_value == plan.objective_value else own_history,
        book=plan.book,
    )
    return Rewired(made, _waiting(problem, before).total, _waiting(problem, after).total)


def rewired(problem: Problem, routes: Routes) -> Routes:
    """Admissible routes with less waiting; the fixed beginnings of routes stay. All rules of the mission are kept."""
    routes, now = [list(route) for route in routes], _waiting(problem, routes)
    while True:
        better = _first_better(problem, routes, now)
        if better is None:
            return routes
        routes, now = better


@dataclass(frozen=True)
class _Waiting:
    """How long robots wait: in all, and at each place of a route; when the last task ends; what is late. Seconds.

    All are inf of routes that break a rule.
    """

    total: float
    makespan: float
    lateness: float
    at: dict[tuple[int, int], float]

    def is_less_than(self, other: _Waiting) -> bool:
        """Whether waiting or the makespan is less, and nothing is more."""
        longer = max(self.total - other.total, self.makespan - other.makespan, self.lateness - other.lateness)
        shorter = min(self.total - other.total, self.makespan - other.makespan)
        return longer <= 0 and shorter < -_LEAST_S


_NEVER = _Waiting(math.inf, math.inf, math.inf, {})


def _waiting(problem: Problem, routes: Routes) -> _Waiting:
    """How long robots wait if they do these routes, each as early as it can."""
    found = core.Inspection(problem.core, routes)
    stops = found.stops if found.admissible else None
    if stops is None:
        return _NEVER
    at = {(i, k): begin - arrive for i, route in enumerate(stops) for k, (_, arrive, begin, _) in enumerate(route)}
    late = (found.objective or 0.0) if problem.objective == "lateness" else 0.0
    return _Waiting(sum(at.values()), found.makespan or 0.0, late, at)


def _first_better(problem: Problem, routes: Routes, now: _Waiting) -> tuple[Routes, _Waiting] | None:
    """Fill the longest waiting time that can be filled, with the task after which robots wait least."""
    waits = [place for place, seconds in now.at.items() if seconds > _LEAST_S]
    for f, p in sorted(waits, key=lambda place: (-now.at[place], routes[place[0]][place[1]])):
        if p < len(problem.beginning(f)):
            continue
        tried = [_put_before(routes, f, p, q) for q in range(p + 1, len(routes[f]))]
        travels_s = _travel_seconds(problem, f, routes[f])
        fitting = [other for other in tried if _travel_seconds(problem, f, other[f]) - travels_s < now.at[f, p]]
        judged = [(other, _waiting(problem, other)) for other in fitting]
        less = [(other, then) for other, then in judged if then.is_less_than(now)]
        if less:
            return min(less, key=lambda pair: (pair[1].total, pair[1].makespan))
    return None


def _put_before(routes: Routes, f: int, p: int, q: int) -> Routes:
    """Routes in which robot f does its q-th task right before its p-th."""
    route = routes[f]
    return [*routes[:f], [*route[:p], route[q], *route[p:q], *route[q + 1 :]], *routes[f + 1 :]]


def _travel_seconds(problem: Problem, i: int, route: Sequence[int]) -> float:
    ends = [problem.end(i)] if problem.robots[i].place_at_end(problem.mission.rules) else []
    return float(np.trace(problem.travel_seconds(i, [problem.start(i), *route], [*route, *ends])))
