"""The latest ends of tasks by what waits for them: an auction that sells one by one looks ahead by these.

Backward pass of the critical-path method [kelley1959] through openings, latest ends and gaps: a task has to end so
early that all that waits for it can still be in time, as far as anybody may do that.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import replace
from graphlib import TopologicalSorter

import numpy as np

from muster import core
from muster.model.plan_model import PlanModel
from muster.model.problem import Floats, Problem

_TIE = 1e-12
"""By how much a task may begin later and is not late, relative; less than the core allows."""


class LatestEnds:
    """The latest ends of a problem's tasks, and the problem that is bound by them."""

    def __init__(self, problem: Problem) -> None:
        self._problem, rules = problem, problem.model
        self._own = rules.ends_by
        self._ends = _latest_ends(problem, rules)
        self._bound: dict[frozenset[int], Problem] = {}

    @property
    def any(self) -> bool:
        """Whether a task has to end sooner than the model says."""
        return bool((self._ends < self._own).any())

    def binding(self, routes: Sequence[Sequence[int]]) -> Problem:
        """The problem with these ends, where routes that have a schedule keep them."""
        stops = core.Inspection(self._problem.core, [list(route) for route in routes]).stops or []
        late = frozenset(
            task for route in stops for task, _, begin, end in route if self._is_late(task, begin, end - begin)
        )
        if late not in self._bound:
            self._bound = {late: self._with_ends(late)}
        return self._bound[late]

    def _is_late(self, task: int, begin: float, lasts: float) -> bool:
        latest = float(self._ends[task]) - lasts
        return begin > latest + _TIE * max(1.0, latest)

    def _with_ends(self, late: frozenset[int]) -> Problem:
        ends = (
            float(own if j in late else end) for j, (own, end) in enumerate(zip(self._own, self._ends, strict=True))
        )
        return replace(self._problem, sooner=tuple(ends), known=self._problem.measured)


def _latest_ends(problem: Problem, rules: PlanModel) -> Floats:
    """(n,) seconds; inf: nothing binds a task."""
    work = np.array([problem.work_seconds(i) for i in range(len(problem.robots))])
    shortest = np.where(problem.allowed, work, math.inf).min(axis=0, initial=math.inf)
    longest = np.where(problem.allowed, work, 0.0).max(axis=0, initial=0.0)
    before = {u: {rules.unit[k] for j in unit for k in problem.prerequisites[j]} for u, unit in enumerate(rules.units)}
    ends = rules.ends_by.copy()
    for u in reversed(list(TopologicalSorter(before).static_order())):
        unit = rules.units[u]
        if np.isinf(shortest[unit]).any():
            continue  # nobody may do one of them
        begin = min(_last_begin(rules, j, float(ends[j] - shortest[j])) for j in unit)
        if begin < 0.0:
            continue  # it is too late from the first
        for j in unit:
            ends[j] = min(ends[j], begin + longest[j])
            for k, after, _ in rules.gaps(j):
                if after <= begin:  # else it is too late whenever the other ends
                    ends[k] = min(ends[k], begin - after)
    return ends


def _last_begin(model: PlanModel, j: int, latest: float) -> float:
    """The last time up to `latest` at which work on a task may begin; -inf: none is."""
    spans = model.openings[j]
    begins = (min(latest, closes) for opens, closes in spans if opens <= latest)
    return max(begins, default=-math.inf if spans else latest)
