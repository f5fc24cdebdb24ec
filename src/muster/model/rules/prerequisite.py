"""A task is in the plan only together with its prerequisites, and nothing waits in a circle."""

from __future__ import annotations

from collections.abc import Collection, Mapping
from dataclasses import replace
from typing import ClassVar

import numpy as np

from muster.mission.model import Task
from muster.model.parts import Parts
from muster.model.rules.rule import (
    Bools,
    InPlan,
    Limits,
    Outlook,
    Question,
    Rule,
    Tried,
    first_task,
    listed,
)


class Prerequisite(Rule):
    """All prerequisites of a task are in the plan, and can be done before it."""

    word: ClassVar[str] = "prerequisite"
    asked: ClassVar[Mapping[str, str]] = {"bounded": "lag"}

    def asks(self, problem: Question) -> Mapping[str, str | None]:
        lags = problem.model.gaps
        lagged = [any(after or np.isfinite(within) for _, after, within in lags(j)) for j in range(len(problem.tasks))]
        return {"lag": first_task(problem, "prerequisites with after_s or within_s", lambda j: lagged[j])}

    def compile(self, problem: Question, parts: Parts) -> None:
        for j, task in enumerate(problem.tasks):
            for name in task.prerequisites:
                lag = task.lags.get(name)
                after_s, within_s = (lag.after_s, lag.within_s) if lag else (0.0, None)
                parts.follows(j, problem.task_index[name], after_s, np.inf if within_s is None else within_s)

    def possible(self, limits: Limits) -> Bools | None:
        if not limits.held_back:
            return None
        possible = np.ones_like(limits.usable)
        possible[:, list(limits.held_back)] = False
        return possible

    def blamed(self, limits: Limits, i: int, j: int) -> str:
        return limits.held_back[j].word

    def never(self, problem: Question, i: int, j: int, outlook: Outlook) -> str | None:
        if outlook.lost_before not in problem.tasks[j].prerequisites:
            held = outlook.limits.held_back.get(j)
            return None if held is None else held.said
        return f"{outlook.lost_before} comes before it and can never be done"

    def left_out(self, plan: InPlan, i: int, j: int) -> str | None:
        missing = [plan.problem.tasks[k].id for k in plan.problem.prerequisites[j] if k not in plan.done]
        if missing:
            return f"left out before it: {listed(missing)}"
        if plan.is_timed:
            return plan.kept_out(self.word, i, j)
        if plan.insertion(i, j) is None:
            return "at every place in its route the prerequisites would wait in a circle"
        return None

    def without_limit(self, tasks: tuple[Task, ...]) -> tuple[Task, ...]:
        """With tasks that may begin however long after others."""
        lags = [{name: replace(lag, within_s=None) for name, lag in task.lags.items()} for task in tasks]
        return tuple(replace(task, lags=own) for task, own in zip(tasks, lags, strict=True))

    def broken_at(self, tried: Tried) -> str:
        return "at every place in its route a task would begin longer after its prerequisite than within_s allows"

    def begun(self, task: Task, begun: Mapping[str, int]) -> Task:
        return task.waiting_for(()) if task.id in begun else task


def waits_for_dependants(names: Collection[str]) -> str:
    """What a robot waits for at a task after which others must begin soon."""
    return f"waits so that {listed(names)} can begin in time after it"
