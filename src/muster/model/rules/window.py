"""Work on a task begins within one of its time windows."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import asdict, dataclass, replace
from typing import ClassVar

import numpy as np

from muster.mission.model import Robot, Task
from muster.model.parts import Parts
from muster.model.rules.rule import Bools, Change, Limits, Outlook, Question, Rule, first_task, listed
from muster.model.rules.times import known_least, longer, moments, reaches, rounded, span


@dataclass(frozen=True)
class LongerWindow(Change):
    """A later end of a task's last window.

    `until_s` is the new end, None without one; with an end before `at_least_s` no admissible plan does the task by the
    robot, the other changes made.
    """

    closes_s: float
    until_s: float | None
    at_least_s: float | None = None

    @property
    def plain(self) -> dict[str, float | None]:
        return asdict(self)

    @property
    def seconds(self) -> float:
        return math.inf if self.until_s is None else self.until_s - self.closes_s

    @property
    def short(self) -> str:
        return f"a window {longer(self.seconds)} longer"

    @property
    def line(self) -> str:
        return f"{self.short}, until {span(self.until_s or 0.0)}: {known_least(self.until_s, self.at_least_s)}"

    def task(self, task: Task, robot: Robot) -> Task:
        *before, (opens, _) = task.window_s
        return replace(task, window_s=(*before, (opens, self.until_s)))


class Window(Rule):
    """The begin of the work is in one of `window_s`. A robot that is too early waits for the next one."""

    word: ClassVar[str] = "window"
    asked: ClassVar[Mapping[str, str]] = {"openings": "window"}
    lifted_late = True
    key = "window"

    def asks(self, problem: Question) -> Mapping[str, str | None]:
        return {"window": first_task(problem, "window_s", lambda j: problem.model.openings[j])}

    def compile(self, problem: Question, parts: Parts) -> None:
        for j, task in enumerate(problem.tasks):
            if task.window_s:
                parts.opens(j, task.window_s)

    def possible(self, limits: Limits) -> Bools | None:
        return np.isfinite(limits.pair_begin) if limits.is_timed else None

    def never(self, problem: Question, i: int, j: int, outlook: Outlook) -> str | None:
        limits = outlook.limits
        if not limits.is_timed or math.isfinite(limits.pair_begin[i, j]):
            return None
        own = closed(problem, j, "arrives at", float(limits.arrival[i, j]))
        return own or _waits_too_long(limits, i, j) or _never_together(problem, j)


def closed(problem: Question, j: int, how: str, ready: float) -> str | None:
    """That all windows of a task are closed by a time; None: one is not."""
    windows = problem.model.openings[j]
    if not windows or ready <= windows[-1][1]:
        return None
    at, closes = moments(problem, ready, windows[-1][1])
    return f"{how} {at} at the earliest, its {_which(windows)} closes at {closes}"


def _waits_too_long(limits: Limits, i: int, j: int) -> str | None:
    """That the last window of a task is closed when all is there that it waits for; None: it is not."""
    problem = limits.problem
    if closed(problem, j, *reaches(limits, i, j)) is None:
        return None
    free = limits.without(Window.word, j)
    late = None if free is None else closed(problem, j, *reaches(free, i, j))
    windows = problem.model.openings[j]
    (closes,) = moments(problem, windows[-1][1])
    return late or f"what it waits for is too late for its {_which(windows)}, which closes at {closes}"


def _which(windows: Sequence[tuple[float, float]]) -> str:
    return "window" if len(windows) == 1 else "last window"


def _never_together(problem: Question, j: int) -> str:
    """That tasks which begin together have no window in common from when they are ready."""
    unit = problem.model.units[problem.model.unit[j]]
    names = listed([problem.tasks[k].id for k in unit if k != j])
    windows = listed([_windows(problem, k) for k in unit if problem.model.openings[k]])
    return f"begins together with {names}, and from when all are ready no window is open to all: {windows}"


def _windows(problem: Question, j: int) -> str:
    """When a task may begin."""
    said = (
        f"from {moments(problem, opens)[0]}" + (f" to {moments(problem, closes)[0]}" if math.isfinite(closes) else "")
        for opens, closes in problem.model.openings[j]
    )
    return f"{problem.tasks[j].id} {' or '.join(said)}"


def waits_until(opens_s: float) -> str:
    """What a robot waits for at a task that may not begin yet."""
    return f"waits for window: opens at {rounded(opens_s)}"


def is_closed(closed_s: float) -> str:
    """Why a task can never begin any more."""
    return f"window: closed at {rounded(closed_s)}"


def next_opens(closed_s: float, opens_s: float) -> str:
    """Why a task does not begin when it was meant to, and when it may instead."""
    return f"window: closed at {closed_s:,g} s; the next is open from {opens_s:,g} s on"


def would_be_closed(arrive_s: float) -> str:
    """Why a robot cannot do a task at which it would arrive at a time."""
    return f"window: would arrive at {arrive_s:,.1f} s, after it has closed"


def begun_between(task: Task, from_s: float, until_s: float) -> Task:
    """The task, to be begun in those of its windows, and the parts of them, that are between two times.

    It is the same task if none is.
    """
    spans = [(max(opens, from_s), closes) for opens, closes in task.window_s or ((0.0, None),)]
    ends = [(opens, min(math.inf if closes is None else closes, until_s)) for opens, closes in spans]
    left = tuple((opens, None if closes == math.inf else closes) for opens, closes in ends if opens <= closes)
    return replace(task, window_s=left) if left else task
