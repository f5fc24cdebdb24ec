"""Proofs by sums: the work of all tasks is more than the robots that can do them have time, capacity or energy for.

Each member of a task's team works on it for no less than its least work, whatever the plan; ways come on top. So the
work of tasks that a group of robots alone can do, each task as often as it has members, is no more than what the group
has in all: of time up to when routes or tasks are over at the latest, of usage, or of energy that no station gives.
"""

from __future__ import annotations

import itertools
import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import asdict, dataclass, fields
from typing import Any

import numpy as np

from muster.allocation.bounds.usage_bounds import UsageBounds
from muster.mission.texts.counting import counted
from muster.model.problem import Bools, Floats, Problem
from muster.model.rules import all_rules
from muster.model.rules.rule import ROUNDING, listed

_MOST_KINDS = 6  # of tasks by who can do them, up to which two kinds are looked at together
_MOST_NAMED = 6  # robots
_MOST_SAID = 3  # shortfalls, those that lack most
_LARGE = 1e-9


@dataclass(frozen=True, kw_only=True)
class Shortfall:
    """Work that is more than what robots have for it, however it is shared out.

    Parameters
    ----------
    resource
        what is short: the word of a rule, see `Rule.resource`.
    robots, tasks
        a group of robots, all of them or some, and the tasks that no other robot can do; in mission order.
    everyone
        whether these are all robots of the mission.
    needed, available, unit
        the work of the tasks and what the robots have, `robot-seconds` or the unit of usage.
    left_out
        how many of the tasks every plan leaves out at least.
    more_robots
        how many more robots, each with as much as the one of the group that has most, are needed at least.
    """

    resource: str
    robots: tuple[str, ...]
    tasks: tuple[str, ...]
    everyone: bool
    needed: float
    available: float
    unit: str
    left_out: int
    more_robots: int

    @property
    def lacking(self) -> float:
        """How much is short before any travel."""
        return self.needed - self.available

    @property
    def detail(self) -> str:
        """The proof in words."""
        return (
            f"{self._who()}{_amount(self.needed)} {self.unit} of work in {_amount(self.available)} of {self._of()}:"
            f" {_amount(self.lacking)} {self.unit} short before any travel"
        )

    @property
    def least(self) -> str:
        """What is least to add, or to leave out."""
        more = f"{_amount(self.lacking)} {self.unit} of {self._of()}, or {counted(self.more_robots, 'more robot')}"
        return f"least to add: {more}; or leave out at least {counted(self.left_out, 'task')}"

    def as_dict(self) -> dict[str, Any]:
        """Return the shortfall as plain data, with what is lacking and the words for it."""
        return {**asdict(self), "lacking": self.lacking, "detail": self.detail, "least": self.least}

    @classmethod
    def from_dict(cls, data: Mapping[str, Any]) -> Shortfall:
        """Read the result of `as_dict`, also from JSON."""
        named = {field.name: data[field.name] for field in fields(cls)}
        return cls(**{**named, "robots": tuple(named["robots"]), "tasks": tuple(named["tasks"])})

    def _of(self) -> str:
        return dict(filter(None, (rule.resource for rule in all_rules()))).get(self.resource, self.resource)

    def _who(self) -> str:
        if self.everyone:
            return ""
        more = len(self.robots) - _MOST_NAMED
        names = f"{listed(self.robots[:_MOST_NAMED])}{f' and {more} more' if more > 0 else ''}"
        return f"{counted(len(self.tasks), 'task')} that only {names} can do: "


def shortfalls(problem: Problem, tasks: Sequence[int], bounds: UsageBounds | None = None) -> tuple[Shortfall, ...]:
    """Return the proofs by sums that no plan does all of some tasks, those that lack most first."""
    bounds = bounds or UsageBounds(problem)
    if not tasks:
        return ()
    found = [
        short
        for resource in _resources(problem, bounds.possible, tasks)
        for group in _groups(bounds.possible, tasks)
        if (short := resource.shortfall(group, tasks)) is not None
    ]
    return tuple(sorted(found, key=lambda short: -short.lacking / short.needed)[:_MOST_SAID])


def _groups(possible: Bools, tasks: Sequence[int]) -> Iterator[frozenset[int]]:
    """Groups of robots: those that can do any task, those of each kind of task, and of two kinds if these are few."""
    kinds = {frozenset(np.flatnonzero(possible[:, j]).tolist()) for j in tasks}
    pairs = {a | b for a, b in itertools.combinations(kinds, 2)} if len(kinds) <= _MOST_KINDS else set()
    yield from sorted({frozenset[int]().union(*kinds), *kinds, *pairs}, key=lambda group: (-len(group), sorted(group)))


@dataclass(frozen=True, eq=False)
class _Resource:
    """What work takes: (m, n) of each pair, and (m,) what robots have of it."""

    name: str
    unit: str
    problem: Problem
    possible: Bools
    work: Floats
    has: Floats
    by_tasks: Bools | None = None  # (m,) whether its tasks, and not its route, say how much time a robot has

    def shortfall(self, group: frozenset[int], tasks: Sequence[int]) -> Shortfall | None:
        problem, robots = self.problem, sorted(group)
        outside = np.ones(len(problem.robots), dtype=np.bool_)
        outside[robots] = False
        own = [j for j in tasks if not self.possible[outside, j].any()]
        available = float(self.has[robots].sum())
        if not own or not robots or not math.isfinite(available):
            return None
        works = [self._least(j) for j in own]
        needed = sum(works)
        if needed <= available * (1 + ROUNDING) + _LARGE:
            return None
        most = float(self.has[robots].max())
        lacking = needed - available
        return Shortfall(
            resource=_OF_TASKS if self.by_tasks is not None and self.by_tasks[robots].any() else self.name,
            robots=tuple(robot.id for robot in problem.mission.robots if problem.robot_index[robot.id] in group),
            tasks=tuple(task.id for task in problem.mission.tasks if problem.task_index[task.id] in set(own)),
            everyone=len(robots) == len(problem.robots),
            needed=needed,
            available=available,
            unit=self.unit,
            left_out=_fewest(works, lacking),
            more_robots=math.ceil(lacking / most * (1 - ROUNDING)) if most > 0 else len(own),
        )

    def _least(self, j: int) -> float:
        """The least work of a task, all members together: each works as long as the slowest, or pays its own cost."""
        count = self.problem.model.least_members(j)
        least = np.sort(self.work[self.possible[:, j], j])[:count]
        if len(least) < count:
            return 0.0
        as_long = self.unit == _SECONDS or self.problem.in_time
        return float(least[-1] * count if as_long else least.sum())


_SECONDS = "robot-seconds"
_OF_TASKS = "time"


def _resources(problem: Problem, possible: Bools, tasks: Sequence[int]) -> Iterator[_Resource]:
    robots = range(len(problem.robots))
    seconds = np.array([problem.work_seconds(i) for i in robots])
    rules, start = problem.model, np.array([robot.available_from_s for robot in problem.robots])
    until = rules.over_by
    longest = seconds.max(axis=0, initial=0.0)  # a team takes as long as its slowest member
    last = np.array([_last_end(problem, [j for j in tasks if possible[i, j]], longest) for i in robots])
    has = np.maximum(0.0, np.minimum(until, last) - start)
    yield _Resource(rules.word_of("over_by") or _OF_TASKS, _SECONDS, problem, possible, seconds, has, last < until)
    usage = seconds if problem.in_time else np.array([problem.work_usage(i) for i in robots])
    unit = _SECONDS if problem.in_time else problem.usage_unit
    if word := rules.word_of("capacity"):
        yield _Resource(word, unit, problem, possible, usage, problem.capacity)
    if (word := rules.word_of("energy")) and not rules.refills:
        has = np.minimum(rules.energy_at_start, problem.capacity)
        yield _Resource(word, unit, problem, possible, usage, has)


def _last_end(problem: Problem, tasks: Sequence[int], longest: Floats) -> float:
    """When the last of some tasks ends at the latest, whatever their robots."""
    rules = problem.model
    ends = [
        min(float(rules.ends_by[j]), rules.openings[j][-1][1] + float(longest[j]) if rules.openings[j] else math.inf)
        for j in tasks
    ]
    return max(ends, default=0.0)


def _fewest(works: Sequence[float], lacking: float) -> int:
    """How many tasks have as much work as is lacking, at least."""
    sums = itertools.accumulate(sorted(works, reverse=True))
    return next((k for k, total in enumerate(sums, 1) if total >= lacking * (1 - ROUNDING)), len(works))


def _amount(value: float) -> str:
    return f"{value:,.2f}".rstrip("0").rstrip(".")
