"""Work on a task begins within one of its time windows."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import ClassVar

import numpy as np

from muster.mission.model import Robot, Task
from muster.model.parts import Parts
from muster.model.rules.latest import Later, Latest
from muster.model.rules.rule import Bools, Limits, Outlook, Question, Tried, first_task, listed
from muster.model.rules.times import known_least, longer, moments, reaches, span


@dataclass(frozen=True)
class LongerWindow(Later):
    """A later end of a task's last window."""

    of = "begin"
    limit_key = "closes_s"

    @property
    def short(self) -> str:
        return f"a window {longer(self.seconds)} longer"

    def of_several(self, whose: str, seconds: float) -> str:
        return f"windows of {whose} {longer(seconds)} longer"

    @property
    def line(self) -> str:
        return f"{self.short}, until {span(self.until_s or 0.0)}: {known_least(self.until_s, self.at_least_s)}"

    def task(self, task: Task, robot: Robot) -> Task:
        return _closing(task, self.until_s)


class Window(Latest):
    """The begin of the work is in one of `window_s`. A robot that is too early waits for the next one."""

    word: ClassVar[str] = "window"
    asked: ClassVar[Mapping[str, str]] = {"openings": "window"}
    key = "window"
    limits = ("openings", False)
    lifts = LongerWindow

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
        own = _closed(problem, j, "arrives at", float(limits.arrival[i, j]))
        waits = self._by_least_times(limits, i, j, limit=f"{_which(problem, j)}, which closes at")
        return own or waits or _never_together(problem, j)

    def _excludes(self, problem: Question, limits: Limits, i: int, j: int) -> str | None:
        return _closed(problem, j, *reaches(limits, i, j))

    def latest(self, problem: Question, i: int, j: int) -> float:
        windows = problem.model.openings[j]
        return windows[-1][1] if windows else math.inf

    def late(self, problem: Question, j: int, ready: float, end: float) -> str | None:
        return _closed(problem, j, "begins at", ready)

    def broken_at(self, tried: Tried) -> str:
        arrives, begins, _ = (min(times) for times in zip(*tried.stops, strict=True))
        own = _closed(tried.problem, tried.j, "arrives at", arrives) or self.late(tried.problem, tried.j, begins, 0.0)
        return own or self._others_late(tried) or "at no place in its route are all windows kept"

    def without_limit(self, tasks: tuple[Task, ...]) -> tuple[Task, ...]:
        return tuple(_closing(task, None) if task.window_s else task for task in tasks)

    def begun(self, task: Task, begun: Mapping[str, int]) -> Task:
        return replace(task, window_s=()) if task.id in begun else task


def _closing(task: Task, closes_s: float | None) -> Task:
    """The task with another end of its last window."""
    *before, (opens, _) = sorted(task.window_s, key=lambda window: window[0])
    return replace(task, window_s=(*before, (opens, closes_s)))


def _closed(problem: Question, j: int, how: str, ready: float) -> str | None:
    """That all windows of a task are closed by a time; None: one is not."""
    windows = problem.model.openings[j]
    if not windows or ready <= windows[-1][1]:
        return None
    at, closes = moments(problem, ready, windows[-1][1])
    return f"{how} {at} at the earliest, its {_which(problem, j)} closes at {closes}"


def _which(problem: Question, j: int) -> str:
    if problem.model.given_by("openings", j) not in ("", Window.word):
        return "last time to begin"
    return "window" if len(problem.model.openings[j]) == 1 else "last window"


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


def begun_between(task: Task, from_s: float, until_s: float) -> Task:
    """The task, to be begun in those of its windows, and the parts of them, that are between two times.

    It is the same task if none is.
    """
    spans = [(max(opens, from_s), closes) for opens, closes in task.window_s or ((0.0, None),)]
    ends = [(opens, min(math.inf if closes is None else closes, until_s)) for opens, closes in spans]
    left = tuple((opens, None if closes == math.inf else closes) for opens, closes in ends if opens <= closes)
    return replace(task, window_s=left) if left else task
