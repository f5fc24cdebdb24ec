"""Rules on a robot and a task alone, whatever else is in the route."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Iterator

from muster.mission.model import Mission, Robot, Task
from muster.verification.case import Case
from muster.verification.measure import MeasuredRoute
from muster.verification.verdict import Violation


class PairRule(ABC):
    """A rule that refuses pairs of robot and task."""

    kind: str
    ignorable = True

    @abstractmethod
    def refusal(self, mission: Mission, robot: Robot, task: Task) -> str | None:
        """Why the robot may not do the task; None if it may."""

    def violations(self, case: Case, route: MeasuredRoute) -> Iterator[Violation]:
        """A violation for each task that the robot may not do."""
        for step in route.steps:
            refusal = self.refusal(case.mission, route.robot, step.task)
            if refusal is not None:
                yield Violation(self.kind, route.robot.id, step.task.id, refusal)

    def prevents(self, case: Case, route: MeasuredRoute, task: Task) -> bool | None:
        """Whether the robot may not do the task."""
        return self.refusal(case.mission, route.robot, task) is not None
