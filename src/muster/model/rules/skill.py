"""The robot has every skill that the task requires."""

from __future__ import annotations

from collections.abc import Hashable, Sequence
from dataclasses import dataclass, replace
from typing import ClassVar

from muster.mission.model import Robot, Task
from muster.model.rules.rule import Change, Question, Rule, listed


@dataclass(frozen=True)
class MissingSkills(Change):
    """Skills that the robot lacks."""

    skills: tuple[str, ...]

    @property
    def plain(self) -> tuple[str, ...]:
        return self.skills

    @property
    def short(self) -> str:
        return f"skill {listed(self.skills)}"

    def robot(self, robot: Robot) -> Robot:
        return replace(robot, skills=(*robot.skills, *self.skills))


class Skill(Rule):
    """`requires_j` is a subset of `skills_i`."""

    word: ClassVar[str] = "skill"
    key, no_change = "skills", ()

    def kinds(self, problem: Question) -> Sequence[Hashable]:
        return [frozenset(robot.skills) for robot in problem.robots]

    def refusal(self, problem: Question, i: int, j: int) -> str | None:
        lacking = _lacking(problem.robots[i], problem.tasks[j])
        return f"lacks {listed(lacking)}" if lacking else None

    def trait(self, robot: Robot) -> str:
        return listed(robot.skills)

    def change(self, problem: Question, robot: Robot, task: Task) -> MissingSkills | None:
        lacking = _lacking(robot, task)
        return MissingSkills(lacking) if lacking else None


def _lacking(robot: Robot, task: Task) -> tuple[str, ...]:
    return tuple(skill for skill in task.requires if skill not in robot.skills)
