"""Rules by which something has begun, ended or is over by a time, and the change to a later one."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import ClassVar, Self

from muster.model.rules.rule import ROUNDING, Change, Found, Limits, Question, Rule, Tried, stop_of
from muster.model.rules.times import moments


@dataclass(frozen=True)
class Later(Change):
    """A later limit of a time: `until_s`, None without one; before `at_least_s` no admissible plan is enough.

    `limit_s` is the mission's, `of` says which of `Times` it limits, and `limit_key` names it in plain data.
    """

    limit_s: float
    until_s: float | None
    at_least_s: float | None = None

    of: ClassVar[str]
    limit_key: ClassVar[str]

    @property
    def plain(self) -> Mapping[str, float | None]:
        return {self.limit_key: self.limit_s, "until_s": self.until_s, "at_least_s": self.at_least_s}

    def of_several(self, whose: str, seconds: float) -> str:
        """The change of several limits of the sort, each by so much, in words; `whose` are robots, or counted tasks."""
        raise NotImplementedError

    @property
    def seconds(self) -> float:
        return math.inf if self.until_s is None else self.until_s - self.limit_s

    def narrowed(self, found: Found) -> Self | None:
        time: float = getattr(found.times, self.of)
        least: float | None = getattr(found.least, self.of, None)
        return replace(self, until_s=time, at_least_s=least) if time > self.limit_s * (1 + ROUNDING) else None


class Latest(Rule):
    """A rule with such a limit; the places in a route are looked at without it before it is."""

    lifted_late = True
    lifts: ClassVar[type[Later]]
    limits: ClassVar[tuple[str, bool]]  # the primitive, and whether it is of a robot and not of a task

    def latest(self, problem: Question, i: int, j: int) -> float:
        """The limit for robot i and task j; inf: there is none."""
        raise NotImplementedError

    def blamed(self, limits: Limits, i: int, j: int) -> str:
        primitive, of_robot = self.limits
        return limits.rules.given_by(primitive, i if of_robot else j) or self.word

    def unlimited(self, problem: Question, i: int, j: int) -> Later | None:
        limit, (primitive, of_robot) = self.latest(problem, i, j), self.limits
        is_own = problem.model.given_by(primitive, i if of_robot else j) == self.word
        return self.lifts(limit, None) if is_own and math.isfinite(limit) else None

    def _excludes(self, problem: Question, limits: Limits, i: int, j: int) -> str | None:
        """That the limit is before what robot i and task j come to at the least; None: it is not."""
        raise NotImplementedError

    def _by_least_times(self, limits: Limits, i: int, j: int, limit: str) -> str | None:
        """The same, by times that hold whatever the rule says of the robot or of the task; `limit` is it in words."""
        problem = limits.problem
        if not limits.is_timed or self._excludes(problem, limits, i, j) is None:
            return None
        _, of_robot = self.limits
        free = limits.exclusions.before(self.word, robot=i) if of_robot else limits.exclusions.before(self.word, task=j)
        late = None if free is None else self._excludes(problem, free, i, j)
        (until,) = moments(problem, self.latest(problem, i, j))
        return late or f"what it waits for is too late for its {limit} {until}"

    def _others_late(self, tried: Tried) -> str | None:
        """Which other task would be too late, at the place where the task begins first."""
        routes, found = min(zip(tried.stops, tried.places, strict=True), key=lambda one: one[0][1])[1]
        for i, route in enumerate(routes):
            for at, k in enumerate(route):
                late = self.late(tried.problem, k, *stop_of(found, i, at)[1:])
                if late and k != tried.j:
                    return f"with it {tried.problem.tasks[k].id} {late}".replace(" at the earliest", "")
        return None
