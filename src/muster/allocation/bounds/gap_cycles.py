"""Gaps that no schedule keeps: a cycle of bounds on the begins of tasks, each of which raises the next for ever."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import Protocol

import numpy as np

from muster.model.plan_model import ROUNDING, PlanModel
from muster.model.problem import Floats, Problem
from muster.model.rules.rule import HeldBack
from muster.model.rules.times import span, spans


class Works(Protocol):
    """What is known of works: see `Limits`."""

    @property
    def problem(self) -> Problem: ...
    @property
    def rules(self) -> PlanModel: ...
    @property
    def shortest_work(self) -> Floats: ...
    @property
    def longest_work(self) -> Floats: ...


@dataclass(frozen=True)
class _Bound:
    """Task `then` begins at least so many seconds after task `first` begins; `said` in words."""

    first: int
    then: int
    seconds: float
    said: str
    word: str = ""  # of the rule that says how long after another a task may begin at most


def gap_cycle(works: Works, tasks: Sequence[int]) -> HeldBack | None:
    """Which gaps between tasks exclude each other; None: none do. By Bellman and Ford."""
    bounds = [bound for j in tasks for bound in _bounds(works, j)]
    if all(bound.seconds >= 0 for bound in bounds):
        return None  # nothing may begin only so long after another
    begin, raised_by = dict.fromkeys(tasks, 0.0), dict[int, _Bound]()
    last: _Bound | None = None
    for _ in range(len(tasks) + 1):
        last = None
        for bound in bounds:
            time = begin[bound.first] + bound.seconds
            if time > begin[bound.then] + ROUNDING * max(1.0, abs(time)):
                begin[bound.then], raised_by[bound.then], last = time, bound, bound
        if last is None:
            return None
    assert last is not None  # as it is not after the last round
    return _said(_cycle_before(raised_by, last.then, len(tasks)))


def _bounds(works: Works, j: int) -> Iterator[_Bound]:
    """The bounds by the gaps before a task, and by the tasks that begin with it."""
    tasks, rules = works.problem.tasks, works.rules
    for k, after, within in rules.gaps(j):
        name, before = tasks[j].id, tasks[k].id
        least = f"{name} begins at least {span(after)} after {before} ends"
        yield _Bound(k, j, float(works.shortest_work[k]) + after, least)
        if np.isfinite(within):
            most = f"{name} begins at most {span(within)} after {before} ends"
            word = rules.given_by("gaps", k, j)
            yield _Bound(j, k, -within - float(works.longest_work[k]), most, word)
    for k in rules.beginning_with(j):
        yield _Bound(k, j, 0.0, f"{tasks[j].id} begins together with {tasks[k].id}")


def _cycle_before(raised_by: dict[int, _Bound], task: int, count: int) -> list[_Bound]:
    """The bounds of the cycle that has raised a task, in order."""
    for _ in range(count):
        task = raised_by[task].first
    cycle = [raised_by[task]]
    while cycle[0].first != task:
        cycle.insert(0, raised_by[cycle[0].first])
    return cycle


def _said(cycle: Sequence[_Bound]) -> HeldBack:
    over = sum(bound.seconds for bound in cycle)
    said = f"{'; '.join(bound.said for bound in cycle)}: with the work {spans(0.0, over)[1]} too long"
    return HeldBack(said, next(bound.word for bound in cycle if bound.word))
