"""Of tasks that stand for each other at most one is done."""

from __future__ import annotations

from collections.abc import Mapping
from itertools import combinations
from typing import ClassVar

from muster.mission.task_relations import IN_ITS_PLACE, alternatives_of
from muster.model.parts import Parts
from muster.model.rules.rule import InPlan, Question, Rule, first_task


class EitherOr(Rule):
    """Of tasks tied by `either_or`, directly or through others, at most one is in the plan."""

    word: ClassVar[str] = "either-or"
    about_one = False
    asked: ClassVar[Mapping[str, str]] = {"exclusive": "either-or"}

    def asks(self, problem: Question) -> Mapping[str, str | None]:
        return {"either-or": first_task(problem, "either_or", lambda j: problem.model.exclusive[j])}

    def compile(self, problem: Question, parts: Parts) -> None:
        for names in alternatives_of(problem.tasks):
            for one, other in combinations(names, 2):
                parts.exclude(problem.task_index[one], problem.task_index[other])

    def left_out(self, plan: InPlan, i: int, j: int) -> str | None:
        problem = plan.problem
        done = [problem.tasks[k].id for k in problem.model.exclusive[j] if k in plan.done]
        return f"{done[0]} is {IN_ITS_PLACE}" if done else None
