"""A robot is under way for no longer than its longest duty: from leaving its start to the end of its route."""

from __future__ import annotations

import math
from collections.abc import Collection, Mapping
from dataclasses import dataclass, replace
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
    Tried,
    first_robot,
)
from muster.model.rules.times import spans


@dataclass(frozen=True)
class LongerDuty(Change):
    """A duty of any length."""

    @property
    def plain(self) -> dict[str, None]:
        return {"longest_duty_s": None}

    @property
    def short(self) -> str:
        return "a duty of any length"

    def robot(self, robot: Robot) -> Robot:
        return replace(robot, longest_duty_s=None)


class Duty(Rule):
    """A route ends at most `longest_duty_s` after its robot leaves its start, as late as that demands."""

    word: ClassVar[str] = "duty"
    asked: ClassVar[Mapping[str, str]] = {"lasts_most": "duty"}
    lifted_late = True
    key = "duty"

    def asks(self, problem: Question) -> Mapping[str, str | None]:
        longest = problem.model.lasts_most
        return {"duty": first_robot(problem, "longest_duty_s", lambda i: np.isfinite(longest[i]))}

    def compile(self, problem: Question, parts: Parts) -> None:
        for i, robot in enumerate(problem.robots):
            if robot.longest_duty_s is not None:
                parts.lasts(i, robot.longest_duty_s)

    def possible(self, limits: Limits) -> Bools | None:
        longest = limits.rules.lasts_most
        if not limits.is_timed or not np.isfinite(longest).any():
            return None
        return np.asarray(limits.under_way <= longest[:, None] * (1 + ROUNDING))

    def never(self, problem: Question, i: int, j: int, outlook: Outlook) -> str | None:
        limits = outlook.limits
        if not limits.is_timed:
            return None
        least, longest = float(limits.under_way[i, j]), float(problem.model.lasts_most[i])
        if math.isinf(least) or least <= longest * (1 + ROUNDING):
            return None
        takes, most = spans(least, longest)
        duty = "its longest duty is" if self._is_own(problem, i) else "it may take at most"
        return f"takes at least {takes} from its start to the end of its route, {duty} {most}"

    def blamed(self, limits: Limits, i: int, j: int) -> str:
        return limits.rules.given_by("lasts_most", i)

    def _is_own(self, problem: Question, i: int) -> bool:
        return problem.model.given_by("lasts_most", i) == self.word

    def broken_at(self, tried: Tried) -> str:
        return "with it no times keep every robot within its longest duty"

    def lifted(self, problem: Question, i: int, j: int, done: Collection[int]) -> Change | None:
        return LongerDuty() if self._is_own(problem, i) else None
