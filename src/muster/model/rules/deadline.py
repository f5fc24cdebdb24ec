"""Work on a task ends by its deadline."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import asdict, dataclass, replace
from typing import ClassVar

import numpy as np

from muster.mission.model import Robot, Task
from muster.model.parts import Parts
from muster.model.rules.rule import (
    ROUNDING,
    Bools,
    Change,
    Limits,
    Outlook,
    Question,
    Rule,
    first_task,
)
from muster.model.rules.times import known_least, longer, moments, rounded, span


@dataclass(frozen=True)
class LaterDeadline(Change):
    """A later deadline of a task: `until_s`, None without one; before `at_least_s` no admissible plan is enough."""

    deadline_s: float
    until_s: float | None
    at_least_s: float | None = None

    @property
    def plain(self) -> dict[str, float | None]:
        return asdict(self)

    @property
    def seconds(self) -> float:
        return math.inf if self.until_s is None else self.until_s - self.deadline_s

    @property
    def short(self) -> str:
        return f"a deadline {longer(self.seconds)} later"

    @property
    def line(self) -> str:
        return f"{self.short}, at {span(self.until_s or 0.0)}: {known_least(self.until_s, self.at_least_s)}"

    def task(self, task: Task, robot: Robot) -> Task:
        return replace(task, deadline_s=self.until_s)


class Deadline(Rule):
    """The end of the work is at most `deadline_s`."""

    word: ClassVar[str] = "deadline"
    asked: ClassVar[Mapping[str, str]] = {"ends_by": "deadline"}
    lifted_late = True
    key = "deadline"

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
        limits = outlook.limits
        if not limits.is_timed or too_late(problem, j, float(limits.pair_end[i, j])) is None:
            return None
        free = limits.without(self.word, j)
        (until,) = moments(problem, float(problem.model.ends_by[j]))
        late = None if free is None else too_late(problem, j, float(free.pair_end[i, j]))
        return late or f"what it waits for is too late for its deadline, which is {until}"


def too_late(problem: Question, j: int, end: float) -> str | None:
    """That work on a task which ends at a time is too late; None: it is not."""
    deadline = float(problem.model.ends_by[j])
    if math.isinf(end) or end <= deadline * (1 + ROUNDING):
        return None
    ends, until = moments(problem, end, deadline)
    return f"ends at {ends} at the earliest, its deadline is {until}"


def is_over(by_s: float) -> str:
    """Why a task can never end in time any more."""
    return f"deadline: {rounded(by_s)} is over"


def would_end_late(ends_s: float, by_s: float) -> str:
    """Why a robot cannot do a task that would end at a time."""
    return f"deadline: would end at {ends_s:,.1f} s, after {by_s:,g} s"
