"""The robot has a path to the task and along its action. This rule cannot be ignored."""

from __future__ import annotations

import math
from typing import ClassVar

import numpy as np

from muster.model.rules.rule import Bools, InPlan, Limits, Outlook, Question, Rule


class Unreachable(Rule):
    """Every leg of a route has a way."""

    word: ClassVar[str] = "unreachable"
    ignorable = False

    def possible(self, limits: Limits) -> Bools:
        return np.isfinite(limits.usage)

    def never(self, problem: Question, i: int, j: int, outlook: Outlook) -> str | None:
        return problem.no_way_to(i, j) if math.isinf(outlook.least) else None

    def left_out(self, plan: InPlan, i: int, j: int) -> str | None:
        if plan.is_timed:
            return plan.kept_out(self.word, i, j)
        insertion = plan.insertion(i, j)
        if insertion is None or not math.isinf(insertion.usage):
            return None
        return "there is no way along its route" if plan.has_no_way(i) else plan.problem.no_way_to(i, j)
