"""The robot can do the task's action, which may need a camera that looks down. This rule cannot be ignored."""

from __future__ import annotations

from collections.abc import Hashable, Sequence
from typing import ClassVar

from muster.model.rules.rule import Question, Rule


class Action(Rule):
    """There are way points of the action for the robot. No change of a rule helps a robot that has none."""

    word: ClassVar[str] = "skill"
    ignorable = False

    def kinds(self, problem: Question) -> Sequence[Hashable]:
        return [problem.actions_refused(i) for i in range(len(problem.robots))]

    def refusal(self, problem: Question, i: int, j: int) -> str | None:
        return problem.action_refusal(i, j)
