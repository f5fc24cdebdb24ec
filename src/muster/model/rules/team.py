"""A task with `robots_needed`, `team` or `needs` is done by as many robots, or by robots as able, as it needs."""

from __future__ import annotations

import math
from collections.abc import Collection, Hashable, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any, ClassVar

import numpy as np

from muster.mission.model import Mission, Robot, Task, TeamPart
from muster.mission.texts.near_matches import did_you_mean
from muster.model.bottleneck import fills, matched, on_some_matching
from muster.model.parts import Parts
from muster.model.rules.rule import ROUNDING, Bools, Change, InPlan, Limits, Outlook, Question, Rule, listed

_MOST_NAMED, _MOST_ADDED = 4, 10


@dataclass(frozen=True)
class MoreRobots(Change):
    """Robots that there would have to be beside those of the mission, each like one of it or as a part asks for."""

    robots: tuple[Robot, ...]
    said: str

    @property
    def plain(self) -> list[dict[str, Any]]:
        keys = ("id", "type", "kind", "skills", "abilities", "position")
        return [{key: getattr(robot, key) for key in keys} for robot in self.robots]

    @property
    def short(self) -> str:
        return self.said

    def mission(self, mission: Mission) -> Mission:
        return replace(mission, robots=(*mission.robots, *self.robots))


class Team(Rule):
    """The robot is fit for a part of the team, and the others that may be in it are enough."""

    word: ClassVar[str] = "team"
    about_one = False
    asked: ClassVar[Mapping[str, str]] = {"seats": "team", "sums": "team"}
    key = "team"

    def compile(self, problem: Question, parts: Parts) -> None:
        everybody = np.ones(len(problem.robots), np.bool_)
        skills = problem.holds("skill")
        for j, task in enumerate(problem.tasks):
            if not task.is_for_team:
                continue
            for name, needed in (task.needs or {}).items():
                parts.sum_up(j, name, needed, np.array([_ability(robot, name) for robot in problem.robots]))
            if task.team:
                parts.seat(
                    j, [(p.count, np.array([p.fits(r, skills=skills) for r in problem.robots])) for p in task.team]
                )
            elif not task.needs:
                parts.seat(j, [(task.robots_needed or 1, everybody)])

    def kinds(self, problem: Question) -> Sequence[Hashable] | None:
        if not problem.model.with_teams:
            return None
        return [problem.model.in_team(i) for i in range(len(problem.robots))]

    def refusal(self, problem: Question, i: int, j: int) -> str | None:
        rules = problem.model
        if not rules.is_for_team(j) or rules.sums(j):
            return None
        if any(fits[i] for _, fits in rules.seats(j)):
            return None
        return f"fits no part of the team: {needed(problem.tasks[j])}"

    def possible(self, limits: Limits) -> Bools | None:
        if not limits.rules.with_teams:
            return None
        possible = np.ones_like(limits.usable)
        for j in filter(limits.rules.is_for_team, range(possible.shape[1])):
            possible[:, j] = in_some_team(limits.problem, j, limits.alone[:, j])
        return possible

    def never(self, problem: Question, i: int, j: int, outlook: Outlook) -> str | None:
        refused = self.refusal(problem, i, j)
        if refused or not problem.model.is_for_team(j):
            return refused
        return shortfall(problem, i, j, outlook.limits.alone[:, j])

    def left_out(self, plan: InPlan, i: int, j: int) -> str | None:
        problem = plan.problem
        refused = self.refusal(problem, i, j)
        if refused or not problem.model.is_for_team(j):
            return refused
        allowed = np.array([problem.may(k, j) for k in range(len(problem.robots))], dtype=np.bool_)
        return shortfall(problem, i, j, allowed) or plan.kept_out(self.word, i, j)

    def lifted(self, problem: Question, i: int, j: int, done: Collection[int]) -> MoreRobots | None:
        """With the robots that a team with robot i in it lacks."""
        return _missing_robots(problem, i, j, {*problem.task_index, *(robot.id for robot in problem.robots)})

    def begun(self, task: Task, begun: Mapping[str, int]) -> Task:
        if task.id not in begun:
            return task
        robots = begun[task.id] if task.is_for_team else task.robots_needed
        return replace(task, robots_needed=robots, team=(), needs=None)


def in_some_team(problem: Question, j: int, able: Bools) -> Bools:
    """(m,) which of the robots that are able are in some team for a task."""
    rules = problem.model
    if rules.sums(j):
        enough = all(abilities[able].sum() >= needed * (1 - ROUNDING) for needed, abilities in rules.sums(j).values())
        return able if enough else np.zeros_like(able)
    return np.asarray(on_some_matching(_places(problem, j, able)).any(axis=0))


def shortfall(problem: Question, i: int, j: int, able: Bools) -> str | None:
    """Why the robots that are able are no team for a task with robot i in it; None: they are enough."""
    rules = problem.model
    if not rules.is_for_team(j) or in_some_team(problem, j, able)[i]:
        return None
    names = [problem.robots[k].id for k in np.flatnonzero(able)]
    wanted = f"needs {needed(problem.tasks[j])}"
    if rules.sums(j):
        sums = ", ".join(f"{name} {float(who[able].sum()):g}" for name, (_, who) in rules.sums(j).items())
        return f"{wanted}; all who can be there have {sums} together{_like_others(problem, j)}"
    if not fills(_places(problem, j, able)):
        return f"{wanted}; {_who(names)}"
    return f"{wanted}; with it one place stays empty"


def _like_others(problem: Question, j: int) -> str:
    """Of the abilities that a task needs and no robot has, whether one that a robot has is spelt much like it."""
    known = sorted({name for robot in problem.robots for name in robot.abilities or ()})
    return "".join(did_you_mean(name, known) for name in problem.tasks[j].needs or () if name not in known)


def needed(task: Task) -> str:
    """What team a task needs, in a few words."""
    if task.needs:
        return ", ".join(f"{name} {value:g}" for name, value in task.needs.items())
    if task.team:
        return " and ".join(_part(part) for part in task.team)
    having = f" with {listed(task.requires)}" if task.requires else ""
    return f"{task.robots_needed} robots{having}"


def _part(part: TeamPart) -> str:
    kind = " ".join(filter(None, (part.kind and f"of kind {part.kind}", part.type and f"of type {part.type}")))
    having = f"with {listed(part.requires)}" if part.requires else ""
    return " ".join(filter(None, (str(part.count), kind, having)))


def _who(names: Sequence[str]) -> str:
    if not names:
        return "no robot can be there"
    if len(names) == 1:
        return f"{names[0]} alone can be there"
    more = f" and {len(names) - _MOST_NAMED} more" if len(names) > _MOST_NAMED else ""
    return f"only {listed(names[:_MOST_NAMED])}{more} can be there"


def _places(problem: Question, j: int, able: Bools) -> Bools:
    """(places, m) which robots fit where."""
    rows = [fits & able for count, fits in problem.model.seats(j) for _ in range(count)]
    return np.array(rows, dtype=np.bool_)


def _missing_robots(problem: Question, i: int, j: int, names: set[str]) -> MoreRobots | None:
    """Robots that a team of a task with robot i in it lacks; None: none, or no such robot can be made up."""
    rules, task, robot = problem.model, problem.tasks[j], problem.robots[i]
    able = np.array([problem.may(k, j) for k in range(len(problem.robots))], dtype=np.bool_)
    if not rules.is_for_team(j) or not able[i] or in_some_team(problem, j, able)[i]:
        return None
    if problem.mission.travel_rule == "matrix":
        return None  # whose ways are known of the robots of the mission alone
    if task.needs is not None:
        return _as_able(problem, i, j, able, names)
    owner = matched(_places(problem, j, able))
    parts = [part for part in task.team or (TeamPart(count=task.robots_needed or 1),) for _ in range(part.count)]
    empty = [part for place, part in enumerate(parts) if place not in owner.values()]
    more = tuple(_fit_for(robot, part, _new_name(names, k)) for k, part in enumerate(empty))
    kinds = {_like(robot, part): sum(_like(robot, other) == _like(robot, part) for other in empty) for part in empty}
    return MoreRobots(more, f"{listed([_more(count, kind) for kind, count in kinds.items()])}") if more else None


def _as_able(problem: Question, i: int, j: int, able: Bools, names: set[str]) -> MoreRobots | None:
    """As many robots like robot i as make up for the abilities that are lacking, if it has all of these."""
    count = 0
    for needed_, abilities in problem.model.sums(j).values():
        lacking = needed_ - float(abilities[able].sum())
        if lacking > needed_ * ROUNDING and abilities[i] <= 0:
            return None
        if lacking > needed_ * ROUNDING:
            count = max(count, math.ceil(lacking / float(abilities[i]) * (1 - ROUNDING)))
    robot = problem.robots[i]
    more = tuple(replace(robot, id=_new_name(names, k)) for k in range(count))
    return MoreRobots(more, _more(count, f"like {robot.id}")) if 0 < count <= _MOST_ADDED else None


def _fit_for(robot: Robot, part: TeamPart, name: str) -> Robot:
    """A robot like another, as a part asks for."""
    skills = tuple(dict.fromkeys((*robot.skills, *part.requires)))
    return replace(robot, id=name, type=part.type or robot.type, kind=part.kind or robot.kind, skills=skills)


def _like(robot: Robot, part: TeamPart) -> str:
    asked = _part(replace(part, count=1))[2:]
    return asked or f"like {robot.id}"


def _more(count: int, kind: str) -> str:
    return f"one more robot {kind}" if count == 1 else f"{count} more robots {kind}"


def _new_name(names: set[str], k: int) -> str:
    """An id that nothing of the mission has."""
    number = k
    while f"more_{number}" in names:
        number += 1
    names.add(f"more_{number}")
    return f"more_{number}"


def _ability(robot: Robot, name: str) -> float:
    """How much of an ability a robot has."""
    return float((robot.abilities or {}).get(name, 0.0))


def waits_for_team(who: str) -> str:
    """What the robots wait for that are at a task already."""
    return f"waits for team: {who}"


def waits_to_start_with(other: str, who: str) -> str:
    """What robots wait for at a task that begins together with another."""
    return f"waits for start with {other}: {who}"


def missing_of_seat(task: Task, seat: int, missing: int) -> str:
    """What so many robots lack that sit in none of the places of a sort."""
    if not task.team:
        return f"{missing} more robot{'s' if missing > 1 else ''}"
    part = task.team[seat]
    sort = " ".join(word for word in (part.kind, part.type) if word) or "robot"
    return f"one more {sort}{f' with {listed(part.requires)}' if part.requires else ''}"


def by_so_many(task: Task, count: int) -> Task:
    """The task, done by so many robots instead of by any that are able enough."""
    return task if task.needs is None else replace(task, needs=None, robots_needed=count)
