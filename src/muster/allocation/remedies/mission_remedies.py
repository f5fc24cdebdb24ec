"""Remedies of a mission whose work is proven to be too much: the least change of each sort that lifts all such proofs.

Each was tried: of the mission so changed no shortage of work is proven. That is no plan yet; where one was found and
judged the remedy says so. As a change that is too little for a plan stays so if it is made smaller, what was still
proven short is the bound below which no such change is enough.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, replace
from functools import partial

from muster.allocation.bounds.work_shortfall import Shortfall, shortfalls
from muster.mission.model import Robot
from muster.mission.texts.counting import counted
from muster.model.problem import Problem
from muster.model.rules import Rule
from muster.model.rules.latest import Later
from muster.model.rules.rule import listed

_MOST_ADDED = 12  # robots of a kind
_MOST_SEARCHES = 14  # of how much later limits have to be
_NEAR_ENOUGH = 0.02  # relative, of that
_DAY_S = 86_400.0  # by how much limits are moved at most
_MOST_NAMED = 6


@dataclass(frozen=True, kw_only=True)
class MissionRemedy:
    """A change of a mission with which no shortage of work is proven any more.

    Parameters
    ----------
    said
        the change in words.
    robots
        for each robot that is added the one that it is like; empty: none is.
    seconds, at_least_s
        by how much limits of time are later, and by how much less than no such change is enough; 0: none is changed.
    plan_found
        whether a plan of all tasks was found with it, and judged.
    """

    said: str
    robots: tuple[str, ...] = ()
    seconds: float = 0.0
    at_least_s: float = 0.0
    plan_found: bool = False


@dataclass(frozen=True, kw_only=True)
class Changed:
    """A remedy, and the problem with it."""

    remedy: MissionRemedy
    problem: Problem


def mission_remedies(
    problem: Problem, tasks: Sequence[int], short: Sequence[Shortfall], due: Callable[[], bool]
) -> Iterator[Changed]:
    """The least changes with which shortages of work are proven no more, a kind of robot and a kind of limit each.

    Parameters
    ----------
    tasks
        all that are to be done.
    short
        what is short as the mission is.
    due
        from when it says so nothing more is looked for.
    """
    if not problem.fixed:
        yield from filter(None, (_added(problem, tasks, i, due) for i in _kinds(problem, short)))
        for rule in problem.rules:
            if (found := _later(problem, tasks, short, rule, due)) is not None:
                yield found


# --- more robots -----------------------------------------------------------------------------------------------------


def _kinds(problem: Problem, short: Sequence[Shortfall]) -> list[int]:
    """A robot of each kind that shortages are about, by what it may do and how fast, the first of the mission."""
    if problem.mission.travel_rule == "matrix":
        return []  # whose ways are known of the robots of the mission alone
    named = {name for one in short for name in one.robots}
    order = [problem.robot_index[robot.id] for robot in problem.mission.robots if robot.id in named]
    first = dict[object, int]()
    for i in order:
        robot = problem.robots[i]
        first.setdefault((int(problem.kinds[i]), robot.speed_mps, robot.efficiency), i)
    return list(first.values())


def _added(problem: Problem, tasks: Sequence[int], i: int, due: Callable[[], bool]) -> Changed | None:
    """The fewest robots like robot i with which nothing is short; None: not with so many."""
    for count in range(1, _MOST_ADDED + 1):
        if due():
            return None
        more = _with_robots(problem, i, count)
        if not shortfalls(more, tasks):
            name = problem.robots[i].id
            said = f"{counted(count, 'more robot')} like {name}{_traits(problem, problem.robots[i])}"
            return Changed(remedy=MissionRemedy(said=said, robots=(name,) * count), problem=more)
    return None


def _traits(problem: Problem, robot: Robot) -> str:
    """What lets a robot do its tasks, in brackets."""
    traits = list(filter(None, (rule.trait(robot) for rule in problem.rules)))
    return f" ({listed(traits)})" if traits else ""


def _with_robots(problem: Problem, i: int, count: int) -> Problem:
    """The problem with more robots like one of it, at the same place."""
    taken = {*problem.robot_index, *problem.task_index}
    names = [f"more_{k}" for k in range(1, count + len(taken) + 1) if f"more_{k}" not in taken][:count]
    clones = tuple(replace(problem.robots[i], id=name) for name in names)
    n, m = len(problem.tasks), len(problem.robots)
    known = None
    if len(problem.travel[0]):
        robots = [*range(m), *[i] * count]
        stations = range(n + 2 * m, n + 2 * m + len(problem.stations))
        places = [*range(n), *(n + k for k in robots), *(n + m + k for k in robots), *stations]
        known = problem.measured.part(robots, places, range(n))
    mission = replace(problem.mission, robots=(*problem.mission.robots, *clones))
    return replace(problem, mission=mission, robots=(*problem.robots, *clones), known=known)


# --- later limits ----------------------------------------------------------------------------------------------------


def _later(
    problem: Problem, tasks: Sequence[int], short: Sequence[Shortfall], rule: Rule, due: Callable[[], bool]
) -> Changed | None:
    """By how much the limits of a rule, of all that is short, have to be later; None: that lifts nothing, or not all.

    The least is found by halving between what is still short and what is not.
    """
    limits = _Limits.of(problem, short, rule)
    if limits is None or due() or shortfalls(limits.moved(_DAY_S), tasks):
        return None
    least, enough = 0.0, _DAY_S
    tried = max(one.lacking / len(one.robots) for one in short)
    for _ in range(_MOST_SEARCHES):
        if due() or enough - least <= _NEAR_ENOUGH * enough:
            break
        seconds = math.ceil(tried * 100) / 100
        if shortfalls(limits.moved(seconds), tasks):
            least = seconds
        else:
            enough = seconds
        tried = 2 * least if enough == _DAY_S else (least + enough) / 2
    if enough == _DAY_S:
        return None  # time was up before
    remedy = MissionRemedy(said=limits.said(enough), seconds=enough, at_least_s=least)
    return Changed(remedy=remedy, problem=limits.moved(enough))


@dataclass(frozen=True)
class _Limits:
    """The limits of one rule, by robot and by task, that can be later."""

    problem: Problem
    of_robots: dict[int, Later]
    of_tasks: dict[int, Later]

    @classmethod
    def of(cls, problem: Problem, short: Sequence[Shortfall], rule: Rule) -> _Limits | None:
        """Return the limits of a rule of all that is short; None: there are none."""
        robots = [problem.robot_index[name] for name in dict.fromkeys(name for one in short for name in one.robots)]
        names = dict.fromkeys(name for one in short for name in (*one.tasks, *one.after))
        tasks = [problem.task_index[name] for name in names]
        some = partial(cls._some, problem, rule)
        of_robots = {i: later for i in robots if (later := some(i, tasks[0], of_robot=True)) is not None}
        of_tasks = {j: later for j in tasks if (later := some(robots[0], j, of_robot=False)) is not None}
        return cls(problem, of_robots, of_tasks) if of_robots or of_tasks else None

    @staticmethod
    def _some(problem: Problem, rule: Rule, i: int, j: int, *, of_robot: bool) -> Later | None:
        """The limit of a robot, or of a task, as a change; None: it has none."""
        change = rule.unlimited(problem, i, j)
        if not isinstance(change, Later):
            return None
        robot, task = problem.robots[i], problem.tasks[j]
        changes_it = change.robot(robot) != robot if of_robot else change.task(task, robot) != task
        return change if changes_it else None

    def moved(self, seconds: float) -> Problem:
        """The problem with limits that are so much later."""
        robots, tasks = list(self.problem.robots), list(self.problem.tasks)
        for i, limit in self.of_robots.items():
            robots[i] = replace(limit, until_s=limit.limit_s + seconds).robot(robots[i])
        for j, limit in self.of_tasks.items():
            tasks[j] = replace(limit, until_s=limit.limit_s + seconds).task(tasks[j], robots[0])
        by_id = {robot.id: robot for robot in robots}
        work = {task.id: task for task in tasks}
        old = self.problem.mission
        mission = replace(
            old,
            robots=tuple(by_id[robot.id] for robot in old.robots),
            tasks=tuple(work[task.id] for task in old.tasks),
        )
        return replace(
            self.problem, mission=mission, robots=tuple(robots), tasks=tuple(tasks), known=self.problem.measured
        )

    def said(self, seconds: float) -> str:
        """The change in words."""
        limit = next(iter((*self.of_robots.values(), *self.of_tasks.values())))
        robots = [self.problem.robots[i].id for i in self.of_robots]
        whose = listed(robots) if 0 < len(robots) <= _MOST_NAMED else counted(len(robots), "robot")
        return limit.of_several(whose if robots else counted(len(self.of_tasks), "task"), seconds)
