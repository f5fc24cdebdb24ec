"""A robot drives and works in its shifts alone; its route, the way to its end included, ends by the last one's end."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import ClassVar, Self

import numpy as np

from muster.mission.model import Robot
from muster.model.parts import Parts
from muster.model.rules.latest import Later, Latest
from muster.model.rules.rule import ROUNDING, Bools, Found, Limits, Outlook, Question, Tried, first_robot
from muster.model.rules.times import known_least, longer, moments


@dataclass(frozen=True)
class LongerShift(Later):
    """A later end of a robot's shift, also in words."""

    said: str = ""

    of = "over"
    limit_key = "available_until_s"

    def narrowed(self, found: Found) -> Self | None:
        later = super().narrowed(found)
        return later and replace(later, said=moments(found.problem, found.times.over)[0])

    @property
    def short(self) -> str:
        return f"a shift until {self.said}"

    def of_several(self, whose: str, seconds: float) -> str:
        return f"shifts of {whose} {longer(seconds)} longer"

    @property
    def line(self) -> str:
        return f"{self.short}, {longer(self.seconds)} longer: {known_least(self.until_s, self.at_least_s)}"

    def robot(self, robot: Robot) -> Robot:
        return with_end(robot, self.until_s)


class Shift(Latest):
    """The end of the route is at most `available_until_s`; legs and work are each within one of `shifts_s`, if any."""

    word: ClassVar[str] = "shift"
    asked: ClassVar[Mapping[str, str]] = {"over_by": "shift", "spans": "rests"}
    key = "shift"
    limits = ("over_by", True)
    lifts = LongerShift
    resource = ("shift", "shift")

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
        return self._by_least_times(outlook.limits, i, j, limit="shift, which ends at")

    def _excludes(self, problem: Question, limits: Limits, i: int, j: int) -> str | None:
        return self.over_late(problem, i, float(limits.over[i, j]))

    def latest(self, problem: Question, i: int, j: int) -> float:
        return float(problem.model.over_by[i])

    def over_late(self, problem: Question, i: int, over: float) -> str | None:
        until = float(problem.model.over_by[i])
        if math.isinf(over) or over <= until * (1 + ROUNDING):
            return None
        back, ends = moments(problem, over, until)
        own = problem.model.given_by("over_by", i) in ("", self.word)
        return (
            f"its route would end at {back} at the earliest, {'its shift ends at' if own else 'it is to end by'} {ends}"
        )

    def broken_at(self, tried: Tried) -> str:
        own = self.over_late(tried.problem, tried.i, tried.over)
        return own or "with it the route of another robot would end after its shift"

    def without_end(self, robots: tuple[Robot, ...]) -> tuple[Robot, ...]:
        return tuple(with_end(robot, None) for robot in robots)


def with_end(robot: Robot, until_s: float | None) -> Robot:
    """Return the robot with another end of its only shift, or of its last one."""
    last = tuple((begins, until_s) for begins, _ in robot.shifts_s[-1:])
    return replace(robot, available_until_s=until_s, shifts_s=(*robot.shifts_s[:-1], *last))
