"""Proofs by sums: the work of all tasks is more than the robots that can do them have time, capacity or energy for.

Each member of a task's team works on it for no less than its least work, whatever the plan; ways come on top. So the
work of tasks that a group of robots alone can do, each task as often as it has members, is no more than what the group
has in all: of time up to when routes or tasks are over at the latest, of usage, or of energy that no station gives.
Where there is enough in all, the same is asked of intervals of time, with the least legs between tasks.
"""

from __future__ import annotations

import itertools
import math
from collections import Counter
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import asdict, dataclass, fields, replace
from typing import Any

import numpy as np

from muster.allocation.bounds.interval_work import IntervalWork, Overload
from muster.allocation.bounds.limits import Limits
from muster.allocation.bounds.usage_bounds import UsageBounds
from muster.mission.texts.counting import counted
from muster.model.problem import Bools, Floats, Problem
from muster.model.rules import all_rules
from muster.model.rules.rule import ROUNDING, listed
from muster.model.rules.times import moments

_MOST_KINDS = 6  # of tasks by who can do them, up to which two kinds are looked at together
_MOST_NAMED = 6  # robots, or tasks
_MOST_SAID = 3  # shortfalls, those that lack most
_MOST_GROUPS = 24  # of robots whose intervals are looked at
_MOST_REFUSALS = 2  # of the other robots
_LARGE = 1e-9
Forcing = Callable[[Sequence[int]], Sequence[int]]
"""For some tasks the others because of which they begin so early."""


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
        how many of the tasks every plan leaves out at least, beside the alternatives.
    more_robots
        how many more robots, each with as much as the one of the group that has most, are needed at least.
    travel
        what the ways between the tasks take at least.
    when
        the interval of time to which all of it is confined; empty: none.
    alternatives
        how many of the tasks no plan does, as it does others in their place.
    shared
        whether other robots can do some of the tasks' teams, but not all.
    after
        the tasks that leave these no more time, as they come after them: of all together some are left out.
    refusals
        why no other robots can do the tasks, as rules say; empty: too many reasons, or none that is about robots.
    with_ways
        how much is short of the same where ways between tasks are counted; 0: not known.
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
    travel: float = 0.0
    when: str = ""
    alternatives: int = 0
    shared: bool = False
    after: tuple[str, ...] = ()
    refusals: tuple[str, ...] = ()
    with_ways: float = 0.0

    @property
    def lacking(self) -> float:
        """How much is short; without intervals, before any travel."""
        return self.needed + self.travel - self.available

    @property
    def detail(self) -> str:
        """The proof in words."""
        work = f"{self._who()}{_amount(self.needed)} {self.unit} of work"
        travel = f" and at least {_amount(self.travel)} of ways between" if self.travel else ""
        short = f"{_amount(self.lacking)} {self.unit} short{'' if self.travel else ' before any travel'}"
        return f"{work}{travel} in {_amount(self.available)} of {self._of()}: {short}"

    @property
    def least(self) -> str:
        """What is least to add, or to leave out."""
        more = f"{_amount(self.lacking)} {self.unit} of {self._of()}, or {counted(self.more_robots, 'more robot')}"
        return f"least to add: {more}; or leave out at least {counted(self.left_out, 'task')}"

    @property
    def more(self) -> tuple[str, ...]:
        """What is known beside the proof, in lines."""
        ways = f"  with the ways between tasks {_amount(self.with_ways)} {self.unit} short"
        return (f"  {self.least}", *((ways,) if self.with_ways else ()))

    def as_dict(self) -> dict[str, Any]:
        """Return the shortfall as plain data, with what is lacking and the words for it."""
        return {**asdict(self), "lacking": self.lacking, "detail": self.detail, "least": self.least}

    @classmethod
    def from_dict(cls, data: Mapping[str, Any]) -> Shortfall:
        """Read the result of `as_dict`, also from JSON."""
        named = {field.name: data[field.name] for field in fields(cls)}
        return cls(**{**named, **{name: tuple(named[name]) for name in ("robots", "tasks", "after", "refusals")}})

    def _of(self) -> str:
        if self.when:
            return f"{_OF_TASKS} {self.when}"
        return dict(filter(None, (rule.resource for rule in all_rules()))).get(self.resource, self.resource)

    def _who(self) -> str:
        why = f" (others: {'; '.join(self.refusals)})" if self.refusals else ""
        names = _few(self.robots)
        can = f"that {names} must do, at least in part" if self.shared else f"that only {names} can do{why}"
        before = f"before {_few(self.after)}" if self.after else ""
        said = ", ".join(filter(None, ("" if self.everyone else can, before)))
        return f"{counted(len(self.tasks), 'task')} {said}: " if said else ""


def _few(names: Sequence[str]) -> str:
    """The first of some names, and how many more there are."""
    more = len(names) - _MOST_NAMED
    return f"{listed(names[:_MOST_NAMED])}{f' and {more} more' if more > 0 else ''}"


def shortfalls(problem: Problem, tasks: Sequence[int], bounds: UsageBounds | None = None) -> tuple[Shortfall, ...]:
    """Return the proofs by sums that no plan does all of some tasks, those that lack most first.

    Of tasks that exclude each other plans are meant that do one. Of proofs about one resource none has a task of one
    before it.
    """
    bounds = bounds or UsageBounds(problem)
    if not tasks:
        return ()
    groups = _groups(problem, bounds.possible, tasks)
    found = list[Shortfall]()
    for resource in _resources(bounds.limits, tasks):
        short = [one for group in groups if (one := resource.shortfall(group, tasks)) is not None]
        found += _apart(short)
    in_intervals = list(_in_intervals(bounds, groups, tasks))
    found = [_with_ways(short, in_intervals) for short in found]
    found += _apart(in_intervals, [short for short in found if short.unit == _SECONDS])
    return tuple(found[:_MOST_SAID])


def _with_ways(short: Shortfall, others: Sequence[Shortfall]) -> Shortfall:
    """The shortfall with what is short of the same work once ways are counted, too."""
    same = [o.lacking for o in others if o.travel and not o.after and set(o.tasks) <= set(short.tasks)]
    most = max(same, default=0.0) if short.unit == _SECONDS else 0.0
    return replace(short, with_ways=most) if most > short.lacking else short


def _apart(found: Iterable[Shortfall], known: Sequence[Shortfall] = ()) -> list[Shortfall]:
    """The shortfalls, that which lacks most first, without those that share tasks with one before."""
    taken, kept = {task for short in known for task in short.tasks}, list[Shortfall]()
    for short in sorted(found, key=lambda short: -short.lacking / (short.needed + short.travel)):
        if taken.isdisjoint(short.tasks):
            kept.append(short)
            taken.update(short.tasks)
    return kept


def _in_intervals(bounds: UsageBounds, groups: Sequence[frozenset[int]], tasks: Sequence[int]) -> Iterator[Shortfall]:
    """The shortfalls of time in intervals."""
    if bounds.limits.is_timed:
        works = IntervalWork(bounds.limits, tasks)
        for overload in works.overloads(groups[:_MOST_GROUPS]):
            yield _in_interval(bounds.limits, overload, works.forcing)


def _in_interval(limits: Limits, found: Overload, forcing: Forcing) -> Shortfall:
    problem = limits.problem
    own, lacking = np.flatnonzero((found.work > 0) | (found.legs > 0)).tolist(), found.lacking
    begins, ends = moments(problem, found.begins, found.ends)
    after = forcing(own)  # one of these left out gives others time
    most = float(found.available.max()) + float(found.legs.max(initial=0.0))
    outside = np.ones(len(problem.robots), np.bool_)
    outside[list(found.group)] = False
    named = _named(limits, found.group, own)
    return Shortfall(
        resource=_OF_TASKS,
        **named,
        needed=float(found.work.sum()),
        available=float(found.available.sum()),
        unit=_SECONDS,
        left_out=1 if after or named["alternatives"] else _fewest((found.work + found.legs)[own].tolist(), lacking),
        more_robots=math.ceil(lacking / most * (1 - ROUNDING)) if most > 0 else len(own),
        travel=found.travel,
        when=f"between {begins} and {ends}",
        shared=bool(limits.usable[outside][:, own].any()),
        after=tuple(task.id for task in problem.mission.tasks if problem.task_index[task.id] in after),
    )


def _named(limits: Limits, group: frozenset[int], tasks: Sequence[int]) -> dict[str, Any]:
    """Who is short, and with which tasks: of those that exclude each other all."""
    problem = limits.problem
    whole = set(tasks).union(*(alike for alike in problem.model.alternatives if not set(alike).isdisjoint(tasks)))
    said = limits.why_no_others(group, tasks)
    return {
        "robots": tuple(robot.id for robot in problem.mission.robots if problem.robot_index[robot.id] in group),
        "tasks": tuple(task.id for task in problem.mission.tasks if problem.task_index[task.id] in whole),
        "everyone": len(group) == len(problem.robots),
        "alternatives": len(whole) - len(tasks),
        "refusals": said if len(said) <= _MOST_REFUSALS else (),
    }


def _groups(problem: Problem, possible: Bools, tasks: Sequence[int]) -> list[frozenset[int]]:
    """Groups of robots: those that can do any task, of each kind of task or seat, and of two kinds if these are few.

    Kinds are of tasks by the robots that can do them, or may; those of most tasks come first.
    """
    kinds = Counter[frozenset[int]]()
    for j in tasks:
        seats = problem.model.seats(j) if problem.model.has_seats(j) else ()
        sorts = [possible[:, j], problem.allowed[:, j], *(fits & possible[:, j] for _, fits in seats)]
        kinds.update({frozenset(np.flatnonzero(able).tolist()) for able in sorts})
    ordered = [kind for kind, _ in kinds.most_common()]
    pairs = [a | b for a, b in itertools.combinations(ordered, 2)] if len(ordered) <= _MOST_KINDS else []
    everyone = frozenset[int]().union(*(frozenset(np.flatnonzero(possible[:, j]).tolist()) for j in tasks))
    return [group for group in dict.fromkeys((everyone, *ordered, *pairs)) if group]


@dataclass(frozen=True, eq=False)
class _Resource:
    """What work takes: (m, n) of each pair, and (m,) what robots have of it."""

    name: str
    unit: str
    limits: Limits
    work: Floats
    has: Floats
    by_tasks: Bools | None = None  # (m,) whether its tasks, and not its route, say how much time a robot has

    def shortfall(self, group: frozenset[int], tasks: Sequence[int]) -> Shortfall | None:
        problem, robots = self.limits.problem, sorted(group)
        outside = np.ones(len(problem.robots), dtype=np.bool_)
        outside[robots] = False
        own = [j for j in tasks if not self.limits.usable[outside, j].any()]
        available = float(self.has[robots].sum())
        if not own or not robots or not math.isfinite(available):
            return None
        works = _one_of_each(problem, {j: self._least(j) for j in own}, tasks)
        needed = sum(works.values())
        if needed <= available * (1 + ROUNDING) + _LARGE:
            return None
        most = float(self.has[robots].max())
        lacking = needed - available
        return Shortfall(
            resource=_OF_TASKS if self.by_tasks is not None and self.by_tasks[robots].any() else self.name,
            **_named(self.limits, group, list(works)),
            needed=needed,
            available=available,
            unit=self.unit,
            left_out=_fewest(list(works.values()), lacking),
            more_robots=math.ceil(lacking / most * (1 - ROUNDING)) if most > 0 else len(own),
        )

    def _least(self, j: int) -> float:
        """The least work of a task, all members together: each works as long as the slowest, or pays its own cost."""
        problem = self.limits.problem
        count = problem.model.least_members(j)
        least = np.sort(self.work[self.limits.usable[:, j], j])[:count]
        if len(least) < count:
            return 0.0
        as_long = self.unit == _SECONDS or problem.in_time
        return float(least[-1] * count if as_long else least.sum())


def _one_of_each(problem: Problem, works: Mapping[int, float], tasks: Sequence[int]) -> Mapping[int, float]:
    """The works of tasks, of those that exclude each other the least; of sets with others of the tasks, none."""
    kept, chosen = dict(works), set(tasks)
    for alike in problem.model.alternatives:
        own = chosen.intersection(alike)
        least = min(own, key=lambda j: (works[j], j)) if own and own <= works.keys() else -1
        kept = {j: work for j, work in kept.items() if j == least or j not in own}
    return kept


_SECONDS = "robot-seconds"
_OF_TASKS = "time"


def _resources(limits: Limits, tasks: Sequence[int]) -> Iterator[_Resource]:
    problem, possible = limits.problem, limits.usable
    robots = range(len(problem.robots))
    seconds = np.array([problem.work_seconds(i) for i in robots])
    rules, start = problem.model, np.array([robot.available_from_s for robot in problem.robots])
    until = rules.over_by
    longest = seconds.max(axis=0, initial=0.0)  # a team takes as long as its slowest member
    last = np.array([_last_end(problem, [j for j in tasks if possible[i, j]], longest) for i in robots])
    has = np.maximum(0.0, np.minimum(until, last) - start)
    yield _Resource(rules.word_of("over_by") or _OF_TASKS, _SECONDS, limits, seconds, has, last < until)
    usage = seconds if problem.in_time else np.array([problem.work_usage(i) for i in robots])
    unit = _SECONDS if problem.in_time else problem.usage_unit
    if word := rules.word_of("capacity"):
        yield _Resource(word, unit, limits, usage, problem.capacity)
    if (word := rules.word_of("energy")) and not rules.refills:
        has = np.minimum(rules.energy_at_start, problem.capacity)
        yield _Resource(word, unit, limits, usage, has)


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
