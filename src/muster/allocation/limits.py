"""Lower bounds of usage and times of robots and tasks, over all admissible plans."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from muster.allocation.bottleneck import bottleneck
from muster.allocation.problem import Bools, Floats, Problem
from muster.allocation.timed_rules import ROUNDING, TimedRules

_MOST_ROUNDS = 50  # of narrowing bounds; they hold whenever it ends


@dataclass(frozen=True, eq=False)
class Limits:
    """What no admissible plan is below.

    Parameters
    ----------
    usage
        (m, n) the least usage of any route of a robot with a task in it; inf where there is none.
    usable
        (m, n) the pairs that may be in an admissible plan, as far as is known.
    arrival, home
        (m, n) seconds until a robot can be at a task, and from there to the end of its route; empty: nothing is timed.
    ready
        (n,) seconds until everything is there that work on a task needs, whoever does it; its windows not looked at.
    begin
        (n,) seconds until work on a task begins; inf: never.
    awaited
        for each task the prerequisite whose end is the latest of what it waits for; None: a robot is.
    """

    problem: Problem
    usage: Floats
    usable: Bools
    arrival: Floats
    home: Floats
    ready: Floats
    begin: Floats
    awaited: tuple[int | None, ...]

    @property
    def rules(self) -> TimedRules:
        return self.problem.timed_rules

    @property
    def is_timed(self) -> bool:
        return bool(self.arrival.size)

    @cached_property
    def work(self) -> Floats:
        """(m, n) seconds."""
        return np.array([self.problem.work_seconds(i) for i in range(len(self.problem.robots))])

    @cached_property
    def shortest_work(self) -> Floats:
        """(n,) the least seconds of work of any robot or team."""
        allowed = np.where(self.problem.allowed, self.work, math.inf)
        found = [_of_team(self.rules, u, allowed) for u in range(len(self.rules.units))]
        shortest = np.array([found[self.rules.unit[j]][j] for j in range(len(self.problem.tasks))])
        return np.where(np.isfinite(shortest), shortest, 0.0)

    @cached_property
    def longest_work(self) -> Floats:
        """(n,) the most seconds of work of any robot."""
        return np.asarray(np.where(self.problem.allowed, self.work, 0.0).max(axis=0, initial=0.0))

    @cached_property
    def pair_ready(self) -> Floats:
        """(m, n) seconds until a robot is at a task and everything else is there."""
        return np.maximum(self.arrival, self.ready)

    @cached_property
    def pair_begin(self) -> Floats:
        """(m, n) seconds until a robot begins work on a task; inf: never."""
        columns = [self.rules.next_begin(j, self.pair_ready[:, j]) for j in range(len(self.problem.tasks))]
        return np.maximum(np.array(columns).T.reshape(self.usable.shape), self.begin)

    @cached_property
    def pair_end(self) -> Floats:
        """(m, n) seconds until a robot has ended work on a task, with its team."""
        return self.pair_begin + np.maximum(self.work, self.shortest_work)

    @cached_property
    def alone(self) -> Bools:
        """(m, n) the pairs that may be in an admissible plan, as far as rules tell that look at one robot."""
        return self._kept_by(self.problem.allowed, about_one=True)

    def possible(self) -> Bools:
        """(m, n) the pairs that may be in an admissible plan."""
        return self._kept_by(self._kept_by(self.usable, about_one=True), about_one=False)

    def _kept_by(self, usable: Bools, *, about_one: bool) -> Bools:
        for rule in self.problem.rules:
            possible = rule.possible(self) if rule.about_one == about_one else None
            usable = usable if possible is None else usable & possible
        return np.asarray(usable)

    def must_also(self, j: int) -> list[int]:
        """The other tasks that are in every plan with a task: all that come before it or begin with it."""
        if j not in self._needed:
            needed, waiting = {j}, [j]
            while waiting:
                k = waiting.pop()
                new = {*self.problem.prerequisites[k], *self.rules.units[self.rules.unit[k]]} - needed
                needed |= new
                waiting += new
            self._needed[j] = sorted(needed - {j})
        return self._needed[j]

    @cached_property
    def _needed(self) -> dict[int, list[int]]:
        return {}


def narrowed(problem: Problem, usage: Floats, ways: Callable[[Problem, int], tuple[Floats, Floats]]) -> Limits:
    """Narrow the bounds until nothing changes: each pair that is not possible may make others begin later.

    `ways` gives for a robot the seconds until it can be at each task, and from there to the end of its route.
    """
    none = np.empty((0, 0))
    nobody = np.zeros(len(problem.tasks))
    limits = Limits(problem, usage, problem.allowed, none, none, nobody, nobody, (None,) * len(problem.tasks))
    if not problem.timed_rules.are_any:
        return replace(limits, usable=limits.possible())
    found = [ways(problem, i) for i in range(len(problem.robots))]
    limits = replace(limits, arrival=np.array([a for a, _ in found]), home=np.array([h for _, h in found]))
    for _ in range(_MOST_ROUNDS):
        next_limits = _with_begins(limits)
        usable = next_limits.possible()
        settled = bool((usable == limits.usable).all()) and bool((next_limits.begin == limits.begin).all())
        limits = replace(next_limits, usable=usable)
        if settled:
            break
    return limits


def _with_begins(limits: Limits) -> Limits:
    """Earliest begins with the pairs that are still possible."""
    rules, tasks = limits.rules, range(len(limits.problem.tasks))
    there = np.where(limits.usable, limits.arrival, math.inf)
    ready = np.array(limits.ready)
    for u in range(len(rules.units)):
        latest = max(_of_team(rules, u, there).values())
        for j in rules.units[u]:
            ready[j] = max(ready[j], latest) if math.isfinite(latest) else ready[j]
    begin, awaited = np.array([_begin(rules, rules.unit[j], ready) for j in tasks]), list(limits.awaited)
    for _ in range(len(tasks) + 1):
        if not _sweep(limits, ready, begin, awaited):
            break
    return replace(limits, ready=ready, begin=begin, awaited=tuple(awaited))


def _sweep(limits: Limits, ready: Floats, begin: Floats, awaited: list[int | None]) -> bool:
    """Let tasks wait for prerequisites, and these for what must follow soon; returns whether anything changed."""
    changed = False
    for j in range(len(begin)):
        for k, after, within in limits.rules.lags(j):
            if not math.isfinite(begin[k]):
                continue  # which is left out, and so is all that waits for it
            onward = begin[k] + limits.shortest_work[k] + max(after, _way(limits, k, j))
            changed |= _raise(limits, j, onward, ready, begin, awaited, k)
            if math.isfinite(within) and math.isfinite(begin[j]):
                earliest = begin[j] - within - limits.longest_work[k]
                changed |= _raise(limits, k, earliest, ready, begin, awaited, None)
    return changed


def _raise(
    limits: Limits, j: int, time: float, ready: Floats, begin: Floats, awaited: list[int | None], why: int | None
) -> bool:
    if time <= ready[j] * (1 + ROUNDING):
        return False
    unit = limits.rules.unit[j]
    for k in limits.rules.units[unit]:
        ready[k], awaited[k] = max(ready[k], time), why
    for k in limits.rules.units[unit]:
        begin[k] = _begin(limits.rules, unit, ready)
    return True


def _begin(rules: TimedRules, u: int, ready: Floats) -> float:
    """When all tasks of a unit may begin at once."""
    time, before = float(max(ready[j] for j in rules.units[u])), -math.inf
    while before < time < math.inf:
        before = time
        for j in rules.units[u]:
            time = float(rules.next_begin(j, np.array([time]))[0])
    return time


def _way(limits: Limits, k: int, j: int) -> float:
    """Least travel from a task to the next, if the same robot must do both; else 0."""
    robots, others = (np.flatnonzero(limits.usable[:, t]) for t in (k, j))
    alone = len(robots) == 1 and len(others) == 1 and robots[0] == others[0]
    if len(limits.problem.shortcuts()):
        return 0.0  # a way through another task may be shorter
    if not (alone or k in limits.rules.same_robot[j] or j in limits.rules.same_robot[k]):
        return 0.0
    both = np.flatnonzero(limits.usable[:, k] & limits.usable[:, j]).tolist()
    return min((float(limits.problem.travel_seconds(i, [k], [j])[0, 0]) for i in both), default=0.0)


def _of_team(rules: TimedRules, u: int, values: Floats) -> dict[int, float]:
    """For each task of a unit the least of the largest values of the members, if a team has these; inf: no team."""
    tasks, fits = rules.places(u)
    found: dict[int, float] = {}
    for j in rules.units[u]:
        rows = np.array([k for k, task in enumerate(tasks) if task == j])
        times = np.where(fits[rows], values[:, j], math.inf)
        found[j] = _until_able(rules, j, values[:, j]) if rules.needs(j) else bottleneck(times)
    return found


def _until_able(rules: TimedRules, j: int, values: Floats) -> float:
    """The least value up to which robots have the abilities that a task needs; inf: all have not."""
    order = np.argsort(values, kind="stable")
    order = order[np.isfinite(values[order])]
    latest = 0.0
    for needed, able in rules.needs(j):
        enough = np.flatnonzero(np.cumsum(able[order]) >= needed * (1 - ROUNDING))
        latest = max(latest, float(values[order[enough[0]]])) if len(enough) else math.inf
        if math.isinf(latest):
            break
    return latest
