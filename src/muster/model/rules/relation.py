"""Relations between tasks: by the same robots, by others, or beginning together."""

from __future__ import annotations

from collections.abc import Collection, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any, ClassVar

import numpy as np

from muster.mission.model import Robot, Task
from muster.mission.task_relations import RELATIONS
from muster.model.bottleneck import on_some_matching
from muster.model.parts import Parts
from muster.model.rules.rule import Bools, Change, InPlan, Limits, Outlook, Question, Rule, listed

_RELATIONS = ("same_robot_as", "other_robot_than", "starts_with")


@dataclass(frozen=True)
class Untied(Change):
    """The relations to other tasks of which a task would have to be free."""

    relations: tuple[tuple[str, str], ...]

    @property
    def plain(self) -> list[dict[str, str]]:
        return [{"relation": relation, "task": task} for relation, task in self.relations]

    @property
    def short(self) -> str:
        return f"without {listed([f'{relation} {task}' for relation, task in self.relations])}"

    def task(self, task: Task, robot: Robot) -> Task:
        return self._without(task, self.relations)

    def other(self, other: Task, task: Task) -> Task:
        return self._without(other, [(relation, task.id) for relation, name in self.relations if name == other.id])

    @staticmethod
    def _without(task: Task, relations: Sequence[tuple[str, str]]) -> Task:
        for relation, name in relations:
            left: Any = tuple(one for one in getattr(task, relation) if one != name)
            task = replace(task, **{relation: left})
        return task


class Relation(Rule):
    """`same_robot_as` and `other_robot_than` bind when both tasks are done; of `starts_with` both are, or neither."""

    word: ClassVar[str] = "relation"
    about_one = False
    asked: ClassVar[Mapping[str, str]] = {"same_crew": "relation", "apart": "relation", "together": "starts-with"}
    asked_by: ClassVar[Mapping[str, str]] = {
        "same_crew": "same_robot_as",
        "apart": "other_robot_than",
        "together": "starts_with",
    }
    key = "relation"

    def compile(self, problem: Question, parts: Parts) -> None:
        """Of a part of a mission not all tasks are there, and then nothing is tied."""
        ties = {"same_crew": parts.by_one_crew, "apart": parts.by_others, "together": parts.begin_together}
        for j, task in enumerate(problem.tasks):
            for part, tie in ties.items():
                for name in getattr(task, self.asked_by[part]):
                    if name in problem.task_index:
                        tie(j, problem.task_index[name])

    def possible(self, limits: Limits) -> Bools | None:
        if not limits.rules.with_relations:
            return None
        possible = np.ones_like(limits.usable)
        for j in range(possible.shape[1]):
            for k in limits.must_also(j):
                possible[:, j] &= self._beside(limits, j, k)
        for unit in filter(lambda unit: len(unit) > 1, limits.rules.units):
            for j, row in _different(limits, unit).items():
                possible[:, j] &= row
        return possible

    def never(self, problem: Question, i: int, j: int, outlook: Outlook) -> str | None:
        limits = outlook.limits
        if not limits.rules.with_relations:
            return None
        if outlook.lost_before and outlook.lost_before not in problem.tasks[j].prerequisites:
            return f"begins together with {outlook.lost_before}, which can never be done"
        for k in limits.must_also(j):
            if not self._beside(limits, j, k)[i]:
                name = problem.tasks[k].id
                if k in limits.rules.same_crew[j]:
                    return f"the same robot must do {name}, which comes with it, and cannot be {problem.robots[i].id}"
                return f"another robot must do {name}, which comes with it, and only {problem.robots[i].id} can"
        unit = limits.rules.units[limits.rules.unit[j]]
        if len(unit) == 1 or _different(limits, unit)[j][i]:
            return None
        names = listed([problem.tasks[k].id for k in unit if k != j])
        return f"begins together with {names}, for which no different robots are left"

    def left_out(self, plan: InPlan, i: int, j: int) -> str | None:
        problem, rules = plan.problem, plan.problem.model
        for k in rules.same_crew[j]:
            if plan.members(k) and i not in plan.members(k):
                by = listed([problem.robots[m].id for m in plan.members(k)])
                return f"the same robot must do {problem.tasks[k].id}, and {by} does it"
        for k in rules.apart[j]:
            if i in plan.members(k):
                return f"another robot must do {problem.tasks[k].id}, which is in its route"
        return plan.kept_out(self.word, i, j)

    def lifted(self, problem: Question, i: int, j: int, done: Collection[int]) -> Untied | None:
        """Without its relations to tasks that are done, or begin with it."""
        names = {problem.tasks[k].id for k in {*done, *problem.model.beginning_with(j)}}
        task = problem.tasks[j]
        found = [(key, name) for key in _RELATIONS for name in getattr(task, key) if name in names]
        found += [
            (key, other.id)
            for other in problem.mission.tasks
            for key in _RELATIONS
            if other.id in names and task.id in getattr(other, key)
        ]
        return Untied(tuple(dict.fromkeys(found))) if found else None

    def begun(self, task: Task, begun: Mapping[str, int]) -> Task:
        """What began at a time of its own keeps no other to that time; who does it is known."""
        if task.id not in begun:
            return replace(task, starts_with=tuple(name for name in task.starts_with if name not in begun))
        left: Any = {key: tuple(name for name in getattr(task, key) if name not in begun) for key in _RELATIONS}
        return replace(task, **{**left, "starts_with": ()})

    @staticmethod
    def _beside(limits: Limits, j: int, k: int) -> Bools:
        """(m,) which robots can do task j as far as its relations to task k, which is done too, tell."""
        others = limits.usable[:, k]
        if k in limits.rules.same_crew[j]:
            return others
        if k in limits.rules.apart[j] and int(others.sum()) == 1:
            return ~others
        return np.ones_like(others)


def _different(limits: Limits, unit: list[int]) -> dict[int, Bools]:
    """For each task of a unit the robots that can do it while different ones do the others."""
    rules = limits.rules
    tasks, fits = rules.places(rules.unit[unit[0]])
    able = on_some_matching(fits & limits.alone.T[tasks])
    return {j: np.asarray(able[[k for k, task in enumerate(tasks) if task == j]].any(axis=0)) for j in unit}


def tied_among(task: Task, there: Collection[str]) -> Task:
    """The task, with only those ties that are to tasks that are there."""
    if not any(getattr(task, key) for key in RELATIONS):
        return task
    left: dict[str, Any] = {key: tuple(name for name in getattr(task, key) if name in there) for key in RELATIONS}
    return task if all(left[key] == getattr(task, key) for key in RELATIONS) else replace(task, **left)


def tied_to(same: Mapping[str, Collection[str]], others: Mapping[str, Collection[str]]) -> str:
    """Whom robots leave to a task that have done tasks which the same robots do, or others; empty: all."""
    said = [f"same robot as {name} ({listed(crew)})" for name, crew in same.items()]
    said += [f"other robot than {name} ({listed(crew)})" for name, crew in others.items()]
    return f"relation: {listed(said)}" if said else ""
