"""Work on a task ends by its deadline."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import ClassVar

import numpy as np

from muster.mission.model import Robot, Task
from muster.model.parts import Parts
from muster.model.rules.latest import Later, Latest
from muster.model.rules.rule import ROUNDING, Bools, Limits, Outlook, Question, Tried, first_task
from muster.model.rules.times import known_least, longer, moments, span


@dataclass(frozen=True)
class LaterDeadline(Later):
    """A later deadline of a task."""

    of = "end"
    limit_key = "deadline_s"

    @property
    def short(self) -> str:
        return f"a deadline {longer(self.seconds)} later"

    def of_several(self, whose: str, seconds: float) -> str:
        return f"deadlines of {whose} {longer(seconds)} later"

    @property
    def line(self) -> str:
        return f"{self.short}, at {span(self.until_s or 0.0)}: {known_least(self.until_s, self.at_least_s)}"

    def task(self, task: Task, robot: Robot) -> Task:
        return replace(task, deadline_s=self.until_s)


class Deadline(Latest):
    """The end of the work is at most `deadline_s`."""

    word: ClassVar[str] = "deadline"
    asked: ClassVar[Mapping[str, str]] = {"ends_by": "deadline"}
    key = "deadline"
    limits = ("ends_by", False)
    lifts = LaterDeadline
    resource = ("time", "time before the last deadline")

    def asks(self, problem: Question) -> Mapping[str, str | None]:
        deadline = problem.model.ends_by
        return {"deadline": first_task(problem, "deadline_s", lambda j: np.isfinite(deadline[j]))}

    def compile(self, problem: Question, parts: Parts) -> None:
        for j, task in enumerate(problem.tasks):
            if task.deadline_s is not None:
                parts.ends(j, task.deadline_s)

    def possible(self, limits: Limits) -> Bools | None:
        if not limits.is_timed:
            return None
        return np.asarray(limits.pair_end <= limits.rules.ends_by * (1 + ROUNDING))

    def never(self, problem: Question, i: int, j: int, outlook: Outlook) -> str | None:
        return self._by_least_times(outlook.limits, i, j, limit="deadline, which is")

    def _excludes(self, problem: Question, limits: Limits, i: int, j: int) -> str | None:
        return self.late(problem, j, 0.0, float(limits.pair_end[i, j]))

    def latest(self, problem: Question, i: int, j: int) -> float:
        return float(problem.model.ends_by[j])

    def late(self, problem: Question, j: int, ready: float, end: float) -> str | None:
        deadline = float(problem.model.ends_by[j])
        if math.isinf(end) or end <= deadline * (1 + ROUNDING):
            return None
        ends, until = moments(problem, end, deadline)
        own = problem.model.given_by("ends_by", j) in ("", self.word)
        return f"ends at {ends} at the earliest, its {'deadline' if own else 'latest end'} is {until}"

    def broken_at(self, tried: Tried) -> str:
        own = self.late(tried.problem, tried.j, 0.0, min(end for _, _, end in tried.stops))
        return own or self._others_late(tried) or "at no place in its route are all deadlines kept"

    def begun(self, task: Task, begun: Mapping[str, int]) -> Task:
        return replace(task, deadline_s=None) if task.id in begun else task
