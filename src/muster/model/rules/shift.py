"""A robot drives and works in its shifts alone; its route, the way to its end included, ends by the last one's end."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import asdict, dataclass, replace
from typing import ClassVar

import numpy as np

from muster.mission.model import Robot
from muster.model.parts import Parts
from muster.model.rules.rule import (
    ROUNDING,
    Bools,
    Change,
    Limits,
    Outlook,
    Question,
    Rule,
    first_robot,
)
from muster.model.rules.times import known_least, longer, moments


@dataclass(frozen=True)
class LongerShift(Change):
    """A later end of a robot's shift: `until_s`, None without one; before `at_least_s` no admissible plan is enough.

    `said` is the new end in words.
    """

    available_until_s: float
    until_s: float | None
    at_least_s: float | None = None
    said: str = ""

    @property
    def plain(self) -> dict[str, float | None]:
        return {name: value for name, value in asdict(self).items() if name != "said"}

    @property
    def seconds(self) -> float:
        return math.inf if self.until_s is None else self.until_s - self.available_until_s

    @property
    def short(self) -> str:
        return f"a shift until {self.said}"

    @property
    def line(self) -> str:
        return f"{self.short}, {longer(self.seconds)} longer: {known_least(self.until_s, self.at_least_s)}"

    def robot(self, robot: Robot) -> Robot:
        return with_end(robot, self.until_s)


class Shift(Rule):
    """The end of the route is at most `available_until_s`; legs and work are each within one of `shifts_s`, if any."""

    word: ClassVar[str] = "shift"
    asked: ClassVar[Mapping[str, str]] = {"over_by": "shift", "spans": "rests"}
    lifted_late = True
    key = "shift"

    def asks(self, problem: Question) -> Mapping[str, str | None]:
        until, spans = problem.model.over_by, problem.model.spans
        return {
            "shift": first_robot(problem, "available_until_s", lambda i: np.isfinite(until[i])),
            "rests": first_robot(problem, "shifts_s", spans),
        }

    def compile(self, problem: Question, parts: Parts) -> None:
        for i, robot in enumerate(problem.robots):
            if robot.available_until_s is not None:
                parts.is_over(i, robot.available_until_s)
            if robot.shifts_s:  # the end of the last one is that of the route
                parts.rests(i, (*robot.shifts_s[:-1], (robot.shifts_s[-1][0], None)))

    def possible(self, limits: Limits) -> Bools | None:
        if not limits.is_timed:
            return None
        until = limits.rules.over_by[:, None]
        return np.asarray(limits.over <= until * (1 + ROUNDING))

    def never(self, problem: Question, i: int, j: int, outlook: Outlook) -> str | None:
        limits = outlook.limits
        if not limits.is_timed or beyond(problem, i, float(limits.over[i, j])) is None:
            return None
        free = limits.without(self.word, i)
        (until,) = moments(problem, float(problem.model.over_by[i]))
        late = None if free is None else beyond(problem, i, float(free.over[i, j]))
        return late or f"what it waits for is too late for its shift, which ends at {until}"


def with_end(robot: Robot, until_s: float | None) -> Robot:
    """Return the robot with another end of its only shift, or of its last one."""
    last = tuple((begins, until_s) for begins, _ in robot.shifts_s[-1:])
    return replace(robot, available_until_s=until_s, shifts_s=(*robot.shifts_s[:-1], *last))


def beyond(problem: Question, i: int, end: float) -> str | None:
    """That a route which ends at a time is beyond the robot's shift; None: it is not."""
    until = float(problem.model.over_by[i])
    if math.isinf(end) or end <= until * (1 + ROUNDING):
        return None
    back, over = moments(problem, end, until)
    return f"its route would end at {back} at the earliest, its shift ends at {over}"


def would_be_back_late(back_s: float, by_s: float) -> str:
    """Why a robot cannot do a task after which it would be back at a time."""
    return f"shift: would be back at {back_s:,.1f} s, after {by_s:,g} s"


def is_back_late(back_s: float, by_s: float) -> str:
    """Why a robot can do no task more."""
    return f"shift: is done at {back_s:,.2f} s without it, its shift ends at {by_s:,.2f} s"


def extended(robot: Robot, until_s: float) -> Robot:
    """The robot, whose shift does not end before a time."""
    ends_s = robot.available_until_s
    return robot if ends_s is None or ends_s >= until_s else with_end(robot, until_s)


def waits_for_shift(robot: str, begins_s: float) -> str:
    """Say that a robot rests before work would be done."""
    return f"waits for shift: {robot} works from {round(begins_s, 1):,g} s on"
