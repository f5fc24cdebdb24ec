"""The robot's type is suitable for the task's type."""

from __future__ import annotations

from collections.abc import Hashable, Sequence
from dataclasses import asdict, dataclass
from typing import Any, ClassVar

from muster.mission.model import Robot, Task
from muster.model.rules.rule import Change, Question, Rule, Scores


@dataclass(frozen=True)
class LowScore(Change):
    """A suitability score that is too low."""

    robot_type: str
    task_type: str
    score: float
    needed: float

    @property
    def plain(self) -> dict[str, Any]:
        return asdict(self)

    @property
    def short(self) -> str:
        return f"suitability {self.needed:g} of {self.robot_type} for {self.task_type}, not {self.score:g}"

    @property
    def line(self) -> str:
        return f"suitability {self.needed:g}: {self.robot_type} scores {self.score:g} for {self.task_type}"

    def suitability(self, table: Scores) -> Scores:
        return {**table, self.robot_type: {**table[self.robot_type], self.task_type: self.needed}}


class Suitability(Rule):
    """`suitability[type_i][type_j] >= min_suitability`, where a table is given."""

    word: ClassVar[str] = "suitability"
    key = "suitability"

    def kinds(self, problem: Question) -> Sequence[Hashable]:
        return [robot.type for robot in problem.robots]

    def refusal(self, problem: Question, i: int, j: int) -> str | None:
        low = self.change(problem, problem.robots[i], problem.tasks[j])
        if low is None:
            return None
        return f"type {low.robot_type} scores {low.score:g} for {low.task_type}, below {low.needed:g}"

    def trait(self, robot: Robot) -> str:
        return f"type {robot.type}" if robot.type else ""

    def change(self, problem: Question, robot: Robot, task: Task) -> LowScore | None:
        table, least = problem.mission.suitability, problem.mission.rules.min_suitability
        if table is None:
            return None
        score = table[robot.type or ""].get(task.type or "", 0.0)
        return LowScore(robot.type or "", task.type or "", score, least) if score < least else None
