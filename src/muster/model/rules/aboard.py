"""What a task delivers is on board for no longer than the task says."""

from __future__ import annotations

from collections.abc import Mapping
from typing import ClassVar

from muster.model.parts import Parts
from muster.model.rules.rule import Question, Rule, first_task


class Aboard(Rule):
    """A task that delivers begins at most `longest_aboard_s` after the end of the task whose load it delivers."""

    word: ClassVar[str] = "aboard"
    asked = ("aboard",)
    lifted_late = True

    def asks(self, problem: Question) -> Mapping[str, str | None]:
        limited = [self._limit_s(problem, j) is not None for j in range(len(problem.tasks))]
        return {"aboard": first_task(problem, "longest_aboard_s", lambda j: limited[j])}

    def compile(self, problem: Question, parts: Parts) -> None:
        for j, task in enumerate(problem.tasks):
            most_s = self._limit_s(problem, j)
            if most_s is not None and task.delivers is not None:
                parts.follows(j, problem.task_index[task.delivers], most_s=most_s)

    def _limit_s(self, problem: Question, j: int) -> float | None:
        """How long what a task delivers may be on board; of no load, where loads are ignored, nothing is said."""
        task = problem.tasks[j]
        carries = problem.holds("load") and task.delivers in problem.task_index
        return task.longest_aboard_s if carries and problem.holds(self.word) else None
