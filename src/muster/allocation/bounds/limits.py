"""Lower bounds of usage and times of robots and tasks, over all admissible plans."""

from __future__ import annotations

import itertools
import math
from collections.abc import Callable, Collection, Sequence
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from muster.allocation.bounds.exclusions import Exclusions
from muster.allocation.bounds.gap_cycles import gap_cycle
from muster.model.bottleneck import bottleneck
from muster.model.plan_model import ROUNDING, PlanModel
from muster.model.problem import Bools, Floats, Problem
from muster.model.rules.rule import HeldBack
from muster.model.rules.times import spans

_MOST_ASKED = 50_000  # pairs, up to which it is said why others cannot do tasks
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
    way, home
        (m, n) the least seconds from a robot's start to a task, and from there to the end of its route; empty: nothing
        is timed.
    ready
        (n,) seconds until everything is there that work on a task needs, whoever does it; its openings not looked at.
    begin
        (n,) seconds until work on a task begins; inf: never.
    awaited
        for each task the prerequisite whose end is the latest of what it waits for; None: a robot is.
    exclusions
        what excluded pairs, in these bounds and those before.
    """

    problem: Problem
    usage: Floats
    usable: Bools
    way: Floats
    home: Floats
    ready: Floats
    begin: Floats
    awaited: tuple[int | None, ...]
    exclusions: Exclusions

    @property
    def rules(self) -> PlanModel:
        return self.problem.model

    @property
    def is_timed(self) -> bool:
        return bool(self.way.size)

    @cached_property
    def arrival(self) -> Floats:
        """(m, n) seconds until a robot can be at a task; empty: nothing is timed."""
        begins = [np.array(robot.available_from_s) for robot in self.problem.robots]
        rows = [self.rules.busy_until(i, begins[i], way) for i, way in enumerate(self.way)]
        return np.array(rows).reshape(self.way.shape)

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
        begin = np.maximum(np.array(columns).T.reshape(self.usable.shape), self.begin)
        for i in self.rules.parts.spans:
            begin[i] = self.rules.set_out(i, begin[i], self._pair_work[i])
        return begin

    @cached_property
    def pair_end(self) -> Floats:
        """(m, n) seconds until a robot has ended work on a task, with its team."""
        return self.pair_begin + self._pair_work

    @cached_property
    def _pair_work(self) -> Floats:
        """(m, n) seconds of work of a robot on a task, with its team."""
        return np.maximum(self.work, self.shortest_work)

    @cached_property
    def over(self) -> Floats:
        """(m, n) seconds until a robot is at the end of its route, of any with a task in it."""
        rows = [
            self.rules.busy_until(i, end, home)
            for i, (end, home) in enumerate(zip(self.pair_end, self.home, strict=True))
        ]
        return np.array(rows).reshape(self.usable.shape)

    @cached_property
    def under_way(self) -> Floats:
        """(m, n) seconds from when a robot leaves its start until then."""
        return np.asarray(self.way + self._pair_work + self.home)

    @cached_property
    def alone(self) -> Bools:
        """(m, n) the pairs that may be in an admissible plan, as far as rules tell that look at one robot."""
        usable = self.problem.allowed
        for possible in self._possible_alone.values():
            usable = usable if possible is None else usable & possible
        return np.asarray(usable)

    @cached_property
    def _possible_alone(self) -> dict[str, Bools | None]:
        """By word what the rules leave that look at one robot; None: all."""
        return {rule.word: rule.possible(self) for rule in self.problem.rules if rule.about_one}

    @property
    def possible_by_rule(self) -> list[Bools | None]:
        """For each rule the pairs (m, n) that it leaves; None: all."""
        alone = self._possible_alone
        return [alone[rule.word] if rule.about_one else rule.possible(self) for rule in self.problem.rules]

    def bare(self) -> Limits:
        """The same without what is worked out from it."""
        return replace(self)

    def why_no_others(self, group: Collection[int], tasks: Sequence[int]) -> tuple[str, ...]:
        """Why no robot outside a group does any of some tasks, each reason once; empty: one may, or pairs are too many.

        Of what refuses a pair the rule and its words, of what excluded one, for which times differ, the rule alone.
        """
        problem, found = self.problem, dict[str, None]()
        outside = [i for i in range(len(problem.robots)) if i not in group]
        pairs = itertools.product(outside, tasks) if len(outside) * len(tasks) <= _MOST_ASKED else ()
        for i, j in pairs:
            if (refused := problem.refusal(i, j)) is not None:
                found[", ".join(refused)] = None
            elif (cause := self.exclusions.cause(i, j)) is not None:
                found[cause.rule.blamed(cause.limits, i, j)] = None
            else:
                return ()
        return tuple(found)

    def must_also(self, j: int) -> list[int]:
        """The other tasks that are in every plan with a task: all that come before it or begin with it."""
        if j not in self._needed:
            needed, waiting = {j}, [j]
            while waiting:
                k = waiting.pop()
                new = {*self.rules.awaited[k], *self.rules.units[self.rules.unit[k]]} - needed
                needed |= new
                waiting += new
            self._needed[j] = sorted(needed - {j})
        return self._needed[j]

    @cached_property
    def held_back(self) -> dict[int, HeldBack]:
        """The tasks that no plan does as one before them may end only so long before, each with what is too late."""
        tasks = range(len(self.problem.tasks)) if self.is_timed else ()
        found = {j: _too_far(self, j) or gap_cycle(self, [j, *self.must_also(j)]) or _held_back(self, j) for j in tasks}
        return {j: late for j, late in found.items() if late}

    @cached_property
    def _needed(self) -> dict[int, list[int]]:
        return {}


def narrowed(
    problem: Problem, usage: Floats, ways: Callable[[Problem, int], tuple[Floats, Floats]], *, timed: bool = False
) -> Limits:
    """Narrow the bounds until nothing changes: each pair that is not possible may make others begin later.

    `timed` tells whether times are wanted even where none matter. `ways` gives for a robot the
    least seconds from its start to each task, and from there to the end of its route.
    """
    if not (timed or problem.has_timed_rules):
        none = np.empty((0, 0))
        limits = _unnarrowed(problem, usage, none, none)
        return replace(limits, usable=limits.exclusions.narrowed(limits))
    found = [ways(problem, i) for i in range(len(problem.robots))]
    return _narrowed(_unnarrowed(problem, usage, np.array([way for way, _ in found]), np.array([h for _, h in found])))


def untimed(problem: Problem) -> Limits:
    """No bounds, for a problem in which nothing is timed; its pairs depend on their usage alone."""
    none, at_once = np.empty((0, 0)), np.zeros(len(problem.tasks))
    awaited, nothing = (None,) * len(problem.tasks), Exclusions(problem)
    return Limits(problem, none, none.astype(np.bool_), none, none, at_once, at_once, awaited, nothing)


def _unnarrowed(problem: Problem, usage: Floats, way: Floats, home: Floats) -> Limits:
    at_once = np.zeros(len(problem.tasks))
    awaited, nothing = (None,) * len(problem.tasks), Exclusions(problem)
    return Limits(problem, usage, problem.allowed, way, home, at_once, at_once, awaited, nothing)


def _narrowed(limits: Limits) -> Limits:
    for _ in range(_MOST_ROUNDS):
        next_limits = _with_begins(limits)
        usable = limits.exclusions.narrowed(next_limits)
        settled = bool((usable == limits.usable).all()) and bool((next_limits.begin == limits.begin).all())
        limits = replace(next_limits, usable=usable)
        if settled:
            break
    return limits


@dataclass(frozen=True)
class _Times:
    """Bounds while they are raised: see `Limits`."""

    ready: Floats
    begin: Floats
    awaited: list[int | None]

    def wait(self, rules: PlanModel, j: int, time: float, why: int | None) -> bool:
        """Let a task, and all that begins with it, wait until a time; returns whether that is later."""
        if time <= self.ready[j] * (1 + ROUNDING) + ROUNDING:
            return False
        unit = rules.unit[j]
        for k in rules.units[unit]:
            self.ready[k], self.awaited[k] = max(self.ready[k], time), why
        for k in rules.units[unit]:
            self.begin[k] = _begin(rules, unit, self.ready)
        return True


def _with_begins(limits: Limits) -> Limits:
    """Earliest begins with the pairs that are still possible."""
    rules, tasks = limits.rules, range(len(limits.problem.tasks))
    there = np.where(limits.usable, limits.arrival, math.inf)
    ready = np.array(limits.ready)
    for u in range(len(rules.units)):
        latest = max(_of_team(rules, u, there).values())
        for j in rules.units[u]:
            ready[j] = max(ready[j], latest) if math.isfinite(latest) else ready[j]
    times = _Times(ready, np.array([_begin(rules, rules.unit[j], ready) for j in tasks]), list(limits.awaited))
    for _ in range(len(tasks) + 1):
        if not _sweep(limits, times):
            break
    return replace(limits, ready=times.ready, begin=times.begin, awaited=tuple(times.awaited))


def _sweep(limits: Limits, times: _Times) -> bool:
    """Let tasks wait for their prerequisites; returns whether anything changed."""
    changed = False
    for j in range(len(times.begin)):
        for k, after, _ in limits.rules.gaps(j):
            if math.isfinite(times.begin[k]):  # else it is left out, and so is all that waits for it
                onward = times.begin[k] + limits.shortest_work[k] + max(after, _way(limits, k, j, limits.usable))
                changed |= times.wait(limits.rules, j, onward, k)
    return changed


def _too_far(limits: Limits, j: int) -> HeldBack | None:
    """That a task begins only so long after another, and the robot that must do both takes longer to come to it."""
    for k, _, within in limits.rules.gaps(j):
        way = _way(limits, k, j, limits.problem.allowed) if math.isfinite(within) else 0.0
        if way > within * (1 + ROUNDING) + ROUNDING:
            most, least = spans(within, way)
            before = limits.problem.tasks[k].id
            robot = f"the robot that does both takes {least} to come to it"
            word = limits.rules.given_by("gaps", k, j)
            return HeldBack(f"begins at most {most} after {before} ends, and {robot}", word)
    return None


def _held_back(limits: Limits, j: int) -> HeldBack | None:
    """Which task before a task would be too late in every plan that does both, as it may not end too long before."""
    tasks = [j, *limits.must_also(j)]
    gaps = [(k, b, within) for k in tasks for b, _, within in limits.rules.gaps(k) if math.isfinite(within)]
    if not gaps:
        return None
    times = _Times(limits.ready.copy(), limits.begin.copy(), list(limits.awaited))
    for _ in range(len(tasks) + 1):
        waiting = [
            times.wait(limits.rules, b, times.begin[k] - within - limits.longest_work[b], None)
            for k, b, within in gaps
            if math.isfinite(times.begin[k])
        ]
        if not any(waiting) and not _sweep(limits, times):
            break
    late = next((late for k in tasks if k != j and (late := _late(limits, times, k))), "")
    return HeldBack(late, limits.rules.given_by("gaps", gaps[0][1], gaps[0][0])) if late else None


def _late(limits: Limits, times: _Times, k: int) -> str:
    """That a task is too late at some times; empty: it is not, or not by that alone."""
    problem, begin = limits.problem, float(times.begin[k])
    if math.isinf(limits.begin[k]) or begin == limits.begin[k]:
        return ""
    late = late_task(problem, k, float(times.ready[k]), begin + float(limits.shortest_work[k]))
    return f"{problem.tasks[k].id} may end only so long before what follows: it {late}" if late else ""


def late_task(problem: Problem, j: int, ready: float, end: float) -> str:
    """That task j is too late which is ready, and ends, at these times at the earliest; empty: by no rule."""
    return next((late for rule in problem.rules if (late := rule.late(problem, j, ready, end))), "")


def _begin(rules: PlanModel, u: int, ready: Floats) -> float:
    """When all tasks of a unit may begin at once."""
    time, before = float(max(ready[j] for j in rules.units[u])), -math.inf
    while before < time < math.inf:
        before = time
        for j in rules.units[u]:
            time = float(rules.next_begin(j, np.array([time]))[0])
    return time


def _way(limits: Limits, k: int, j: int, usable: Bools) -> float:
    """Least travel from a task to the next, if the same robot must do both; else 0."""
    robots, others = (np.flatnonzero(usable[:, t]) for t in (k, j))
    alone = len(robots) == 1 and len(others) == 1 and robots[0] == others[0]
    if len(limits.problem.shortcuts()):
        return 0.0  # a way through another task may be shorter
    if not (alone or k in limits.rules.same_crew[j] or j in limits.rules.same_crew[k]):
        return 0.0
    both = np.flatnonzero(usable[:, k] & usable[:, j]).tolist()
    return min((float(limits.problem.travel_seconds(i, [k], [j])[0, 0]) for i in both), default=0.0)


def _of_team(rules: PlanModel, u: int, values: Floats) -> dict[int, float]:
    """For each task of a unit the least of the largest values of the members, if a team has these; inf: no team."""
    tasks, fits = rules.places(u)
    found: dict[int, float] = {}
    for j in rules.units[u]:
        rows = np.array([k for k, task in enumerate(tasks) if task == j])
        times = np.where(fits[rows], values[:, j], math.inf)
        found[j] = _until_able(rules, j, values[:, j]) if rules.sums(j) else bottleneck(times)
    return found


def _until_able(rules: PlanModel, j: int, values: Floats) -> float:
    """The least value up to which robots have the abilities that a task needs; inf: all have not."""
    order = np.argsort(values, kind="stable")
    order = order[np.isfinite(values[order])]
    latest = 0.0
    for needed, able in rules.sums(j).values():
        enough = np.flatnonzero(np.cumsum(able[order]) >= needed * (1 - ROUNDING))
        latest = max(latest, float(values[order[enough[0]]])) if len(enough) else math.inf
        if math.isinf(latest):
            break
    return latest
